//! Makes the lines that a diagnostic points to fit to be printed. Long lines are cut around the
//! labels, and characters that would move a terminal's cursor or reverse its writing direction are
//! replaced.

use std::ops::Range;

use codespan_reporting::files::{Error, Files};

use super::escape::needs_escape;
use crate::source::{SourceId, SourceSet, Span};

/// A line with more bytes than this is cut: the bytes that are kept before the label, and in all.
const LONG: usize = 240;
const BEFORE: usize = 80;
const WINDOW: usize = 200;

/// How many lines around the labelled ones are kept: as many as codespan may show.
const AROUND: usize = 3;

/// How many characters of a message are shown.
const MESSAGE: usize = 400;

/// Stands for text that was left out.
const GAP: &str = "…";

/// A message without control characters, in lines that are short enough to read.
pub fn tidy_message(message: &str) -> String {
    message.split('\n').map(tidy_line).collect::<Vec<_>>().join("\n")
}

fn tidy_line(line: &str) -> String {
    let line: String = line.chars().map(harmless_character).collect();
    if line.chars().count() <= MESSAGE {
        return line;
    }
    let half = |count| line.chars().take(count).collect::<String>();
    let tail: Vec<char> = line.chars().rev().take(MESSAGE / 2).collect();
    half(MESSAGE / 2) + GAP + &tail.into_iter().rev().collect::<String>()
}

/// The texts that the labels of one diagnostic point into, by [`SourceId`], as far as they are
/// needed.
pub struct Excerpts<'a> {
    sources: &'a SourceSet,
    pages: Vec<ExcerptPage>,
}

/// Some lines in a row of one text.
struct ExcerptPage {
    source: SourceId,
    /// Number of the first line, from 0.
    first: usize,
    lines: Vec<ExcerptLine>,
    text: String,
}

struct ExcerptLine {
    /// Where the line starts in the page.
    start: usize,
    /// Where it starts in the author's text.
    origin: usize,
    /// Which bytes of the author's line are shown.
    shown: Range<usize>,
    /// How many bytes of the page's line come before them: those of [`GAP`] if text was left out
    /// there, or else none.
    lead: usize,
}

impl<'a> Excerpts<'a> {
    pub fn new(sources: &'a SourceSet, spans: &[Span]) -> Self {
        let mut ids: Vec<SourceId> = spans.iter().map(|span| span.source).collect();
        ids.sort();
        ids.dedup();
        let page = |id: SourceId| {
            let ranges: Vec<Range<usize>> =
                spans.iter().filter(|span| span.source == id).map(|span| span.range()).collect();
            ExcerptPage::new(id, &sources.get(id).text, &ranges)
        };
        Self { sources, pages: ids.into_iter().map(page).collect() }
    }

    /// The bytes of the page that show a span.
    pub fn range(&self, span: Span) -> Range<usize> {
        self.page(span.source.0 as usize).map_or(0..0, |page| {
            let start = page.place(span.start as usize);
            start..page.place(span.end as usize).max(start)
        })
    }

    fn page(&self, id: usize) -> Result<&ExcerptPage, Error> {
        self.pages.iter().find(|page| page.source.0 as usize == id).ok_or(Error::FileMissing)
    }
}

impl ExcerptPage {
    fn new(source: SourceId, text: &str, ranges: &[Range<usize>]) -> Self {
        let line_of = |byte: usize| {
            text.as_bytes()[..byte.min(text.len())].iter().filter(|byte| **byte == b'\n').count()
        };
        let first = ranges
            .iter()
            .map(|range| line_of(range.start))
            .min()
            .unwrap_or(0)
            .saturating_sub(AROUND);
        let last = ranges.iter().map(|range| line_of(range.end)).max().unwrap_or(0) + AROUND;
        let mut page = Self { source, first, lines: Vec::new(), text: String::new() };
        let mut origin = 0;
        for (number, line) in text.split('\n').enumerate().take(last + 1) {
            if number >= first {
                page.push(origin, line, ranges);
            }
            origin += line.len() + 1;
        }
        page
    }

    fn push(&mut self, origin: usize, line: &str, ranges: &[Range<usize>]) {
        let line = line.strip_suffix('\r').unwrap_or(line);
        let window = visible_window(origin, line, ranges);
        let start = self.text.len();
        let lead = if window.start > 0 { GAP } else { "" };
        let tail = if window.end < line.len() { GAP } else { "" };
        self.text.push_str(lead);
        self.text.extend(line[window.clone()].chars().map(harmless_character));
        self.text.push_str(tail);
        self.text.push('\n');
        self.lines.push(ExcerptLine {
            start,
            origin,
            shown: origin + window.start..origin + window.end,
            lead: lead.len(),
        });
    }

    /// The byte of the page for a byte of the author's text: the nearest one that is shown.
    fn place(&self, byte: usize) -> usize {
        let index = self.lines.partition_point(|line| line.origin <= byte).saturating_sub(1);
        self.lines.get(index).map_or(0, |line| {
            line.start + line.lead + byte.clamp(line.shown.start, line.shown.end) - line.shown.start
        })
    }

    fn line(&self, index: usize) -> Result<&ExcerptLine, Error> {
        self.lines
            .get(index)
            .ok_or(Error::LineTooLarge { given: index, max: self.lines.len().saturating_sub(1) })
    }
}

/// The part of a line to show: around the first range that starts or ends in it.
fn visible_window(origin: usize, line: &str, ranges: &[Range<usize>]) -> Range<usize> {
    if line.len() <= LONG {
        return 0..line.len();
    }
    let bytes = origin..=origin + line.len();
    let ends = ranges.iter().flat_map(|range| [range.start, range.end]);
    let focus =
        ends.filter(|byte| bytes.contains(byte)).map(|byte| byte - origin).next().unwrap_or(0);
    let start = line.floor_char_boundary(focus.saturating_sub(BEFORE));
    start..line.floor_char_boundary((start + WINDOW).min(line.len()))
}

/// Replaces control characters and changes of writing direction by characters of as many bytes.
fn harmless_character(character: char) -> char {
    match character {
        '\t' => character,
        '\0'..'\x20' | '\x7f' => '?',
        '\u{80}'..='\u{9f}' | '\u{61c}' => '¿',
        other if needs_escape(other) => char::REPLACEMENT_CHARACTER,
        _ => character,
    }
}

impl<'a> Files<'a> for Excerpts<'a> {
    type FileId = usize;
    type Name = String;
    type Source = &'a str;

    fn name(&self, id: usize) -> Result<String, Error> {
        Ok(tidy_message(&self.sources.get(self.page(id)?.source).path))
    }

    fn source(&'a self, id: usize) -> Result<&'a str, Error> {
        Ok(&self.page(id)?.text)
    }

    fn line_index(&self, id: usize, byte: usize) -> Result<usize, Error> {
        Ok(self.page(id)?.lines.partition_point(|line| line.start <= byte).saturating_sub(1))
    }

    fn line_number(&self, id: usize, index: usize) -> Result<usize, Error> {
        Ok(self.page(id)?.first + index + 1)
    }

    fn column_number(&self, id: usize, index: usize, byte: usize) -> Result<usize, Error> {
        let page = self.page(id)?;
        let line = page.line(index)?;
        let byte = line.shown.start + byte.saturating_sub(line.start + line.lead);
        Ok(self
            .sources
            .get(page.source)
            .text
            .get(line.origin..byte)
            .map_or(0, |before| before.chars().count())
            + 1)
    }

    fn line_range(&self, id: usize, index: usize) -> Result<Range<usize>, Error> {
        let page = self.page(id)?;
        Ok(page.line(index)?.start
            ..page.lines.get(index + 1).map_or(page.text.len(), |next| next.start))
    }
}
