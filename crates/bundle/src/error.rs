//! What can go wrong with a bundle.

use std::fmt;

use lamplight_files::output::{self, Foreign};

/// Why a bundle, or a part of it, cannot be used.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error {
    /// Reading or writing failed, with the reason: an error of the operating system, or a limit
    /// that is exceeded.
    Io(String),
    /// Where the bundle would be written, there is something that Lamplight did not write.
    Foreign(Foreign),
    /// The bundle is damaged, or it is not a bundle.
    Corrupt {
        /// Which part of the bundle.
        part: String,
        /// What is wrong with it.
        reason: String,
    },
    /// The bundle was written in a format that this loader does not read.
    Version {
        /// The version of the bundle.
        found: u32,
        /// The version of this loader.
        known: u32,
    },
    /// There is no program, entry point or target of that name.
    NotFound {
        /// What kind of thing it is.
        what: &'static str,
        /// What was asked for.
        name: String,
        /// The names that there are.
        known: Vec<String>,
    },
    /// A key names an axis or a value that the program does not have.
    BadKey {
        /// The key as it was given.
        key: String,
        /// What is wrong with it.
        reason: String,
    },
    /// The bundle has no such permutation.
    Miss(Box<Miss>),
    /// Two bundles to merge disagree about what the text says.
    Conflict(String),
}

/// A requested permutation that is not in the bundle.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Miss {
    /// The requested key, in canonical form.
    pub requested: String,
    /// The permutation that differs in the fewest axes; of several, the first by text. `None` if
    /// the entry point has no permutations.
    pub nearest: Option<String>,
}

impl Error {
    /// The missing permutation, if that is the error.
    pub fn miss(&self) -> Option<&Miss> {
        match self {
            Self::Miss(miss) => Some(miss),
            _ => None,
        }
    }

    pub(super) fn corrupt(part: impl Into<String>, reason: impl Into<String>) -> Self {
        Self::Corrupt { part: part.into(), reason: reason.into() }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(reason) => write!(f, "the bundle cannot be read or written: {reason}"),
            Self::Foreign(foreign) => foreign.fmt(f),
            Self::Corrupt { part, reason } => write!(f, "the bundle is damaged: {part}: {reason}"),
            Self::Version { found, known } => write!(
                f,
                "the bundle has format version {found}, this loader reads version {known}"
            ),
            Self::NotFound { what, name, known } => {
                write!(f, "the bundle has no {what} `{name}`; it has: {}", known.join(", "))
            }
            Self::BadKey { key, reason } => {
                write!(f, "`{key}` is not a key of this program: {reason}")
            }
            Self::Miss(miss) => {
                write!(f, "the bundle has no permutation `{}`", miss.requested)?;
                match &miss.nearest {
                    Some(nearest) => write!(f, "; the nearest is `{nearest}`"),
                    None => f.write_str("; it has none at all"),
                }
            }
            Self::Conflict(what) => write!(f, "the bundles disagree about {what}"),
        }
    }
}

impl std::error::Error for Error {}

impl From<std::io::Error> for Error {
    fn from(error: std::io::Error) -> Self {
        Self::Io(error.to_string())
    }
}

impl From<output::Error> for Error {
    fn from(error: output::Error) -> Self {
        match error {
            output::Error::Foreign(foreign) => Self::Foreign(foreign),
            error => Self::Io(error.to_string()),
        }
    }
}
