//! A sandbox for work of other people's code that could crash the process: the work is done in a
//! separate process first.
//!
//! Running out of stack or memory cannot be caught. [`crate::limits`] bound the input of such code.
//! No input below a part of each bound was ever seen to exhaust anything. Input between that part
//! and the bound goes through the *sandbox*: a child process with little memory and time does the
//! same work, and if it crashes, its input is an error. Ordinary input never starts a process.
//!
//! As a library the crate never starts a process either: a program must say how with [`run_by`], as
//! `lamplight` does.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::{Mutex, OnceLock, PoisonError};

use crate::limits::SANDBOX_SECONDS;

/// Why a job failed in the sandbox.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SandboxFailure {
    /// More memory than the sandbox may have.
    Memory,
    /// The stack.
    Stack,
    /// More time than the sandbox may take.
    Time,
    /// It stopped for another reason, which its last output tells.
    Stopped(String),
}

impl fmt::Display for SandboxFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Memory => f.write_str("takes more memory than it may have"),
            Self::Stack => f.write_str("exhausts its stack"),
            Self::Time => write!(f, "takes more than {SANDBOX_SECONDS} seconds"),
            Self::Stopped(words) => write!(f, "ends its process: {words}"),
        }
    }
}

/// Does a stage's job in a separate process.
pub type SandboxRunner = fn(stage: &str, job: &[u8]) -> Result<(), SandboxFailure>;

/// The result of each job, by the hash of its stage and bytes.
type KnownResults = BTreeMap<[u8; 32], Result<(), SandboxFailure>>;

/// How many results are remembered. One job may be asked for several times before its error is
/// reported.
const REMEMBERED: usize = 1024;

static RUNNER: OnceLock<SandboxRunner> = OnceLock::new();
static KNOWN: Mutex<KnownResults> = Mutex::new(BTreeMap::new());

/// From now on, `runner` is the sandbox of this process.
pub fn run_by(runner: SandboxRunner) {
    // If one was set before, that one stays.
    let _ = RUNNER.set(runner);
}

/// Does a job in the sandbox, unless that was done before. Only one job runs at a time. Without a
/// runner nothing happens.
///
/// # Errors
/// What the job exhausted: it must not be done in this process.
pub fn try_in_sandbox(stage: &str, job: &[u8]) -> Result<(), SandboxFailure> {
    let Some(runner) = RUNNER.get() else { return Ok(()) };
    let mut hasher = blake3::Hasher::new();
    hasher.update(stage.as_bytes()).update(&[0]).update(job);
    let key = *hasher.finalize().as_bytes();
    // The lock is held while the job runs, since several jobs at once would need several times the
    // memory.
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(result) = known.get(&key) {
        return result.clone();
    }
    if known.len() >= REMEMBERED {
        known.clear();
    }
    let result = runner(stage, job);
    known.insert(key, result.clone());
    result
}
