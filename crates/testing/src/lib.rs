//! What the tests of several packages share: packages in folders, snapshots, random numbers.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, missing_docs)]

pub mod commands;
pub mod folders;
pub mod numbers;
pub mod random;
pub mod snapshot;
pub mod text;

use std::process::ExitCode;

use lamplight_diagnostic::Diagnostic;
use libtest_mimic::{Arguments, Trial};

/// The messages of errors, for the failure of a test.
pub fn joined_messages(errors: &[Diagnostic]) -> String {
    errors.iter().map(|error| error.message.clone()).collect::<Vec<_>>().join("; ")
}

/// Runs the tests that some functions list, with the arguments of this process.
pub fn run_tests(lists: &[fn() -> Vec<Trial>]) -> ExitCode {
    let tests = lists.iter().flat_map(|list| list()).collect();
    libtest_mimic::run(&Arguments::from_args(), tests).exit_code()
}
