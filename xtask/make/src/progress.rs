//! How far a run is, on standard error: one line that changes on a terminal, and elsewhere a line for
//! each stage and every few seconds.

use std::io::{IsTerminal, Write, stderr};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// How long nothing is printed where there is no terminal.
const PAUSE: Duration = Duration::from_secs(5);

/// The stage of the last line, and when it was printed.
static LAST: Mutex<Option<(String, Instant)>> = Mutex::new(None);

pub fn show_progress(stage: &str, done: usize, total: usize) {
    let is_end = done == total;
    if stderr().is_terminal() {
        let end = if is_end { "\n" } else { "" };
        let _ = write!(stderr(), "\r{stage}: {done} of {total}{end}");
        return;
    }
    let mut last = LAST.lock().unwrap_or_else(PoisonError::into_inner);
    let is_due = match &*last {
        Some((before, at)) if before == stage => is_end || at.elapsed() >= PAUSE,
        _ => true,
    };
    if is_due {
        *last = Some((stage.to_owned(), Instant::now()));
        let _ = writeln!(stderr(), "{stage}: {done} of {total}");
    }
}
