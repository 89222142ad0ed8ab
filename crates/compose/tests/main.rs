//! The package's tests. Each module lists its own, most of which are found by their files.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::print_stderr
)]

mod compose_glsl;
mod compose_wesl;
mod imports;
mod texts;

fn main() -> std::process::ExitCode {
    lamplight_testing::run_tests(&[
        compose_glsl::tests,
        compose_wesl::tests,
        imports::tests,
        texts::tests,
    ])
}
