//! The maintainer's commands, one file each.

#![allow(clippy::print_stdout, clippy::print_stderr)]

mod bench;
mod ci;
mod create;
mod docs;
mod faults;
mod frames;
mod fuzz;
mod generate;
mod machine;
mod mutate;
mod new;
mod process;
mod record;
mod site;
mod tables;
mod test;
mod validate;

use std::process::ExitCode;

/// A command: its name, one line of help, and what it does with its arguments.
type XtaskCommand = (&'static str, &'static str, fn(&[String]) -> CommandResult);

/// Exit code 0, or another with its reason on standard error.
type CommandResult = Result<(), CommandFailure>;

/// Why a command failed, with the documented exit code.
struct CommandFailure {
    code: u8,
    message: String,
}

impl CommandFailure {
    /// The input is wrong (1).
    fn input(message: impl Into<String>) -> Self {
        Self { code: 1, message: message.into() }
    }

    /// Wrong usage (2).
    fn usage(message: impl Into<String>) -> Self {
        Self { code: 2, message: message.into() }
    }

    /// A check or a comparison failed (3).
    fn check(message: impl Into<String>) -> Self {
        Self { code: 3, message: message.into() }
    }

    /// The environment lacks something (4).
    fn environment(message: impl Into<String>) -> Self {
        Self { code: 4, message: message.into() }
    }
}

const COMMANDS: &[XtaskCommand] = &[
    (
        "gen",
        "write the library's bundle to target/bundles/, once all its outputs are judged",
        generate::run,
    ),
    ("test", "install what the tests need, then run every test", test::run),
    (
        "new",
        "write the files for a new function, axis-value, target, executor, scene or diagnostic",
        create::run,
    ),
    (
        "record",
        "write down anew what tests compare with: [permute|compose_|diagnostics|emit|library::|guide|_budget]...",
        record::run,
    ),
    ("mutate", "put mistakes into the library and see whether its cases notice", mutate::run),
    ("validate", "let the judges of all targets look at a bundle", validate::run),
    (
        "docs",
        "write the catalogue, the modules made from data, the guide as a book (--check: only compare, --costs: measure first)",
        docs::run,
    ),
    (
        "bench",
        "measure, beside peers where there are any: compose, eval, gen, load, lsp, migrate, render, scale or site",
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
        fuzz::run,
    ),
    (
        "frames",
        "draw permutations of `forward` from the bytes of every target: [--permutations N] [--target T]",
        frames::run,
    ),
    (
        "site",
        "the toolchain as WebAssembly (target/toolchain/) and the site: [--toolchain] [--quick]",
        site::run,
    ),
    ("ci", "what continuous integration runs: format, lints, tests", ci::run),
];

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let command =
        arguments.first().and_then(|name| COMMANDS.iter().find(|(known, ..)| known == name));
    let outcome = match command {
        Some((.., run)) => run(&arguments[1..]),
        None => Err(CommandFailure::usage(usage())),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("{}", failure.message);
            ExitCode::from(failure.code)
        }
    }
}

fn usage() -> String {
    let mut text = String::from("usage: cargo xtask COMMAND\n");
    for (name, about, _) in COMMANDS {
        text.push_str(&format!("\n  {name:10} {about}"));
    }
    text
}
