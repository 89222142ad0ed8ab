//! The test binary. Each module lists its tests, most of which are found by their files.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::print_stderr,
    clippy::wrong_self_convention
)]

/// The allocator of the command. It gives memory back that is no longer used, where the C library
/// would keep gigabytes until the last test.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

mod agreement;
mod bounds;
mod browser;
mod catalogue;
mod clients;
mod command_line;
mod compute;
mod conventions;
mod cost;
mod dap;
mod debug;
mod described;
mod determinism;
mod drivers;
mod emit;
mod energy;
mod examples;
mod fragments;
mod frames;
mod generate;
mod glsl_values;
mod glslang;
mod gltf;
mod guide;
mod harness;
mod heat;
mod hostile;
mod keys;
mod library;
mod link;
mod link_compare;
mod link_random;
mod lsp;
mod metal;
mod migrate;
mod naga;
mod new;
mod npm;
mod opengl_scene;
mod oracles;
mod outputs;
mod own;
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
mod spirv_forms;
mod tables;
mod three;
mod toolchain;
mod translated;
mod traps;
mod validators;
mod vite;

use std::process::ExitCode;

use lamplight_testing::{random, snapshot};
use libtest_mimic::{Arguments, Trial};

/// Those come first of which some take long on one core, so that the other cores do not wait for
/// them at the end.
const KINDS: &[fn() -> Vec<Trial>] = &[
    toolchain::tests,
    site::tests,
    browser::tests,
    catalogue::tests,
    clients::tests,
    vite::tests,
    three::tests,
    agreement::tests,
    bounds::tests,
    compute::tests,
    conventions::tests,
    cost::tests,
    dap::tests,
    debug::tests,
    described::tests,
    determinism::tests,
    command_line::tests,
    drivers::tests,
    emit::tests,
    energy::tests,
    examples::tests,
    frames::tests,
    gltf::tests,
    generate::tests,
    guide::tests,
    harness::tests,
    heat::tests,
    hostile::tests,
    keys::tests,
    library::tests,
    glsl_values::tests,
    link::tests,
    link_random::tests,
    lsp::tests,
    metal::tests,
    migrate::tests,
    naga::tests,
    new::tests,
    opengl_scene::tests,
    oracles::tests,
    outputs::tests,
    own::tests,
    packages::tests,
    pipelines::tests,
    plain::tests,
    programs::tests,
    published::tests,
    regressions::tests,
    render::tests,
    report::tests,
    shaderlib::tests,
    shadow::tests,
    sketch::tests,
    specialise::tests,
    spirv_forms::tests,
    tables::tests,
    translated::tests,
    traps::tests,
    validators::tests,
];

/// Whether a test does the whole of what it usually takes a part of, as `cargo xtask test nightly`
/// asks for.
fn is_whole() -> bool {
    std::env::var_os("LAMPLIGHT_WHOLE").is_some()
}

fn main() -> ExitCode {
    // This changes environment variables, so it must be done while there is one thread. If
    // something is missing, the tests that need it say so.
    lamplight::execute::executors::prepare_process(lamplight::execute::executors::ALL);
    lamplight::browser::Browser::keep_shared();
    let tests = KINDS.iter().flat_map(|kind| kind()).collect();
    libtest_mimic::run(&Arguments::from_args(), tests).exit_code()
}
