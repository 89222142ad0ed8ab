//! The programs of gpuweb's CTS.

use std::path::Path;
use std::process::Command;

use serde::Deserialize;

use super::Program;
use xtask::CommandFailure;
use xtask::process::root;

/// How many subcases of a test are run at most.
const SUBCASES: u32 = 40;

const SCRIPT: &str = include_str!("cts.mjs");
const BUNDLER: &str = "esbuild@0.28.2";

#[derive(Deserialize)]
struct Line {
    test: String,
    expected: bool,
    code: String,
}

/// Runs the tests of a checkout with node, and takes the programs from there.
pub fn programs(checkout: &Path) -> Result<Vec<Program>, CommandFailure> {
    let folder = root().join("target/conformance");
    let script = folder.join("cts.mjs");
    std::fs::create_dir_all(&folder)
        .and_then(|()| std::fs::write(&script, SCRIPT))
        .map_err(|error| CommandFailure::input(format!("`{}`: {error}", script.display())))?;
    if !folder.join("node_modules/esbuild").is_dir() {
        let mut npm = Command::new("npm");
        npm.args(["install", "--no-audit", "--no-fund", "--prefix"]).arg(&folder).arg(BUNDLER);
        finish(npm)?;
    }
    let mut node = Command::new("node");
    node.arg(&script).arg(checkout).arg(&folder).arg(SUBCASES.to_string());
    finish(node)?;
    let file = folder.join("programs.jsonl");
    let text = std::fs::read_to_string(&file)
        .map_err(|error| CommandFailure::input(format!("`{}`: {error}", file.display())))?;
    let read = |line: &str| {
        let Line { test, expected, code } = serde_json::from_str(line)
            .map_err(|error| CommandFailure::input(format!("`{}`: {error}", file.display())))?;
        Ok(Program { name: test, text: code, expected })
    };
    text.lines().map(read).collect()
}

fn finish(mut command: Command) -> Result<(), CommandFailure> {
    let name = command.get_program().to_string_lossy().into_owned();
    let status = command
        .status()
        .map_err(|error| CommandFailure::environment(format!("`{name}`: {error}")))?;
    match status.success() {
        true => Ok(()),
        false => Err(CommandFailure::environment(format!("`{name}` failed"))),
    }
}
