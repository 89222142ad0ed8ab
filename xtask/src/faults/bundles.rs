//! Bundles whose blobs are damaged after a run. The next run has nothing to do otherwise, and must
//! repair them; `gen --check` must report them.

use std::collections::BTreeMap;
use std::fs;

use super::stores::{ROUNDS, WRONG, files};
use super::{FaultPackage, environment};
use xtask::CommandFailure;

/// Damages each blob in every way; returns the findings.
pub fn run(
    package: &FaultPackage,
    seed: u64,
    counts: &mut BTreeMap<&'static str, usize>,
) -> Result<Vec<String>, CommandFailure> {
    let mut findings = Vec::new();
    let blobs = package.folder.join("bundle/blobs");
    let ran = |arguments: &[&str]| {
        let mut command = package.command();
        command.args(arguments);
        let output = command.output().map_err(environment)?;
        Ok::<_, CommandFailure>(output.status.code())
    };
    package.change(0)?;
    ran(&[])?;
    let paths = files(&blobs)?;
    let expected = contents(&paths)?;
    for (fault, wrong) in WRONG {
        for (number, path) in paths.iter().cycle().take(ROUNDS).enumerate() {
            let place = number % paths.len();
            let other = &expected[(place + 1) % paths.len()];
            let damaged = wrong(&expected[place], other, seed.wrapping_add(number as u64));
            if damaged == expected[place] {
                continue;
            }
            fs::write(path, damaged).map_err(environment)?;
            *counts.entry("damaged blob of a bundle").or_default() += 1;
            if ran(&["--check"])? != Some(3) {
                findings.push(format!("a blob with a {fault}: `gen --check` does not report it"));
            }
            if ran(&[])? != Some(0) || contents(&paths)? != expected {
                findings.push(format!("a blob with a {fault}: `gen` does not repair it"));
            }
        }
    }
    findings.iter().for_each(|finding| println!("{finding}"));
    Ok(findings)
}

fn contents(paths: &[std::path::PathBuf]) -> Result<Vec<Vec<u8>>, CommandFailure> {
    paths.iter().map(|path| fs::read(path).map_err(environment)).collect()
}
