//! The bytes of a single-file bundle.

use std::borrow::Cow;
use std::fs::File;
use std::io::ErrorKind;
use std::path::Path;

use super::{Error, HEADER_BYTES, slice_at};
use lamplight_files::input;

/// A file that is read where something is asked for, or bytes in memory.
///
/// The file is not mapped. If another process truncated a mapped file, the next access would end
/// this process. A read of such a file is an error, and checksums find other changes.
pub enum BundleBytes {
    Stored { file: File, length: usize },
    Owned(Vec<u8>),
}

impl BundleBytes {
    /// Opens a file of at least the size of a header.
    pub fn open(path: &Path) -> Result<Self, Error> {
        let file = input::open_file(path)?;
        let length = file.metadata()?.len();
        if length < HEADER_BYTES as u64 {
            return Err(Error::corrupt("header", "the file is too short"));
        }
        let length = usize::try_from(length)
            .map_err(|_| Error::corrupt("header", "the file is too large for this system"))?;
        Ok(Self::Stored { file, length })
    }

    /// How many bytes there were on opening.
    pub fn len(&self) -> usize {
        match self {
            Self::Stored { length, .. } => *length,
            Self::Owned(bytes) => bytes.len(),
        }
    }

    /// The bytes at a place, of which `part` is shown in errors.
    pub fn read(&self, at: usize, length: usize, part: &str) -> Result<Cow<'_, [u8]>, Error> {
        let file = match self {
            Self::Stored { file, length: all } => {
                if at.checked_add(length).is_none_or(|end| end > *all) {
                    return Err(Error::corrupt(part, "a position is out of range"));
                }
                file
            }
            Self::Owned(bytes) => return slice_at(bytes, at, length, part).map(Cow::Borrowed),
        };
        input::read_at(file, at as u64, length).map(Cow::Owned).map_err(|error| {
            match error.kind() {
                ErrorKind::UnexpectedEof => Error::corrupt(
                    part,
                    "the file has become shorter since it was opened: replace it by renaming",
                ),
                _ => error.into(),
            }
        })
    }
}
