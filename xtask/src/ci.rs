//! What continuous integration runs beyond the tests.

use xtask::{CommandResult, process};

use crate::test;

/// Format, lints without a warning, tests.
pub fn run(arguments: &[String]) -> CommandResult {
    process::cargo(&["fmt", "--all", "--check"], &[])?;
    process::cargo(&["clippy", "--workspace", "--all-targets", "--", "--deny", "warnings"], &[])?;
    test::run(arguments)
}
