//! The system's clock is set while commands run. `gen`, its cache, its lock and `watch` must go on
//! as if nothing had happened.
//!
//! A small library, loaded by `LD_PRELOAD`, answers every call that asks for the time. Lamplight
//! decides nothing by the date, and its cache drops nothing by age. Libraries that it depends on
//! may do both, so this is tried.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};
use std::{fs, thread};

use super::{FaultPackage, environment};
use xtask::CommandFailure;

const SHIM: &str = include_str!("clock.c");
const FAULT: &str = "system clock that is set";

/// How far the clock jumps, in days, at every second call. The furthest is before 1970.
const JUMPS: [i64; 8] = [-25_000, -366, -31, -1, 1, 31, 366, 25_000];
/// How long `watch` may take to bundle a change.
const PATIENCE: Duration = Duration::from_secs(30);

/// Makes every run with every jump; returns what went wrong.
pub fn run(
    package: &FaultPackage,
    counts: &mut BTreeMap<&'static str, usize>,
) -> Result<Vec<String>, CommandFailure> {
    let clock = Clock::new(package)?;
    let mut findings = Vec::new();
    for days in JUMPS {
        for (what, run) in RUNS {
            *counts.entry(FAULT).or_default() += 1;
            let outcome = run(package, &clock, days)?;
            findings
                .extend(outcome.map(|reason| format!("{what}, {FAULT} by {days} days: {reason}")));
        }
    }
    findings.iter().for_each(|finding| println!("{finding}"));
    Ok(findings)
}

/// One run under a clock that jumps by so many days. Returns what is wrong afterwards, if anything.
type ClockRun = fn(&FaultPackage, &Clock, i64) -> Result<Option<String>, CommandFailure>;

const RUNS: &[(&str, ClockRun)] = &[
    ("`gen` after a change", changed),
    ("`gen` from the cache", cached),
    ("two runs at once", at_once),
    ("`watch`", watched),
];

/// The library that answers for the clock.
struct Clock {
    library: PathBuf,
}

impl Clock {
    fn new(package: &FaultPackage) -> Result<Self, CommandFailure> {
        let (source, library) = (package.folder.join("clock.c"), package.folder.join("clock.so"));
        fs::write(&source, SHIM).map_err(environment)?;
        let mut compiler = Command::new("cc");
        compiler.args(["-shared", "-fPIC", "-O1", "-o"]).arg(&library).arg(&source);
        let made = compiler.output().map_err(environment)?;
        let stderr = String::from_utf8_lossy(&made.stderr).into_owned();
        let clock = Self { library };
        let year = |days| clock.year(days);
        match made.status.success() {
            true if year(25_000)? != year(0)? => Ok(clock),
            true => Err(CommandFailure::environment("no program's clock can be set here")),
            false => Err(CommandFailure::environment(format!("cc: {stderr}"))),
        }
    }

    /// The year that `date` prints under the clock. It shows whether clocks can be set on this
    /// machine.
    fn year(&self, days: i64) -> Result<Vec<u8>, CommandFailure> {
        let mut date = Command::new("date");
        let output = self.set(date.arg("+%Y"), days).output().map_err(environment)?;
        Ok(output.stdout)
    }

    fn set<'c>(&self, command: &'c mut Command, days: i64) -> &'c mut Command {
        let seconds = (days * 86_400).to_string();
        command.env("LD_PRELOAD", &self.library).env("LAMPLIGHT_JUMP", seconds)
    }
}

impl FaultPackage {
    fn gen_with(&self, clock: &Clock, days: i64) -> Command {
        let mut command = self.command();
        clock.set(&mut command, days);
        command
    }

    /// What is wrong after a run that should have written this number into each of the three
    /// shaders.
    fn current(&self, output: &Output, number: usize) -> Result<Option<String>, CommandFailure> {
        let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
        Ok(match output.status.success() {
            false => Some(format!("the run fails: {stderr}")),
            true => self.problem_after(output).or(self.lacks(&self.folder.join("bundle"), number)?),
        })
    }

    /// What is wrong unless each of the three shaders of a bundle has this number.
    fn lacks(&self, bundle: &Path, number: usize) -> Result<Option<String>, CommandFailure> {
        // naga writes a whole number in this way.
        let words = format!("{number}f");
        let mut found = 0;
        for blob in fs::read_dir(bundle.join("blobs")).map_err(environment)? {
            let text = fs::read(blob.map_err(environment)?.path()).unwrap_or_default();
            found += usize::from(String::from_utf8_lossy(&text).contains(&words));
        }
        Ok((found < 3).then(|| format!("{found} of 3 shaders have `{words}`")))
    }
}

/// A number that no other run writes into its shader, so that an old bundle cannot pass for a new
/// one.
fn fresh(days: i64, salt: usize) -> usize {
    salt + (days + 30_000) as usize
}

fn changed(
    package: &FaultPackage,
    clock: &Clock,
    days: i64,
) -> Result<Option<String>, CommandFailure> {
    let number = fresh(days, 1_000_000);
    package.change(number)?;
    let output = package.gen_with(clock, days).output().map_err(environment)?;
    package.current(&output, number)
}

/// Records of the cache that were written under one clock are found under another.
fn cached(
    package: &FaultPackage,
    clock: &Clock,
    days: i64,
) -> Result<Option<String>, CommandFailure> {
    let number = fresh(days, 2_000_000);
    package.change(number)?;
    let first = package.gen_with(clock, days).output().map_err(environment)?;
    fs::remove_dir_all(package.folder.join("bundle")).map_err(environment)?;
    let second = package.gen_with(clock, -days).output().map_err(environment)?;
    let stdout = String::from_utf8_lossy(&second.stdout).into_owned();
    Ok(match package.current(&second, number)? {
        None if !first.status.success() => Some("the first run fails".to_owned()),
        None if !stdout.contains("cache") => {
            Some(format!("nothing comes from the cache: {stdout}"))
        }
        outcome => outcome,
    })
}

/// Two runs on one folder, each under a clock of its own: one waits for the other.
fn at_once(
    package: &FaultPackage,
    clock: &Clock,
    days: i64,
) -> Result<Option<String>, CommandFailure> {
    let number = fresh(days, 3_000_000);
    package.change(number)?;
    let start = |days| {
        let mut command = package.gen_with(clock, days);
        command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().map_err(environment)
    };
    let (one, other) = (start(days)?, start(-days)?);
    for output in [one, other].map(Child::wait_with_output) {
        let output = output.map_err(environment)?;
        if let Some(reason) = package.current(&output, number)? {
            return Ok(Some(reason));
        }
    }
    Ok(None)
}

/// `watch` sees a change and bundles it.
fn watched(
    package: &FaultPackage,
    clock: &Clock,
    days: i64,
) -> Result<Option<String>, CommandFailure> {
    let (before, after) = (fresh(days, 4_000_000), fresh(days, 5_000_000));
    package.change(before)?;
    let mut command = Command::new(&package.program);
    command.args(["watch", "--cache", "cache", "-o", "bundle"]);
    let mut command = package.prepared(command);
    clock.set(&mut command, days).stdout(Stdio::null()).stderr(Stdio::null());
    let mut watch = command.spawn().map_err(environment)?;
    let outcome = seen(package, before, &mut watch).and_then(|first| match first {
        None => {
            package.change(after)?;
            seen(package, after, &mut watch)
        }
        first => Ok(first),
    });
    let _ = watch.kill();
    let _ = watch.wait();
    outcome
}

/// Waits until the bundle has the number; returns what it lacks when that takes too long.
fn seen(
    package: &FaultPackage,
    number: usize,
    watch: &mut Child,
) -> Result<Option<String>, CommandFailure> {
    let (start, bundle) = (Instant::now(), package.folder.join("bundle"));
    loop {
        // The folder of the bundle may not be there yet.
        let lacks = package.lacks(&bundle, number).unwrap_or(Some("no bundle".to_owned()));
        match (lacks, watch.try_wait().map_err(environment)?) {
            (None, _) => return Ok(None),
            (Some(reason), Some(status)) => {
                return Ok(Some(format!("it ends ({status}): {reason}")));
            }
            (Some(reason), None) if start.elapsed() > PATIENCE => return Ok(Some(reason)),
            _ => thread::sleep(Duration::from_millis(20)),
        }
    }
}
