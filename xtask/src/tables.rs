//! Makes the tables that techniques read, with a separate crate that is built for release.

use crate::{Outcome, test};

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../shaderlib/tables");

/// Makes the tables of those names, or all of them.
pub fn run(arguments: &[String]) -> Outcome {
    let run = ["run", "--quiet", "--release", "--package", "lamplight-tables", "--", FOLDER];
    test::cargo(&run, arguments)
}
