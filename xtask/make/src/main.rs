//! The maintainer's commands that use the crate, one file each. `cargo xtask` starts them, so that it
//! does not need the crate itself: `cargo xtask test` builds the crate once, as it is tested.

#![allow(clippy::print_stdout, clippy::print_stderr)]

mod conformance;
mod create;
mod fuzz;
mod generate;
mod new;
mod progress;
mod validate;

use std::process::ExitCode;

use xtask::XtaskCommand;

const COMMANDS: &[XtaskCommand] = &[
    ("gen", "write the library's bundle", generate::run),
    ("fuzz", "hostile inputs for every parser", fuzz::run),
    ("new", "write the files for a new entry", create::run),
    ("conformance", "what is accepted of other people's suites", conformance::run),
    ("validate", "let the validators check a bundle", validate::run),
];

fn main() -> ExitCode {
    xtask::run(COMMANDS)
}
