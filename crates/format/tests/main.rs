//! Formatting changes blanks alone, and nothing the second time.

mod cases;
mod corpus;
mod lexer;
mod random;

use std::process::ExitCode;

use libtest_mimic::{Arguments, Trial};

fn main() -> ExitCode {
    let mut trials = cases::case_trials();
    trials.extend([
        Trial::test("ranges", cases::ranges),
        Trial::test("typed", cases::typed),
        Trial::test("others_code", corpus::others_code),
        Trial::test("random_texts", random::random_texts),
    ]);
    libtest_mimic::run(&Arguments::from_args(), trials).exit_code()
}
