//! The one test binary. Each kind of test lists its cases, most of them found by their files.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout, clippy::print_stderr)]

mod bundle;
mod compose_glsl;
mod compose_wesl;
mod emit;
mod eval;
mod harness;
mod permute;
mod programs;
mod shaderlib;
mod shadow;
mod snapshot;

use std::process::ExitCode;

use libtest_mimic::{Arguments, Trial};

const KINDS: &[fn() -> Vec<Trial>] = &[
    bundle::trials,
    compose_glsl::trials,
    compose_wesl::trials,
    emit::trials,
    eval::trials,
    harness::trials,
    permute::trials,
    programs::trials,
    shaderlib::trials,
    shadow::trials,
    snapshot::trials,
];

fn main() -> ExitCode {
    let trials = KINDS.iter().flat_map(|kind| kind()).collect();
    libtest_mimic::run(&Arguments::from_args(), trials).exit_code()
}
