//! Writes the files that are made from other files: light-probe modules, the catalogue, the guide
//! as a book.

use std::process::Command;

use xtask::{CommandFailure, CommandResult, process};

/// Writes them. With `--check` it only fails if any is not up to date. With `--costs` it first
/// measures what functions and axes cost.
///
/// The modules are written first, since the second run uses a binary that contains them. The book
/// is written and not compared, since the tests `guide::` check its pages.
pub fn run(arguments: &[String]) -> CommandResult {
    let (costs, check): (Vec<&str>, Vec<&str>) =
        arguments.iter().map(String::as_str).partition(|argument| *argument == "--costs");
    let lamplight = ["run", "--quiet", "--package", "lamplight", "--", "catalogue", "--force"];
    if !costs.is_empty() {
        process::cargo(&[&lamplight[..], &["--costs", "shaderlib/costs.toml"]].concat(), &[])?;
    }
    for made in [["--modules", "shaderlib"], ["--output", "docs/catalogue"]] {
        process::cargo(&[&lamplight[..], &made, &check].concat(), &[])?;
    }
    if check.is_empty() { book() } else { Ok(()) }
}

const INSTALL: &str = "cargo install mdbook --locked --no-default-features --features search";

/// `docs/guide/` as HTML in `target/guide/`, where mdbook is installed.
fn book() -> CommandResult {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/guide");
    match Command::new("mdbook").args(["build", folder]).status() {
        Ok(status) if status.success() => Ok(()),
        Ok(_) => Err(CommandFailure::check("failed: mdbook build docs/guide")),
        Err(_) => {
            eprintln!("the guide was not made into a book, which needs mdbook: {INSTALL}");
            Ok(())
        }
    }
}
