//! Reading one file of a package.

use super::{Package, ReadError, SourceId, SourceSet, Span};

/// Why a file of a package was not read. Becomes a diagnostic with `?`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReadFailure {
    /// The path that was asked for, below the package's root.
    pub path: String,
    /// The path as the author sees it.
    pub shown: String,
    /// What is wrong.
    pub error: ReadError,
    /// The first bad byte of a text that is not UTF-8.
    pub place: Option<Span>,
}

/// Reads `path` of `package` into the set. `None` where there is no such file.
///
/// # Errors
/// The file cannot be read. The failure does not know the place that asked for it.
pub fn read(
    sources: &mut SourceSet,
    package: &Package,
    path: &str,
) -> Result<Option<SourceId>, ReadFailure> {
    let shown = package.files.display(path);
    match package.files.read(path) {
        Ok(text) => Ok(text.map(|text| {
            let id = sources.add(shown, text);
            if package.files.on_disk(path) {
                sources.mark_on_disk(id);
            }
            id
        })),
        Err(error) => {
            let place = bad_byte(sources, &shown, &error);
            Err(ReadFailure { path: path.to_owned(), shown, error, place })
        }
    }
}

/// Adds a text that is not UTF-8, as far as it can be shown, and points to its first wrong byte.
fn bad_byte(sources: &mut SourceSet, shown: &str, error: &ReadError) -> Option<Span> {
    let ReadError::NotUtf8 { lossy, offset } = error else { return None };
    // The first wrong byte became one replacement character in the lossy text.
    let end = (offset + char::REPLACEMENT_CHARACTER.len_utf8()).min(lossy.len());
    let source = sources.add(shown, lossy.as_str());
    Some(Span::new(source, *offset..end))
}
