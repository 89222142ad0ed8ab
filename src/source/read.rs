//! Reading one file of a package, its failures as diagnostics.

use super::{LIMITS, Package, ReadError, SourceId, SourceSet, Span};
use crate::diagnostic::{Diagnostic, codes};

/// Reads `path` of `package` into the set. `None` where there is no such file.
///
/// The diagnostic has no label of the place that asked for the file, except for text that is not
/// UTF-8, where it points to the first bad byte: add the asker's with [`Diagnostic::at`].
pub fn read(sources: &mut SourceSet, package: &Package, path: &str) -> Result<Option<SourceId>, Diagnostic> {
    let shown = package.files.display(path);
    match package.files.read(path) {
        Ok(text) => Ok(text.map(|text| sources.add(shown, text))),
        Err(ReadError::OutsideRoot) => Err(Diagnostic::error(codes::OUTSIDE_ROOT, format!("`{path}` leads out of its package's root"))),
        Err(ReadError::TooLarge { bytes }) => Err(Diagnostic::error(
            codes::FILE_TOO_LARGE,
            format!("`{shown}` has {bytes} bytes, more than the {} that are allowed", LIMITS.file_bytes),
        )),
        Err(ReadError::Io(words)) => Err(Diagnostic::error(codes::UNREADABLE, format!("cannot read `{shown}`: {words}"))),
        Err(ReadError::NotUtf8 { lossy, offset }) => Err(not_utf8(sources, shown, lossy, offset)),
    }
}

fn not_utf8(sources: &mut SourceSet, shown: String, lossy: String, offset: usize) -> Diagnostic {
    let message = format!("`{shown}` is not UTF-8");
    // The first bad byte became one replacement character in the lossy text.
    let end = (offset + char::REPLACEMENT_CHARACTER.len_utf8()).min(lossy.len());
    let source = sources.add(shown, lossy);
    Diagnostic::error(codes::NOT_UTF8, message).at(Span::new(source, offset..end), "the first byte that is not")
}
