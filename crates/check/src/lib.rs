//! Numeric tests: what a function should return, and how far each executor is from that.
//!
//! `cases + modules -> jobs (kernels, rows, expected values) -> results -> verdicts -> report`
//!
//! [`cases`] reads what to try, [`library`] composes the modules, [`references`] says what should
//! come out, [`tolerance`] how far off it may be, and [`check`] compares what the executors of
//! [`execute`](lamplight_execute) gave. [`expression`] runs one expression instead of cases, [`plots`]
//! draws functions for the [`catalogue`], `lamplight-mutate` asks how much the cases notice.

pub mod cases;
pub mod catalogue;
pub mod check;
pub mod expression;
pub mod formula;
pub mod laws;
pub mod library;
pub mod plots;
pub mod quality;
pub mod ratchet;
pub mod references;
pub mod report;
pub mod tolerance;
mod untested;
