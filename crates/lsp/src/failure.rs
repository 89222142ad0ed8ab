//! Why a request has no answer.

use std::fmt;

use super::wire::{FAILED, WRONG_PARAMETERS};

/// The error of a request, which the editor shows.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum RequestError {
    /// The parameters have no value of this name, or one of another type.
    Parameter(&'static str),
    /// The document is not open.
    NotOpen,
    /// The package of the document cannot be read.
    Unreadable,
    /// There is no name at the position.
    NoName,
    /// `workspace/executeCommand` names a command that does not exist.
    UnknownCommand(String),
    /// What was asked for cannot be done, for this reason.
    Refused(String),
}

impl RequestError {
    /// The protocol's number for it.
    pub fn number(&self) -> i32 {
        match self {
            Self::Parameter(_) => WRONG_PARAMETERS,
            Self::NotOpen
            | Self::Unreadable
            | Self::NoName
            | Self::UnknownCommand(_)
            | Self::Refused(_) => FAILED,
        }
    }
}

impl fmt::Display for RequestError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Parameter(name) => write!(f, "the parameters have no valid `{name}`"),
            Self::NotOpen => f.write_str("the document is not open"),
            Self::Unreadable => f.write_str("the package cannot be read"),
            Self::NoName => f.write_str("there is no name here"),
            Self::UnknownCommand(name) => write!(f, "there is no command `{name}`"),
            Self::Refused(reason) => f.write_str(reason),
        }
    }
}

impl std::error::Error for RequestError {}

impl From<String> for RequestError {
    fn from(reason: String) -> Self {
        Self::Refused(reason)
    }
}
