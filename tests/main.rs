//! The test binary. Each module lists its trials, most of which are found by their files.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::print_stderr,
    clippy::wrong_self_convention
)]

/// The allocator of the command. It gives memory back that is no longer used, where the C library
/// would keep gigabytes until the last trial.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

mod bounds;
mod browser;
mod catalogue;
mod conventions;
mod cost;
mod described;
mod determinism;
mod doors;
mod drivers;
mod emit;
mod energy;
mod examples;
mod fragments;
mod frames;
mod generate;
mod glslang;
mod guide;
mod harness;
mod hostile;
mod judges;
mod keys;
mod library;
mod link;
mod link_compare;
mod link_random;
mod lsp;
mod metal;
mod migrate;
mod new;
mod oracles;
mod outputs;
mod packages;
mod pipelines;
mod plain;
mod programs;
mod published;
mod regressions;
mod render;
mod report;
mod shaderlib;
mod shadow;
mod site;
mod sketch;
mod specialise;
mod tables;
mod toolchain;
mod traps;

use std::process::ExitCode;

use lamplight_testing::{random, snapshot};
use libtest_mimic::{Arguments, Trial};

/// Those come first of which some take long on one core, so that the other cores do not wait for
/// them at the end.
const KINDS: &[fn() -> Vec<Trial>] = &[
    toolchain::trials,
    site::trials,
    browser::trials,
    catalogue::trials,
    bounds::trials,
    conventions::trials,
    cost::trials,
    described::trials,
    determinism::trials,
    doors::trials,
    drivers::trials,
    emit::trials,
    energy::trials,
    examples::trials,
    frames::trials,
    generate::trials,
    guide::trials,
    harness::trials,
    hostile::trials,
    judges::trials,
    keys::trials,
    library::trials,
    link::trials,
    link_random::trials,
    lsp::trials,
    metal::trials,
    migrate::trials,
    new::trials,
    oracles::trials,
    outputs::trials,
    packages::trials,
    pipelines::trials,
    plain::trials,
    programs::trials,
    published::trials,
    regressions::trials,
    render::trials,
    report::trials,
    shaderlib::trials,
    shadow::trials,
    sketch::trials,
    specialise::trials,
    tables::trials,
    traps::trials,
];

fn main() -> ExitCode {
    // This changes environment variables, so it must be done while there is one thread. If something
    // is missing, the trials that need it say so.
    lamplight::execute::executors::prepare_process(lamplight::execute::executors::ALL);
    lamplight::browser::Browser::keep_shared();
    let trials = KINDS.iter().flat_map(|kind| kind()).collect();
    libtest_mimic::run(&Arguments::from_args(), trials).exit_code()
}
