//! Bundles whose blobs are damaged after a run. The next run has nothing to do otherwise, and must
//! repair them; `gen --check`, `bundle verify` and `merge` must report them. Shards that were made of
//! different sources must not be merged.

use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;

use super::stores::{StoreFault, WRONG, files};
use super::{FaultPackage, environment};
use xtask::CommandFailure;

/// How often each kind of damage is tried, each time on one blob.
const ROUNDS: usize = 25;

/// How many pairs of shards of different sources are tried.
const MIXED: usize = 200;

/// Damage that a record of a cache cannot have, or that is noticed in another way there.
const MORE: &[(&str, StoreFault)] = &[
    ("blob with a byte more", |blob, _, number| [blob, &[number as u8]].concat()),
    ("blob without its first byte", |blob, _, _| blob.get(1..).unwrap_or_default().to_vec()),
    ("blob of zeros", |blob, _, _| vec![0; blob.len()]),
    ("blob that is there twice", |blob, _, _| [blob, blob].concat()),
    ("blob with two bytes exchanged", |blob, _, number| {
        let mut bytes = blob.to_vec();
        let last = bytes.len().saturating_sub(1);
        bytes.swap(number as usize % (last + 1), last / 2);
        bytes
    }),
];

/// Damages blobs in every way, and mixes shards; returns the findings.
pub fn run(
    package: &FaultPackage,
    seed: u64,
    counts: &mut BTreeMap<&'static str, usize>,
) -> Result<Vec<String>, CommandFailure> {
    let mut findings = damaged(package, seed, counts)?;
    findings.extend(mixed(package, counts)?);
    findings.iter().for_each(|finding| println!("{finding}"));
    Ok(findings)
}

impl FaultPackage {
    /// The exit code of a command.
    fn code_of(&self, arguments: &[&str]) -> Result<Option<i32>, CommandFailure> {
        let mut command = std::process::Command::new(&self.program);
        command.args(arguments);
        Ok(self.prepared(command).output().map_err(environment)?.status.code())
    }
}

/// The commands that must report a damaged bundle, with the counter of each.
const READERS: [(&str, &[&str]); 3] = [
    ("damaged blob before gen --check", &["gen", "--check", "--cache", "cache", "-o", "bundle"]),
    ("damaged blob before verify", &["bundle", "verify", "bundle"]),
    ("damaged blob before merge", &["merge", "merged", "bundle"]),
];

fn damaged(
    package: &FaultPackage,
    seed: u64,
    counts: &mut BTreeMap<&'static str, usize>,
) -> Result<Vec<String>, CommandFailure> {
    let mut findings = Vec::new();
    let generate = ["gen", "--cache", "cache", "-o", "bundle"];
    package.change(0)?;
    // A bundle keeps the blobs of runs before it, which no reader looks at.
    match fs::remove_dir_all(package.folder.join("bundle")) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            return Err(environment(error));
        }
        Ok(()) | Err(_) => {}
    }
    package.code_of(&generate)?;
    let paths = files(&package.folder.join("bundle/blobs"))?;
    let expected = contents(&paths)?;
    for (fault, wrong) in WRONG.iter().chain(MORE) {
        for (number, path) in paths.iter().cycle().take(ROUNDS).enumerate() {
            let place = number % paths.len();
            let other = &expected[(place + 1) % paths.len()];
            let damaged = wrong(&expected[place], other, seed.wrapping_add(number as u64));
            if damaged == expected[place] {
                continue;
            }
            fs::write(path, damaged).map_err(environment)?;
            for (counter, arguments) in READERS {
                *counts.entry(counter).or_default() += 1;
                if package.code_of(arguments)? != Some(3) {
                    findings.push(format!("{fault}: `{}` does not report it", arguments.join(" ")));
                }
            }
            *counts.entry("damaged blob before gen").or_default() += 1;
            if package.code_of(&generate)? != Some(0) || contents(&paths)? != expected {
                findings.push(format!("{fault}: `gen` does not repair it"));
            }
        }
    }
    Ok(findings)
}

/// Makes one shard of each of several sources, and tries to merge each with one of another source.
fn mixed(
    package: &FaultPackage,
    counts: &mut BTreeMap<&'static str, usize>,
) -> Result<Vec<String>, CommandFailure> {
    let mut findings = Vec::new();
    let sources = MIXED.isqrt() + 1;
    let name = |source: usize, shard: usize| format!("shards/{source}-{shard}");
    for source in 0..sources {
        package.change(1000 + source)?;
        for shard in [1, 2] {
            let (part, out) = (format!("{shard}/2"), name(source, shard));
            package.code_of(&["gen", "--cache", "cache", "--shard", &part, "-o", &out])?;
        }
    }
    let pairs = (0..sources).flat_map(|one| (0..sources).map(move |other| (one, other)));
    for (one, other) in pairs.filter(|(one, other)| one != other).take(MIXED) {
        *counts.entry("shards of different sources").or_default() += 1;
        let _ = fs::remove_dir_all(package.folder.join("merged"));
        let code = package.code_of(&["merge", "merged", &name(one, 1), &name(other, 2)])?;
        if code != Some(3) || package.folder.join("merged/manifest.json").exists() {
            findings.push(format!("shards of sources {one} and {other}: merged with {code:?}"));
        }
    }
    // Those of one source are merged, so the refusals are not for another reason.
    if package.code_of(&["merge", "merged", &name(0, 1), &name(0, 2)])? != Some(0) {
        findings.push("shards of one source are not merged".to_owned());
    }
    Ok(findings)
}

fn contents(paths: &[PathBuf]) -> Result<Vec<Vec<u8>>, CommandFailure> {
    let read = |path: &PathBuf| match fs::read(path) {
        Ok(bytes) => Ok(bytes),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(Vec::new()),
        Err(error) => Err(environment(error)),
    };
    paths.iter().map(read).collect()
}
