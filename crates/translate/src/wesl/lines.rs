//! Comments and blank lines between tokens.

use lamplight_syntax::wesl::blank::comment_length;

use super::Reader;
use crate::tree::Line;

impl Reader<'_> {
    /// The lines between the token before `at` and `at`, without a comment that belongs to the line
    /// of the token before. Blank lines at the start and before the end are kept once.
    pub fn lines_before(&self, at: usize) -> Vec<Line> {
        let (_, rest) = self.gap(at);
        lines_of(rest)
    }

    /// A comment after the token before `at`, on its line.
    pub fn comment_behind(&self, at: usize) -> Option<String> {
        self.gap(at).0.map(str::to_owned)
    }

    /// The text before a token: a comment on the line of the token before, and the rest.
    fn gap(&self, at: usize) -> (Option<&str>, &str) {
        let start = at.checked_sub(1).map_or(0, |before| self.tokens.tokens[before].end as usize);
        let text = &self.tokens.text[start..self.tokens.start(at) as usize];
        let line = text.trim_start_matches([' ', '\t']);
        let length = comment_length(line);
        if length == 0 || start == 0 {
            return (None, text);
        }
        let comment = line[..length].trim_end();
        let rest = &line[length..];
        let ends_line = rest.trim_start_matches([' ', '\t', '\r']).starts_with('\n');
        match ends_line || rest.trim().is_empty() {
            true => (Some(comment), rest),
            false => (None, text),
        }
    }

    /// The comments within the tokens `first + 1..end`, as lines: they have no place of their own
    /// in an expression.
    pub fn comments_within(&self, first: usize, end: usize) -> Vec<Line> {
        let mut lines = Vec::new();
        for at in first + 1..end {
            let start = self.tokens.tokens[at - 1].end as usize;
            let text = &self.tokens.text[start..self.tokens.start(at) as usize];
            lines.extend(lines_of(text).into_iter().filter(|line| *line != Line::Blank));
        }
        lines
    }
}

/// The comments of a text that has nothing else, and its blank lines, of which a run is one.
fn lines_of(text: &str) -> Vec<Line> {
    let mut lines = Vec::new();
    let (mut at, mut breaks) = (0, 0);
    while at < text.len() {
        let length = comment_length(&text[at..]);
        if length > 0 {
            if breaks > 1 {
                lines.push(Line::Blank);
            }
            lines.push(Line::Comment(text[at..at + length].trim_end().to_owned()));
            breaks = 0;
            at += length;
        } else {
            breaks += usize::from(text[at..].starts_with('\n'));
            at += text[at..].chars().next().map_or(1, char::len_utf8);
        }
    }
    if breaks > 1 {
        lines.push(Line::Blank);
    }
    lines
}

/// The lines without blank ones at the start and the end.
pub fn trim_blank(mut lines: Vec<Line>) -> Vec<Line> {
    while lines.last() == Some(&Line::Blank) {
        lines.pop();
    }
    let first = lines.iter().position(|line| *line != Line::Blank).unwrap_or(lines.len());
    lines.split_off(first)
}
