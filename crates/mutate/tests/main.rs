//! The package's tests. Each module lists its own, most of which are found by their files.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::print_stderr
)]

mod mutate;
mod shared;

use lamplight_diagnostic::source::Embedded;

/// The files of the shader library.
const LIBRARY_FILES: Embedded =
    Embedded { texts: lamplight_shaderlib::FILES, tables: lamplight_shaderlib::TABLES };

fn main() -> std::process::ExitCode {
    lamplight_testing::run_tests(&[mutate::tests, shared::tests])
}
