//! Numeric proof: cases, executors, reports.
