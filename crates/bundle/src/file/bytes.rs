//! The bytes of a single-file bundle.

use std::path::Path;

use memmap2::Mmap;

use super::{Error, HEADER_BYTES};
use lamplight_files::input;

pub enum BundleBytes {
    Mapped(Mmap),
    Owned(Vec<u8>),
}

impl std::ops::Deref for BundleBytes {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        match self {
            Self::Mapped(map) => map,
            Self::Owned(bytes) => bytes,
        }
    }
}

/// Maps the file. It must not be changed in place while it is open.
pub fn map_file(path: &Path) -> Result<BundleBytes, Error> {
    let file = input::open_file(path)?;
    if file.metadata()?.len() < HEADER_BYTES as u64 {
        return Err(Error::corrupt("header", "the file is too short"));
    }
    // SAFETY: the map is read-only and private to this value. Another process could still change
    // the file under it, which the documentation of this function excludes.
    let map = unsafe { Mmap::map(&file)? };
    Ok(BundleBytes::Mapped(map))
}
