//! Runs benchmarks, which are a separate binary built for release.

use crate::{Outcome, test};

/// Runs the benchmark of that name.
pub fn run(arguments: &[String]) -> Outcome {
    test::cargo(&["run", "--quiet", "--release", "--package", "lamplight-bench"], arguments)
}
