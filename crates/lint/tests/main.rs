//! The package's tests.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::print_stderr
)]

mod large;

fn main() -> std::process::ExitCode {
    lamplight_testing::run_tests(&[large::tests])
}
