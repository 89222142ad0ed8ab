//! The maintainer's commands, one file each.

#![allow(clippy::print_stdout, clippy::print_stderr)]

mod bench;
mod check;
mod ci;
mod docs;
mod faults;
mod frames;
mod make;
mod mutate;
mod random;
mod record;
mod site;
mod tables;
mod test;

use std::process::ExitCode;

use xtask::XtaskCommand;

const COMMANDS: &[XtaskCommand] = &[
    (
        "gen",
        "write the library's bundle to target/bundles/, once each distinct line of its outputs is validated: [--validate lines|all|none]",
        |arguments| make::run("gen", arguments),
    ),
    ("test", "install what the tests need, then run every test", test::run),
    (
        "check",
        "check the numeric cases of modules on the disk, without a build: brdf/fresnel [OPTION]...",
        check::run,
    ),
    (
        "new",
        "write the files for a new function, axis-value, target, executor, scene or diagnostic",
        |arguments| make::run("new", arguments),
    ),
    (
        "record",
        "write down anew what tests compare with: [permute|compose_|diagnostics|emit|library::|guide|_budget]...",
        record::run,
    ),
    ("mutate", "put mistakes into the library and see whether its cases notice", mutate::run),
    (
        "conformance",
        "what is accepted of other people's suites: [--verbose] DIR..., or glsl [-I DIR]... DIR...",
        |arguments| make::run("conformance", arguments),
    ),
    ("validate", "let the validators of all targets check every output of a bundle", |arguments| {
        make::run("validate", arguments)
    }),
    (
        "docs",
        "write the catalogue, the modules made from data, the guide as a book (--check: only compare, --costs: measure first)",
        docs::run,
    ),
    (
        "bench",
        "measure, and compare with peers where there are any: compose, eval, gen, load, lsp, migrate, render, scale, shaders [FOLDER] or site",
        bench::run,
    ),
    (
        "tables",
        "make the tables that techniques read: blue noise, DFG, LTC, sheen (a minute): [--check] [NAME]...",
        tables::run,
    ),
    ("fit", "fit `dfg_approx` to quadratures, and print its coefficients (a minute)", tables::fit),
    (
        "faults",
        "make calls of the system fail, or end runs at them: the bundle stays whole",
        faults::run,
    ),
    (
        "fuzz",
        "hostile inputs for every parser: [--seconds N] [--seed N] [KIND]...; or `link`",
        |arguments| make::run("fuzz", arguments),
    ),
    (
        "frames",
        "draw permutations of `forward` from the bytes of every target: [--permutations N] [--target T]",
        frames::run,
    ),
    (
        "random",
        "random programs, graphics and compute, run in every target: [--programs N] [--seed N] [--kind graphics|compute]",
        random::run,
    ),
    (
        "site",
        "the toolchain as WebAssembly (target/toolchain/) and the site: [--toolchain] [--quick]",
        site::run,
    ),
    ("ci", "what continuous integration runs: format, lints, tests; or one step: [STEP]", ci::run),
];

fn main() -> ExitCode {
    xtask::run(COMMANDS)
}
