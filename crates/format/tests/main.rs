//! Formatting changes blanks alone, and nothing the second time.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::print_stderr
)]

mod cases;
mod corpus;
mod hostile;
mod lexer;
mod random;

fn main() -> std::process::ExitCode {
    lamplight_testing::run_tests(&[cases::tests, corpus::tests, hostile::tests, random::tests])
}
