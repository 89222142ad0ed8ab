//! The one test binary. Each kind of test lists its cases, most of them found by their files.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout, clippy::print_stderr)]

mod eval;
mod harness;
mod shaderlib;

use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = libtest_mimic::Arguments::from_args();
    let kinds = [eval::trials, harness::trials, shaderlib::trials];
    let trials = kinds.iter().flat_map(|kind| kind()).collect();
    libtest_mimic::run(&arguments, trials).exit_code()
}
