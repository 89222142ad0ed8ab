//! Runs benchmarks, which are a separate binary built for release.

use xtask::{CommandResult, process};

/// Runs the benchmark of that name.
pub fn run(arguments: &[String]) -> CommandResult {
    process::cargo(&["run", "--quiet", "--release", "--package", "lamplight-bench"], arguments)
}
