//! Mutants of the library: do its numeric cases notice a mistake?

use crate::{Outcome, test};

/// Runs `lamplight mutate` over the library's sources; arguments (modules, `--coverage`) go on to it.
pub fn run(arguments: &[String]) -> Outcome {
    let all: Vec<&str> =
        ["run", "--quiet", "--package", "lamplight", "--", "mutate", "--root", "shaderlib"]
            .into_iter()
            .chain(arguments.iter().map(String::as_str))
            .collect();
    test::cargo(&all, &[])
}
