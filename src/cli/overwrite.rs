//! What commands that write files share.

use std::io::{ErrorKind, Write};
use std::path::Path;

use clap::Args;

use super::failure::Failure;
use super::terminal::stderr;
use crate::bundle;
use crate::output::{Error, Foreign, Replace};

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

/// Says why nothing happens for the moment.
pub fn tell_waiting(out: &Path) {
    let _ = writeln!(stderr(), "waiting for another run that writes `{}`", out.display());
}

/// A bundle that could not be written.
pub fn write_failure(out: &Path, error: bundle::Error) -> Failure {
    match error {
        bundle::Error::Foreign(foreign) => foreign.into(),
        error => Failure::environment(format!("cannot write `{}`: {error}", out.display())),
    }
}
