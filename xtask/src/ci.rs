//! What continuous integration runs beyond the tests.

use crate::{Outcome, test};

/// Format, lints without a warning, tests.
pub fn run(arguments: &[String]) -> Outcome {
    test::cargo(&["fmt", "--all", "--check"], &[])?;
    test::cargo(&["clippy", "--workspace", "--all-targets", "--", "--deny", "warnings"], &[])?;
    test::run(arguments)
}
