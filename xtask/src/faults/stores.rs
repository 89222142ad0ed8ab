//! Caches that answer wrongly, and times of files that jump. The bundle must have the same bytes as
//! without a cache, whatever a record contains and whatever time files have.

use std::collections::BTreeMap;
use std::fs::{self, File, FileTimes};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use super::{FaultPackage, environment};
use xtask::CommandFailure;

/// Rounds of each kind of wrong record, each over all records.
pub const ROUNDS: usize = 12;

/// What a store returns instead of a record.
pub type StoreFault = fn(&[u8], &[u8], u64) -> Vec<u8>;

pub const WRONG: &[(&str, StoreFault)] = &[
    ("record with a flipped bit", |record, _, number| flipped(record, number)),
    ("record that ends early", |record, _, number| record[..at(record, number)].to_vec()),
    ("another text's record", |_, other, _| other.to_vec()),
    ("empty record", |_, _, _| Vec::new()),
    ("record of noise", |record, _, number| noise(record.len(), number)),
];

/// How far the times of files jump, in days, into the past and the future, for every file of the
/// package.
const JUMPS: [i64; 6] = [-20_000, -366, -1, 1, 366, 20_000];

/// Tries every kind of wrong record and every jump; returns the findings.
pub fn run(
    package: &FaultPackage,
    seed: u64,
    counts: &mut BTreeMap<&'static str, usize>,
) -> Result<Vec<String>, CommandFailure> {
    let mut findings = Vec::new();
    package.change(0)?;
    let expected = package.made(true)?;
    for (fault, wrong) in WRONG {
        for round in 0..ROUNDS {
            package.made(false)?;
            let changed = spoil(package, *wrong, seed.wrapping_add(round as u64 * 7919))?;
            *counts.entry(fault).or_default() += changed;
            if package.made(false)? != expected {
                findings.push(format!("{fault}: another bundle"));
            }
        }
    }
    for days in JUMPS {
        for path in files(&package.folder)? {
            shift(&path, days)?;
            *counts.entry("time of a file that jumps").or_default() += 1;
        }
        if package.made(false)? != expected {
            findings.push(format!("times of files that jump by {days} days: another bundle"));
        }
    }
    findings.iter().for_each(|finding| println!("{finding}"));
    Ok(findings)
}

impl FaultPackage {
    /// The files of the bundle that a run makes in an empty folder. With `alone`, the run has no
    /// cache.
    fn made(&self, alone: bool) -> Result<BTreeMap<PathBuf, Vec<u8>>, CommandFailure> {
        let out = self.folder.join("fresh");
        let _ = fs::remove_dir_all(&out);
        let mut command = std::process::Command::new(&self.program);
        command.args(["gen", "-o", "fresh"]);
        command.args(if alone { &["--no-cache"][..] } else { &["--cache", "cache"][..] });
        let output = self.prepared(command).output().map_err(environment)?;
        if !output.status.success() {
            let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
            return Err(CommandFailure::check(format!("a run with a wrong cache fails: {stderr}")));
        }
        let read = |path: PathBuf| {
            let name = path.strip_prefix(&out).unwrap_or(&path).to_owned();
            fs::read(&path).map(|bytes| (name, bytes)).map_err(environment)
        };
        files(&out)?.into_iter().map(read).collect()
    }
}

/// Makes every record of the cache wrong; returns how many there are.
fn spoil(package: &FaultPackage, wrong: StoreFault, seed: u64) -> Result<usize, CommandFailure> {
    let paths = files(&package.folder.join("cache"))?;
    let records: Vec<Vec<u8>> =
        paths.iter().map(fs::read).collect::<Result<_, _>>().map_err(environment)?;
    for (number, path) in paths.iter().enumerate() {
        let other = &records[(number + 1) % records.len()];
        let bytes = wrong(&records[number], other, seed.wrapping_add(number as u64));
        fs::write(path, bytes).map_err(environment)?;
    }
    Ok(paths.len())
}

fn shift(path: &Path, days: i64) -> Result<(), CommandFailure> {
    let by = Duration::from_secs(days.unsigned_abs() * 86_400);
    let now = SystemTime::now();
    let then = if days < 0 { now.checked_sub(by) } else { now.checked_add(by) };
    let times = FileTimes::new().set_modified(then.unwrap_or(now));
    let file = File::options().append(true).open(path).map_err(environment)?;
    file.set_times(times).map_err(environment)
}

pub fn files(folder: &Path) -> Result<Vec<PathBuf>, CommandFailure> {
    let (mut found, mut open) = (Vec::new(), vec![folder.to_owned()]);
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(folder).map_err(environment)? {
            let path = entry.map_err(environment)?.path();
            if path.is_dir() { open.push(path) } else { found.push(path) }
        }
    }
    found.sort();
    Ok(found)
}

/// A position in the record that depends on a number.
fn at(record: &[u8], number: u64) -> usize {
    (number.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 33) as usize % record.len().max(1)
}

fn flipped(record: &[u8], number: u64) -> Vec<u8> {
    let mut bytes = record.to_vec();
    let place = at(record, number);
    if let Some(byte) = bytes.get_mut(place) {
        *byte ^= 1 << (number % 8);
    }
    bytes
}

fn noise(length: usize, number: u64) -> Vec<u8> {
    (0..length)
        .map(|i| (number.wrapping_add(i as u64).wrapping_mul(0x2545_f491_4f6c_dd1d) >> 56) as u8)
        .collect()
}
