//! The package's tests. Each module lists its own, most of which are found by their files.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::print_stderr
)]

mod bundle;
mod readers;

fn main() -> std::process::ExitCode {
    lamplight_testing::run_tests(&[bundle::tests, readers::tests])
}
