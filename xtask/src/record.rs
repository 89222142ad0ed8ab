//! `cargo xtask record`: writes down anew what tests compare with, such as messages, listings and
//! outputs. Read the difference before you commit it.

use xtask::{CommandFailure, CommandResult, process};

use crate::test;

/// The tests that compare with a record. Pictures are not among them: those are drawn on purpose.
const RECORDED: [&str; 10] = [
    "permute",
    "compose_",
    "diagnostics",
    "specialise",
    "emit",
    "library::",
    "guide",
    "migrate",
    "packages::case",
    "_budget",
];

/// The variables that tell tests to write what they find.
const VARIABLES: [(&str, &str); 2] = [("INSTA_UPDATE", "always"), ("UPDATE_EXPECT", "1")];

/// Runs all of these tests, or only those that the arguments name.
pub fn run(arguments: &[String]) -> CommandResult {
    let all = RECORDED.map(str::to_owned);
    let chosen = if arguments.is_empty() { &all[..] } else { arguments };
    let variables = VARIABLES.map(|(name, value)| (name.to_owned(), value.to_owned()));
    let all = test::find_binaries()?;
    let mut failed = 0;
    // All of them run, even after one that fails.
    for filter in chosen {
        for binary in test::choose(&all, std::slice::from_ref(filter)) {
            let command = test::one_command(&binary);
            let command: Vec<&str> = command.iter().map(String::as_str).collect();
            let filter = [filter.clone(), "--quiet".to_owned()];
            failed += usize::from(process::cargo_with(&command, &filter, &variables).is_err());
        }
    }
    match failed {
        0 => Ok(()),
        _ => Err(CommandFailure::check("some tests fail for another reason, as printed above")),
    }
}
