//! `cargo xtask faults`: tries system calls that fail, runs that are killed at such a call, caches
//! that answer wrongly, bundles that are damaged, times of files that jump, and a clock that is set
//! while commands run.
//!
//! A small bundle is generated over an older one, once for each occurrence of each call. `strace`
//! makes that occurrence fail or end the run. Whatever happens, the folder must hold a complete
//! bundle afterwards, the older or the newer one. Panics are findings too. Runs are also killed one
//! after another in the same folder.

mod bundles;
mod clocks;
mod pairs;
mod stores;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use xtask::process::{beside_this, root};
use xtask::{CommandFailure, CommandResult};

/// System calls that name a file, or that write to one.
const CALLS: &[&str] = &[
    "openat",
    "write",
    "rename",
    "mkdir",
    "unlink",
    "unlinkat",
    "rmdir",
    "statx",
    "fstat",
    "fsync",
    "flock",
    "read",
    "lseek",
    "getdents64",
    "readlink",
    "ftruncate",
];

/// What happens at a call: a name, and the argument for `strace`.
const FAULTS: &[(&str, &str)] = &[
    ("disk full", "error=ENOSPC"),
    ("input or output error", "error=EIO"),
    ("not permitted", "error=EACCES"),
    ("quota exceeded", "error=EDQUOT"),
    ("read-only file system", "error=EROFS"),
    ("too many open files", "error=EMFILE"),
    ("late by 20 ms", "delay_enter=20000"),
    ("killed", "signal=KILL"),
];

/// The most faults of one kind at one call, since later occurrences are alike.
const MOST: usize = 24;

const MANIFEST: &str = "[program.small]\nwesl = \"small.wesl\"\ntargets = [\"wgsl\"]\n\
    [program.small.axis]\ncount = { values = [1, 2, 3] }\n";

/// Injects every fault. A bundle that is not complete afterwards gives exit code 3.
pub fn run(arguments: &[String]) -> CommandResult {
    let (seed, only) = parsed(arguments)?;
    let package = FaultPackage::new()?;
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    let mut findings = Vec::new();
    let wanted = |kind: &str| only.is_none_or(|only| only == kind);
    for call in CALLS.iter().filter(|_| wanted("calls")) {
        for (fault, words) in FAULTS {
            for occurrence in 1..=MOST {
                let inject = format!("inject={call}:{words}:when={occurrence}");
                match package.injected(call, &inject, occurrence)? {
                    Injected::No => break,
                    Injected::Whole => *counts.entry(fault).or_default() += 1,
                    Injected::Wrong(reason) => {
                        *counts.entry(fault).or_default() += 1;
                        println!("{fault} at {call} {occurrence}: {reason}");
                        findings.push(reason);
                    }
                }
            }
        }
    }
    if wanted("pairs") {
        findings.extend(pairs::run(&package, &mut counts)?);
    }
    if wanted("stores") {
        findings.extend(stores::run(&package, seed, &mut counts)?);
    }
    if wanted("bundles") {
        findings.extend(bundles::run(&package, seed, &mut counts)?);
    }
    if wanted("clocks") {
        findings.extend(clocks::run(&package, &mut counts)?);
    }
    for (fault, count) in &counts {
        println!("{fault:32} {count:6}");
    }
    println!("{:32} {:6}, {} findings", "all", counts.values().sum::<usize>(), findings.len());
    match findings.is_empty() {
        true => Ok(()),
        false => Err(CommandFailure::check(format!("{} findings", findings.len()))),
    }
}

/// The kinds of faults, each of which can be tried alone.
const KINDS: [&str; 5] = ["calls", "pairs", "stores", "bundles", "clocks"];

/// The seed, and the kind of faults if only one is tried.
fn parsed(arguments: &[String]) -> Result<(u64, Option<&str>), CommandFailure> {
    const USAGE: &str = "usage: cargo xtask faults [--seed N] [calls|pairs|stores|bundles|clocks]";
    let wrong = || CommandFailure::usage(USAGE);
    let (seed, rest) = match arguments {
        [name, seed, rest @ ..] if name == "--seed" => (seed.parse().map_err(|_| wrong())?, rest),
        rest => (1, rest),
    };
    match rest {
        [] => Ok((seed, None)),
        [kind] if KINDS.contains(&kind.as_str()) => Ok((seed, Some(kind))),
        _ => Err(wrong()),
    }
}

/// The result of a run with a fault.
enum Injected {
    /// The run made fewer such calls, so nothing was injected.
    No,
    Whole,
    Wrong(String),
}

/// A package with a bundle.
struct FaultPackage {
    folder: PathBuf,
    program: PathBuf,
}

impl FaultPackage {
    fn new() -> Result<Self, CommandFailure> {
        let program = beside_this()?;
        let folder = root().join("target/faults");
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).map_err(environment)?;
        fs::write(folder.join("lamplight.toml"), MANIFEST).map_err(environment)?;
        let package = Self { folder, program };
        package.change(0)?;
        let made = package.command().output().map_err(environment)?;
        match made.status.success() {
            true => Ok(package),
            false => {
                Err(CommandFailure::environment(String::from_utf8_lossy(&made.stderr).into_owned()))
            }
        }
    }

    fn change(&self, number: usize) -> CommandResult {
        let text = format!(
            "@fragment fn fs_main() -> @location(0) vec4f {{
                return vec4f(f32(constants::count), {number}.0, 0.0, 1.0);
            }}"
        );
        fs::write(self.folder.join("small.wesl"), text).map_err(environment)
    }

    fn command(&self) -> Command {
        let mut command = Command::new(&self.program);
        command.args(["gen", "--cache", "cache", "-o", "bundle"]);
        self.prepared(command)
    }

    fn prepared(&self, mut command: Command) -> Command {
        command.current_dir(&self.folder).env("RAYON_NUM_THREADS", "1").stdin(Stdio::null());
        command
    }

    /// Runs with a fault, and checks the bundle.
    fn injected(
        &self,
        call: &str,
        inject: &str,
        number: usize,
    ) -> Result<Injected, CommandFailure> {
        self.change(number + 1)?;
        let trace = self.folder.join("trace");
        let mut command = Command::new("strace");
        command.args(["-f", "-qq", "-o"]).arg(&trace).args(["-e", &format!("trace={call}")]);
        command.args(["-e", inject]).arg(&self.program);
        command.args(["gen", "--cache", "cache", "-o", "bundle"]);
        let output = self.prepared(command).output().map_err(environment)?;
        let is_killed = output.status.code().is_none_or(|code| code > 128);
        if !is_killed && !was_injected(&trace) {
            return Ok(Injected::No);
        }
        Ok(self.problem_after(&output).map_or(Injected::Whole, Injected::Wrong))
    }

    /// What is wrong after a run, if anything is.
    fn problem_after(&self, output: &Output) -> Option<String> {
        let stderr = String::from_utf8_lossy(&output.stderr);
        if stderr.contains("panicked") || stderr.contains("internal error") {
            return Some(format!("the run panics: {stderr}"));
        }
        let mut command = Command::new(&self.program);
        command.args(["bundle", "verify", "bundle"]);
        let looked = self.prepared(command).output().ok()?;
        let reason = String::from_utf8_lossy(&looked.stderr).into_owned();
        (!looked.status.success()).then_some(reason)
    }
}

fn was_injected(trace: &Path) -> bool {
    fs::read_to_string(trace)
        .is_ok_and(|text| text.contains("(INJECTED)") || text.contains("(DELAYED)"))
}

fn environment(error: std::io::Error) -> CommandFailure {
    CommandFailure::environment(error.to_string())
}
