//! The tests of the whole that need nothing but the command and what is in the repository. Each
//! module lists its own, most of which are found by their files.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::print_stderr
)]

mod diagnostics;
mod differential;
mod mistakes;
mod one_meaning;
mod robust;
mod scale;

use lamplight_testing::{random, snapshot};

fn main() -> std::process::ExitCode {
    lamplight_testing::run_tests(&[
        diagnostics::tests,
        differential::tests,
        mistakes::tests,
        one_meaning::tests,
        robust::tests,
        scale::tests,
    ])
}
