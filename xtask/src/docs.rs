//! The files that are made from other files: light-probe modules and the catalogue.

use crate::{Outcome, test};

/// Writes them, or with `--check` fails if any is not up to date.
///
/// The modules come first: the second run is of a binary that carries them.
pub fn run(arguments: &[String]) -> Outcome {
    let check: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let lamplight = ["run", "--quiet", "--package", "lamplight", "--", "catalogue"];
    for made in [["--modules", "shaderlib"], ["--output", "docs/catalogue"]] {
        test::cargo(&[&lamplight[..], &made, &check].concat(), &[])?;
    }
    Ok(())
}
