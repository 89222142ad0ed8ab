//! The package's tests: messages of an editor and what the server sends, without a process.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::print_stderr
)]

mod editor;
mod edits;
mod format;
mod manifests;
mod unclosed;
mod workspace;

fn main() -> std::process::ExitCode {
    lamplight_testing::run_tests(&[
        edits::tests,
        format::tests,
        manifests::tests,
        unclosed::tests,
        workspace::tests,
    ])
}
