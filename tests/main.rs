//! The one test binary. Each kind of test lists its cases, most of them found by their files.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout, clippy::print_stderr)]

mod compose_glsl;
mod compose_wesl;
mod permute;
mod shaderlib;
mod snapshot;

use std::process::ExitCode;

use libtest_mimic::{Arguments, Trial};

const KINDS: &[fn() -> Vec<Trial>] = &[compose_glsl::trials, compose_wesl::trials, permute::trials, shaderlib::trials, snapshot::trials];

fn main() -> ExitCode {
    let trials = KINDS.iter().flat_map(|kind| kind()).collect();
    libtest_mimic::run(&Arguments::from_args(), trials).exit_code()
}
