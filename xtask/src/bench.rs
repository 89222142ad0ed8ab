//! Benchmarks: a binary of their own, built for release.

use crate::{Outcome, test};

/// Runs the benchmark of that name.
pub fn run(arguments: &[String]) -> Outcome {
    let features: &[&str] = if arguments.iter().any(|name| name == "eval") { &["--features", "eval"] } else { &[] };
    test::cargo(&[&["run", "--quiet", "--release", "--package", "lamplight-bench"], features].concat(), arguments)
}
