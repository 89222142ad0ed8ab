//! Makes the tables that techniques read, with a separate crate that is built for release.

use xtask::{CommandResult, process};

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../shaderlib/tables");

const RUN: [&str; 6] = ["run", "--quiet", "--release", "--package", "lamplight-tables", "--"];

/// Makes the tables of those names, or all of them.
pub fn run(arguments: &[String]) -> CommandResult {
    let names: Vec<&str> = arguments.iter().map(String::as_str).collect();
    process::cargo(&[&RUN[..], &[FOLDER], &names].concat(), &[])
}

/// Fits `brdf::energy::dfg_approx` to quadratures, and prints its coefficients.
pub fn fit(arguments: &[String]) -> CommandResult {
    process::cargo(&[&RUN[..], &["--fit"]].concat(), arguments)
}
