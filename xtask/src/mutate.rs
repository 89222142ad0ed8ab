//! Puts mistakes into the library, to see whether its numeric cases notice them.

use crate::{Outcome, test};

/// Runs `lamplight mutate` over the library's sources. Arguments (modules, `--coverage`) are passed
/// on.
pub fn run(arguments: &[String]) -> Outcome {
    let all: Vec<&str> =
        ["run", "--quiet", "--package", "lamplight", "--", "mutate", "--root", "shaderlib"]
            .into_iter()
            .chain(arguments.iter().map(String::as_str))
            .collect();
    test::cargo(&all, &[])
}
