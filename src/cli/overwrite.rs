//! What commands that write files share.

use std::io::{ErrorKind, Write};
use std::path::Path;
use std::time::Duration;

use clap::Args;

use super::failure::Failure;
use super::terminal::stderr;
use crate::output::{Error, Foreign, Replace, Turns};
use crate::{bundle, input};

/// What may be replaced.
#[derive(Args, Clone)]
pub struct Overwrite {
    /// Replace files that Lamplight did not write. Nothing else of yours is ever deleted.
    #[arg(long)]
    force: bool,
}

impl Overwrite {
    pub fn replace(&self) -> Replace {
        if self.force { Replace::Any } else { Replace::Ours }
    }
}

/// The path names a file of somebody else, so the input is wrong.
impl From<Foreign> for Failure {
    fn from(foreign: Foreign) -> Self {
        let help = match foreign.can_be_forced {
            true => "name another place, or add `--force` to replace files there",
            false => "name another place",
        };
        Self::input(format!("cannot write: {foreign}\nhelp: {help}"))
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        match error {
            Error::Foreign(foreign) => foreign.into(),
            Error::Io { kind: ErrorKind::BrokenPipe, .. } => std::process::exit(0),
            error => Self::environment(format!("cannot write {error}")),
        }
    }
}

/// Fails if a file that a command writes has another text.
pub fn compare_file(path: &Path, text: &str) -> Result<(), Failure> {
    if input::read_file(path, text.len() as u64).is_ok_and(|known| known == text.as_bytes()) {
        return Ok(());
    }
    Err(Failure::check(format!(
        "`{}` is not up to date: run the command without `--check`",
        path.display()
    )))
}

/// How long to wait for another run.
#[derive(Args, Clone, Copy)]
pub struct Patience {
    /// Wait at most so long for another run that writes the same bundle.
    #[arg(long, value_name = "SECONDS", default_value_t = Turns::MOST.as_secs())]
    wait: u64,
}

impl Patience {
    /// Does something with the turns that this allows. If it has to wait, it says why.
    pub fn with_turns<T>(self, out: &Path, work: impl FnOnce(&Turns<'_>) -> T) -> T {
        let waiting = |process: Option<u32>| {
            let process = process.map_or_else(String::new, |number| format!(" (process {number})"));
            let out = out.display();
            let _ = writeln!(stderr(), "waiting for another run{process} that writes `{out}`");
        };
        work(&Turns { waiting: &waiting, most: Duration::from_secs(self.wait) })
    }
}

/// A bundle that could not be written.
pub fn write_failure(out: &Path, error: bundle::Error) -> Failure {
    match error {
        bundle::Error::Foreign(foreign) => foreign.into(),
        error => Failure::environment(format!("cannot write `{}`: {error}", out.display())),
    }
}
