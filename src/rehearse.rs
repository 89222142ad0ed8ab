//! Work by others' code that could end the process, done first in a process of its own.
//!
//! An exhausted stack or memory cannot be caught. [`crate::limits`] bound what others' code sees,
//! and nothing that stays below a part of each bound was ever seen to exhaust anything. What lies
//! between that part and the bound is *rehearsed*: a child process with little memory and time does
//! the same work, and where it dies its input is an error. Ordinary input never starts a process.
//!
//! The crate starts none by itself either: a program says how with [`run_by`], as `lamplight` does.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::{Mutex, OnceLock, PoisonError};

use crate::limits::REHEARSAL_SECONDS;

/// How a rehearsal ended badly.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Exhausted {
    /// More memory than a rehearsal may have.
    Memory,
    /// The stack.
    Stack,
    /// More time than a rehearsal may take.
    Time,
    /// It stopped for a reason of its own, in its last words.
    Stopped(String),
}

impl fmt::Display for Exhausted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Memory => f.write_str("takes more memory than it may have"),
            Self::Stack => f.write_str("exhausts its stack"),
            Self::Time => write!(f, "takes more than {REHEARSAL_SECONDS} seconds"),
            Self::Stopped(words) => write!(f, "ends its process: {words}"),
        }
    }
}

/// Does a stage's job in a process of its own.
pub type Runner = fn(stage: &str, job: &[u8]) -> Result<(), Exhausted>;

/// What became of a job, by the hash of its stage and bytes.
type Known = BTreeMap<[u8; 32], Result<(), Exhausted>>;

/// Jobs that are remembered: an error is found several times on its way to its author.
const REMEMBERED: usize = 1024;

static RUNNER: OnceLock<Runner> = OnceLock::new();
static KNOWN: Mutex<Known> = Mutex::new(BTreeMap::new());

/// Rehearsals of this process go through `runner` from now on.
pub fn run_by(runner: Runner) {
    // The first stays.
    let _ = RUNNER.set(runner);
}

/// Rehearses a job, one at a time, unless it was rehearsed before. Without a runner nothing
/// happens.
///
/// # Errors
/// What the job exhausted: it must not be done in this process.
pub fn rehearse(stage: &str, job: &[u8]) -> Result<(), Exhausted> {
    let Some(runner) = RUNNER.get() else { return Ok(()) };
    let mut hasher = blake3::Hasher::new();
    hasher.update(stage.as_bytes()).update(&[0]).update(job);
    let key = *hasher.finalize().as_bytes();
    // Held while the job runs: several at once would take several times the memory.
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
