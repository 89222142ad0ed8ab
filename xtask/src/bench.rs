//! Benchmarks: a binary of their own, built for release.

use crate::{Outcome, test};

/// Runs the benchmark of that name.
pub fn run(arguments: &[String]) -> Outcome {
    test::cargo(&["run", "--quiet", "--release", "--package", "lamplight-bench"], arguments)
}
