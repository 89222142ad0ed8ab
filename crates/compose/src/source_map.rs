//! Maps bytes of a composed text to the author's text.

use std::ops::Range;

use lamplight_diagnostic::source::{SourceId, Span};
use lamplight_diagnostic::{Diagnostic, Label};

/// A run of output bytes copied from one place, or standing in for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Segment {
    /// First output byte; the segment reaches to the next one's.
    pub start: u32,
    /// Where it came from. `None` for text the composer made itself.
    pub span: Option<Span>,
    /// Whether output and input correspond byte by byte (a copy) or only as a whole (a rename).
    pub verbatim: bool,
}

/// Sorted segments that cover the output from its first byte.
#[derive(Debug, Clone, Default)]
pub struct SourceMap {
    segments: Vec<Segment>,
    /// For each text, the import or include that led to it first. The root has none.
    pub imports: Vec<(SourceId, Span)>,
}

impl SourceMap {
    /// A map without segments of texts that were read like this.
    pub fn of_imports(imports: Vec<(SourceId, Span)>) -> Self {
        Self { segments: Vec::new(), imports }
    }

    /// Appends a segment; starts must not decrease.
    pub fn push(&mut self, segment: Segment) {
        debug_assert!(self.segments.last().is_none_or(|last| last.start <= segment.start));
        self.segments.push(segment);
    }

    /// Whether nothing of the output has a place.
    pub fn is_empty(&self) -> bool {
        self.segments.is_empty()
    }

    /// Moves the labels of a problem from the output to the authors' texts. Labels of what has no
    /// author go.
    pub fn move_labels(&self, problem: &mut Diagnostic) {
        let labels = std::mem::take(&mut problem.labels);
        let moved = labels.into_iter().filter_map(|label| {
            let span = self.lookup(label.span.range())?;
            Some(Label { span, message: label.message })
        });
        problem.labels = moved.collect();
    }

    /// The author's span for a range of the output, if its first byte has an author.
    ///
    /// For a range over several segments, the span ends where the last byte of the range came from
    /// if that is in the same source, and else with the first segment.
    pub fn lookup(&self, range: Range<usize>) -> Option<Span> {
        let first = self
            .segments
            .partition_point(|segment| segment.start as usize <= range.start)
            .checked_sub(1)?;
        let segment = self.segments[first];
        let span = segment.span?;
        if !segment.verbatim {
            return Some(span);
        }
        let start = (span.start + (range.start as u32 - segment.start)).min(span.end);
        let end = self.end(first, range.end, span.source).unwrap_or(span.end).max(start);
        Some(Span { source: span.source, start, end })
    }

    /// Where the last byte before `end` came from, if in the same source at or after segment
    /// `first`.
    fn end(&self, first: usize, end: usize, source: SourceId) -> Option<u32> {
        let last = self
            .segments
            .partition_point(|segment| (segment.start as usize) < end)
            .checked_sub(1)?;
        let segment = self.segments[last.max(first)];
        let span = segment.span.filter(|span| span.source == source)?;
        if !segment.verbatim {
            return Some(span.end);
        }
        Some((span.start + (end as u32).saturating_sub(segment.start)).min(span.end))
    }

    /// Replaces places. What is at another place afterwards corresponds to it as a whole.
    pub fn replace(&mut self, change: &dyn Fn(Span) -> Span) {
        for segment in &mut self.segments {
            let Some(span) = segment.span else { continue };
            let changed = change(span);
            segment.verbatim &= changed == span;
            segment.span = Some(changed);
        }
        for (_, span) in &mut self.imports {
            *span = change(*span);
        }
    }

    /// All segments, in order of output.
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }
}
