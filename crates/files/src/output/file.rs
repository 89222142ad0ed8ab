//! Writes a file that the user names.

use std::fs::{self, File, FileType, OpenOptions};
use std::io::{self, ErrorKind, Read, Write};
use std::path::{Path, PathBuf};

use super::scratch::sync_folder;
use super::{Error, Foreign, Replace, Scratch, make_folder, rename_finished};

/// How many bytes of a file are read to see whether it is ours.
pub const HEAD_BYTES: usize = 4096;

/// Replaces a file whatever it is. This is for files whose content the caller has read and
/// understood, or that are in a folder of ours.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    write_file(path, bytes, |_| true, Replace::Any)
}

/// Writes a file, or the stream that the path names.
///
/// `is_ours` looks at the first [`HEAD_BYTES`] bytes of a file that is there and not empty.
///
/// # Errors
/// [`Error::Foreign`] where something else is there.
pub fn write_file(
    path: &Path,
    bytes: &[u8],
    is_ours: impl Fn(&[u8]) -> bool,
    replace: Replace,
) -> Result<(), Error> {
    if is_descriptor(path) {
        return append_bytes(path, bytes);
    }
    let Some(found) = metadata_at(path)? else { return put_file(path, bytes, None) };
    if is_stream(found.file_type()) {
        return append_bytes(path, bytes);
    }
    if !found.is_file() {
        return Err(Foreign::never(path, kind_of_entry(found.file_type())).into());
    }
    let real = path.canonicalize().map_err(|error| Error::io(path, &error))?;
    if has_bytes(&real, found.len(), bytes) {
        return Ok(());
    }
    let head = read_head(&real).map_err(|error| Error::io(path, &error))?;
    if replace == Replace::Ours && !head.is_empty() && !is_ours(&head) {
        return Err(Foreign::file(path, "is a file that Lamplight did not write").into());
    }
    put_file(&real, bytes, Some(found.permissions()))
}

/// What is at a path, links followed; `None` where nothing is.
fn metadata_at(path: &Path) -> Result<Option<fs::Metadata>, Error> {
    match fs::metadata(path) {
        Ok(found) => Ok(Some(found)),
        Err(error) if error.kind() == ErrorKind::NotFound => match fs::symlink_metadata(path) {
            Ok(_) => Err(Foreign::never(path, "is a link that leads nowhere").into()),
            Err(_) => Ok(None),
        },
        // A file instead of a folder is reported when the folder is made.
        Err(error) if error.kind() == ErrorKind::NotADirectory => Ok(None),
        Err(error) => Err(Error::io(path, &error)),
    }
}

/// Writes a file beside the path and renames it.
fn put_file(path: &Path, bytes: &[u8], permissions: Option<fs::Permissions>) -> Result<(), Error> {
    let folder = parent_folder(path);
    make_folder(&folder)?;
    // The user knows the file, and not the folder beside it that the text is written to first.
    let named = |error| match error {
        Error::Io { kind, reason, .. } => Error::Io { path: path.to_owned(), kind, reason },
        foreign => foreign,
    };
    let scratch = Scratch::new(&folder).map_err(named)?;
    let written = scratch.write("file", bytes).map_err(named)?;
    if let Some(permissions) = permissions {
        fs::set_permissions(&written, permissions).map_err(|error| Error::io(path, &error))?;
    }
    rename_finished(&written, path).map_err(|error| Error::io(path, &error))?;
    sync_folder(&folder);
    Ok(())
}

fn parent_folder(path: &Path) -> PathBuf {
    let parent = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    parent.unwrap_or(Path::new(".")).to_owned()
}

/// Writes to a stream, or to the end of a file that is open as one of our descriptors.
fn append_bytes(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    let all = |stream: &mut dyn Write| stream.write_all(bytes).and_then(|()| stream.flush());
    let written = match path.to_str() {
        // A socket cannot be opened by its path.
        Some("/dev/stdout") => all(&mut io::stdout()),
        _ => OpenOptions::new().append(true).open(path).and_then(|mut stream| all(&mut stream)),
    };
    written.map_err(|error| Error::io(path, &error))
}

/// Whether the path names an open file of a process, such as `/dev/stdout`. Somebody holds the file
/// that such a path leads to, and would not see a file that replaced it.
fn is_descriptor(path: &Path) -> bool {
    const MOST_LINKS: usize = 16;
    let mut at = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    for _ in 0..MOST_LINKS {
        if ["/proc", "/dev/fd", "/dev/stdin", "/dev/stdout", "/dev/stderr"]
            .iter()
            .any(|known| at.starts_with(known))
        {
            return true;
        }
        let Ok(next) = fs::read_link(&at) else { return false };
        at = parent_folder(&at).join(next);
    }
    false
}

#[cfg(unix)]
pub(super) fn is_stream(kind: FileType) -> bool {
    use std::os::unix::fs::FileTypeExt;
    kind.is_char_device() || kind.is_fifo()
}

#[cfg(not(unix))]
pub(super) fn is_stream(_: FileType) -> bool {
    false
}

/// Describes something that is not a file.
pub(super) fn kind_of_entry(kind: FileType) -> &'static str {
    if kind.is_dir() {
        "is a folder"
    } else if kind.is_symlink() {
        "is a link"
    } else if is_stream(kind) {
        "is a pipe or a device"
    } else {
        "is neither a file nor a folder"
    }
}

/// Whether a file has these bytes.
pub(super) fn has_bytes(path: &Path, length: u64, bytes: &[u8]) -> bool {
    length == bytes.len() as u64 && fs::read(path).is_ok_and(|found| found == bytes)
}

fn read_head(path: &Path) -> io::Result<Vec<u8>> {
    let mut head = Vec::new();
    File::open(path)?.take(HEAD_BYTES as u64).read_to_end(&mut head)?;
    Ok(head)
}
