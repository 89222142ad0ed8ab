//! Reads from the exit status of a worker what it found.

use std::process::ExitStatus;

/// The exit code of a worker that found something.
const FOUND: i32 = 3;

/// What a worker found wrong, from how it ended and what it printed on standard error.
///
/// # Errors
/// If the worker could not do its work. This is no finding, and no reason to believe that there are
/// none.
pub fn read_ending(status: ExitStatus, message: &str) -> Result<Option<String>, String> {
    match status.code() {
        Some(0) => Ok(None),
        Some(FOUND) => Ok(Some(message.to_owned())),
        Some(code) => Err(format!("a worker ended with code {code}: {message}")),
        // A signal ended it.
        None => Ok(Some(format!("aborts ({status})"))),
    }
}
