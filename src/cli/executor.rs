//! Executors as options name them.

use super::failure::Failure;
use crate::execute::Session;
use crate::execute::executors::{self, ExecutorEntry};

/// The executor of that name.
pub fn find_executor(name: &str) -> Result<&'static ExecutorEntry, Failure> {
    executors::find_executor(name).ok_or_else(|| {
        Failure::usage(format!(
            "there is no executor `{name}` (executors: {})",
            executor_names(|_| true)
        ))
    })
}

/// The executor of that name, which must draw frames.
pub fn find_drawing(name: &str) -> Result<&'static ExecutorEntry, Failure> {
    let entry = find_executor(name)?;
    match entry.samples {
        Some(_) => Ok(entry),
        None => Err(Failure::usage(format!(
            "`{name}` draws no pictures (executors that do: {})",
            executor_names(|entry| entry.samples.is_some())
        ))),
    }
}

/// Opens an executor.
pub fn open_executor(entry: &ExecutorEntry) -> Result<Box<dyn Session>, Failure> {
    entry.start().map_err(Failure::environment)
}

fn executor_names(wanted: impl Fn(&ExecutorEntry) -> bool) -> String {
    let names: Vec<&str> =
        executors::ALL.iter().filter(|entry| wanted(entry)).map(|entry| entry.name).collect();
    names.join(", ")
}
