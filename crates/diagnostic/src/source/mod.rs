//! Author's text: files, packages, and spans that always point into them.

mod package;
mod read;

pub use package::{Disk, Embedded, Files, LIMITS, Limits, Memory, Package, ReadError};
pub use package::{is_inside, shown_path};
pub use read::{ReadFailure, read};

/// One text an author wrote, as shown in diagnostics.
#[derive(Debug, Clone)]
pub struct Source {
    /// The path as the author would name it, with `/` as separator. We never make it absolute.
    pub path: String,
    /// The whole text.
    pub text: std::sync::Arc<str>,
    /// Whether the path is that of a file on the disk.
    pub on_disk: bool,
}

/// Index of a [`Source`] in its [`SourceSet`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SourceId(pub u32);

/// A byte range of an author's text.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Span {
    /// The text pointed into.
    pub source: SourceId,
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}

impl Span {
    /// The bytes `range` of `source`.
    pub fn new(source: SourceId, range: std::ops::Range<usize>) -> Self {
        Self { source, start: range.start as u32, end: range.end as u32 }
    }

    /// The range in bytes.
    pub fn range(self) -> std::ops::Range<usize> {
        self.start as usize..self.end as usize
    }
}

/// Every text a run has read; spans are indices into it.
#[derive(Debug, Clone, Default)]
pub struct SourceSet {
    sources: Vec<Source>,
}

impl SourceSet {
    /// Adds a text and returns its index.
    pub fn add(
        &mut self,
        path: impl Into<String>,
        text: impl Into<std::sync::Arc<str>>,
    ) -> SourceId {
        self.sources.push(Source { path: path.into(), text: text.into(), on_disk: false });
        SourceId(self.sources.len() as u32 - 1)
    }

    /// Notes that a text was read from a file on the disk.
    pub fn mark_on_disk(&mut self, id: SourceId) {
        self.sources[id.0 as usize].on_disk = true;
    }

    /// The source behind an index of this set.
    pub fn get(&self, id: SourceId) -> &Source {
        &self.sources[id.0 as usize]
    }

    /// The text a span covers.
    pub fn text(&self, span: Span) -> &str {
        &self.get(span.source).text[span.range()]
    }

    /// All sources, in the order they were read.
    pub fn iter(&self) -> impl Iterator<Item = (SourceId, &Source)> {
        self.sources.iter().enumerate().map(|(index, source)| (SourceId(index as u32), source))
    }

    /// Line and column, both from 1, of a byte; the column counts characters.
    pub fn position(&self, id: SourceId, byte: usize) -> (usize, usize) {
        line_and_column(&self.get(id).text, byte)
    }
}

/// Line and column, both from 1, of a byte; the column counts characters.
pub fn line_and_column(text: &str, byte: usize) -> (usize, usize) {
    let before = &text[..text.floor_char_boundary(byte.min(text.len()))];
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
}
