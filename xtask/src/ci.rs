//! What continuous integration runs beyond the tests.

use crate::{CommandResult, test};

/// Format, lints without a warning, tests.
pub fn run(arguments: &[String]) -> CommandResult {
    test::cargo(&["fmt", "--all", "--check"], &[])?;
    test::cargo(&["clippy", "--workspace", "--all-targets", "--", "--deny", "warnings"], &[])?;
    test::run(arguments)
}
