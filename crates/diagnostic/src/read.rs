//! Diagnostics about files that could not be read.

use super::{Diagnostic, codes};
use crate::source::{LIMITS, ReadError, ReadFailure};

/// The diagnostic has no label at the place that asked for the file; add one with
/// [`Diagnostic::at`]. Only for text that is not UTF-8 it points to the first wrong byte.
impl From<ReadFailure> for Diagnostic {
    fn from(failure: ReadFailure) -> Self {
        let ReadFailure { path, shown, error, place } = failure;
        match error {
            ReadError::OutsideRoot => Self::error(
                codes::OUTSIDE_ROOT,
                format!("`{path}` leads out of its package's root"),
            ),
            ReadError::TooLarge { bytes } => Self::error(
                codes::FILE_TOO_LARGE,
                format!(
                    "`{shown}` has {bytes} bytes, more than the {} that are allowed",
                    LIMITS.file_bytes
                ),
            ),
            ReadError::Io(words) => {
                Self::error(codes::UNREADABLE, format!("cannot read `{shown}`: {words}"))
            }
            ReadError::NotUtf8 { .. } => {
                let error = Self::error(codes::NOT_UTF8, format!("`{shown}` is not UTF-8"));
                place
                    .into_iter()
                    .fold(error, |error, place| error.at(place, "the first byte that is not"))
            }
        }
    }
}
