//! The verdicts of the rules: on random programs they are those of Tint, the compiler of Chromium.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::print_stderr
)]

mod cases;
mod constants;
mod programs;
mod verdicts;

use lamplight_testing::random;

fn main() -> std::process::ExitCode {
    lamplight_testing::run_tests(&[cases::tests, constants::tests, verdicts::tests])
}

/// The problems of a text that are errors for browsers.
fn errors(text: &str) -> Vec<lamplight_rules::Problem> {
    let text = text.to_owned();
    let check = move || lamplight_rules::check(&text);
    let thread = std::thread::Builder::new().stack_size(64 << 20).spawn(check).unwrap();
    let mut found = thread.join().unwrap();
    found.retain(|problem| problem.severity >= lamplight_rules::Severity::Default);
    found
}
