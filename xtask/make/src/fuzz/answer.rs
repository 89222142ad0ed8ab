//! Checks the answer to one input: a panic, too much time or memory, or two different answers.

use std::panic;
use std::sync::Mutex;
use std::time::{Duration, Instant};
use std::{fs, io};

use super::kinds::Kind;

/// An answer must not take longer than this.
const LONGEST: Duration = Duration::from_secs(5);
/// An answer must not take more memory than this.
const MOST_KIB: u64 = 1 << 20;

static PLACE: Mutex<Option<String>> = Mutex::new(None);

/// Silences panics, which [`problem_with`] reports.
pub fn quiet() {
    panic::set_hook(Box::new(|info| {
        let place = info.location().map(|place| format!("{}:{}", place.file(), place.line()));
        if let Ok(mut known) = PLACE.lock() {
            *known = place;
        }
    }));
}

/// What is wrong with the answer to an input.
pub fn problem_with(kind: &Kind, input: &[u8]) -> Option<String> {
    let started = Instant::now();
    let answer = panic::catch_unwind(|| (kind.run)(input));
    let Ok(answer) = answer else {
        let place = PLACE.lock().ok().and_then(|mut place| place.take());
        return Some(format!("panics at {}", place.unwrap_or_default()));
    };
    if started.elapsed() > LONGEST && slow(kind, input) {
        return Some(format!("takes more than {LONGEST:?}"));
    }
    if peak_kib() > MOST_KIB {
        return Some(format!("takes more than {} MiB", MOST_KIB >> 10));
    }
    ((kind.run)(input) != answer).then(|| "has two answers".to_owned())
}

/// Whether it takes too long three times in a row, since the machine may be busy with something
/// else.
fn slow(kind: &Kind, input: &[u8]) -> bool {
    (0..3).all(|_| {
        let started = Instant::now();
        (kind.run)(input);
        started.elapsed() > LONGEST
    })
}

/// The most memory used since the last call; 0 where the system does not tell.
fn peak_kib() -> u64 {
    let peak = || -> io::Result<u64> {
        let status = fs::read_to_string("/proc/self/status")?;
        fs::write("/proc/self/clear_refs", "5")?;
        let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        Ok(line.and_then(|line| line.split_whitespace().next()?.parse().ok()).unwrap_or(0))
    };
    peak().unwrap_or(0)
}
