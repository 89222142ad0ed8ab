//! Why something could not be written.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

/// Why something could not be written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Error {
    /// Something is there that we did not write.
    Foreign(Foreign),
    /// The operating system refused, with its message.
    Io { path: PathBuf, kind: io::ErrorKind, reason: String },
}

/// Something at the path that would be written, which is left alone.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Foreign {
    pub path: PathBuf,
    /// What it is, as the end of a sentence that begins with the path.
    pub found: String,
    /// Whether [`super::Replace::Any`] would replace it.
    pub can_be_forced: bool,
}

impl Foreign {
    /// Something that is replaced if the user asks for it with `--force`.
    pub fn file(path: &Path, found: impl Into<String>) -> Self {
        Self { path: path.to_owned(), found: found.into(), can_be_forced: true }
    }

    /// Something that is never replaced.
    pub fn never(path: &Path, found: impl Into<String>) -> Self {
        Self { path: path.to_owned(), found: found.into(), can_be_forced: false }
    }
}

impl Error {
    pub fn io(path: &Path, error: &io::Error) -> Self {
        Self::Io { path: path.to_owned(), kind: error.kind(), reason: error.to_string() }
    }
}

impl From<Foreign> for Error {
    fn from(foreign: Foreign) -> Self {
        Self::Foreign(foreign)
    }
}

impl fmt::Display for Foreign {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` {}", self.path.display(), self.found)
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Foreign(foreign) => foreign.fmt(f),
            Self::Io { path, reason, .. } => write!(f, "`{}`: {reason}", path.display()),
        }
    }
}

impl std::error::Error for Error {}

impl From<Error> for io::Error {
    fn from(error: Error) -> Self {
        match &error {
            Error::Foreign(_) => Self::new(io::ErrorKind::AlreadyExists, error),
            Error::Io { kind, .. } => Self::new(*kind, error),
        }
    }
}
