//! Tests of the translation between shading languages.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod compiler;
mod constructs;
mod hostile;
mod languages;

fn main() -> std::process::ExitCode {
    lamplight_testing::run_tests(&[constructs::tests, hostile::tests, languages::tests])
}
