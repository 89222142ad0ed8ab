//! Lamplight compared with its peers. Each benchmark measures all of them in one run and prints
//! ratios.

#![allow(clippy::print_stdout, clippy::print_stderr)]

mod alike;
mod bundle;
mod compose;
mod corpus;
mod eval;
mod forward;
mod generate;
mod glsl;
mod library;
mod load;
mod lsp;
mod migrate;
mod packages;
mod render;
mod scale;
mod shaders;
mod site;

use std::error::Error;
use std::process::ExitCode;

type Outcome = Result<(), Box<dyn Error>>;

type Benchmark = (&'static str, fn() -> Outcome);

const BENCHMARKS: &[Benchmark] = &[
    ("bundle", bundle::run),
    ("compose", compose::run),
    ("eval", eval::run),
    ("gen", generate::run),
    ("glsl", glsl::run),
    ("load", load::run),
    ("lsp", lsp::run),
    ("migrate", migrate::run),
    ("render", render::run),
    ("scale", scale::run),
    ("shaders", shaders::run),
    ("site", site::run),
];

fn main() -> ExitCode {
    let chosen = std::env::args().nth(1).unwrap_or_default();
    let Some((_, run)) = BENCHMARKS.iter().find(|(name, _)| *name == chosen) else {
        let names: Vec<&str> = BENCHMARKS.iter().map(|(name, _)| *name).collect();
        eprintln!("usage: cargo xtask bench {}", names.join("|"));
        return ExitCode::from(2);
    };
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(1)
        }
    }
}
