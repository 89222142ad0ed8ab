//! The package's tests.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::print_stderr
)]

mod documented;
mod large;
mod stages;

fn main() -> std::process::ExitCode {
    lamplight_testing::run_tests(&[documented::tests, large::tests, stages::tests])
}
