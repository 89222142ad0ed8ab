//! The only way to read from the disk. It reads nothing but files, and of those no more than a
//! given number of bytes.
//!
//! A pipe would make its reader wait for ever, and a device such as `/dev/zero` has no end.

use std::fs::{self, File};
use std::io::{Error, ErrorKind, Read, Result};
use std::path::Path;

/// Opens a path if it is a file; links are followed.
pub fn open_file(path: &Path) -> Result<File> {
    // Checked before it is opened, since opening a pipe waits.
    check_is_file(&fs::metadata(path)?)?;
    let file = File::open(path)?;
    check_is_file(&file.metadata()?)?;
    Ok(file)
}

/// The bytes of a file that has at most `most`.
pub fn read_file(path: &Path, most: u64) -> Result<Vec<u8>> {
    let file = open_file(path)?;
    let length = file.metadata()?.len();
    if length > most {
        return Err(too_large(length, most));
    }
    let mut bytes = Vec::with_capacity(length as usize);
    // Reading ends even if the file grows meanwhile.
    match file.take(most.saturating_add(1)).read_to_end(&mut bytes)? as u64 {
        read if read > most => Err(too_large(read, most)),
        _ => Ok(bytes),
    }
}

/// So many bytes of a file from a position. The position of other readers does not change.
///
/// # Errors
/// The file ends before, even if it was longer when it was opened.
pub fn read_at(file: &File, at: u64, length: usize) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    bytes.try_reserve_exact(length).map_err(|error| Error::new(ErrorKind::OutOfMemory, error))?;
    bytes.resize(length, 0);
    read_exactly(file, &mut bytes, at)?;
    Ok(bytes)
}

#[cfg(unix)]
fn read_exactly(file: &File, bytes: &mut [u8], at: u64) -> Result<()> {
    std::os::unix::fs::FileExt::read_exact_at(file, bytes, at)
}

#[cfg(windows)]
fn read_exactly(file: &File, mut bytes: &mut [u8], mut at: u64) -> Result<()> {
    while !bytes.is_empty() {
        match std::os::windows::fs::FileExt::seek_read(file, bytes, at)? {
            0 => return Err(ErrorKind::UnexpectedEof.into()),
            read => (bytes, at) = (&mut bytes[read..], at + read as u64),
        }
    }
    Ok(())
}

/// Systems without files, such as WebAssembly.
#[cfg(not(any(unix, windows)))]
fn read_exactly(_: &File, _: &mut [u8], _: u64) -> Result<()> {
    Err(ErrorKind::Unsupported.into())
}

fn check_is_file(found: &fs::Metadata) -> Result<()> {
    if found.is_file() {
        return Ok(());
    }
    let what = if found.is_dir() { "is a folder, not a file" } else { "is a pipe or a device" };
    Err(Error::new(ErrorKind::InvalidInput, what))
}

fn too_large(length: u64, most: u64) -> Error {
    let words = format!("has {length} bytes, more than the {most} that are allowed");
    Error::new(ErrorKind::FileTooLarge, words)
}
