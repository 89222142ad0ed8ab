//! Writes the kept items, with a source map.

use super::gap::{self, GapPiece};
use super::items::GlslItem;
use super::table::Spellings;
use super::token::{NONE, Tok};
use crate::{Segment, SourceMap};
use lamplight_diagnostic::source::Span;
use lamplight_syntax::glsl::Module;
use lamplight_syntax::words::continues_word;

/// Output text and its map.
pub struct Writer<'a> {
    modules: &'a [Module],
    spellings: &'a Spellings<'a>,
    pub text: String,
    pub map: SourceMap,
}

impl<'a> Writer<'a> {
    /// Nothing is written yet.
    pub fn new(modules: &'a [Module], spellings: &'a Spellings<'a>, capacity: usize) -> Self {
        Self {
            modules,
            spellings,
            text: String::with_capacity(capacity),
            map: SourceMap::default(),
        }
    }

    /// Writes text of the composer's own.
    pub fn made(&mut self, text: &str) {
        self.segment(None, false);
        self.text.push_str(text);
    }

    /// Writes the line of a directive.
    pub fn line(&mut self, line: Span) {
        if let Some(module) = self.modules.iter().find(|module| module.source == line.source) {
            self.segment(Some(line), true);
            self.text.push_str(&module.text[line.range()]);
            self.made("\n");
        }
    }

    /// Writes an item with its comments; it ends with a newline.
    pub fn item(&mut self, tokens: &[Tok], item: &GlslItem) {
        let tokens = &tokens[item.tokens.clone()];
        self.leading(&tokens[0]);
        let mut at = 0;
        while at < tokens.len() {
            let run = self.run(&tokens[at..]);
            self.tokens(&tokens[at..at + run]);
            at += run;
            if let Some(next) = tokens.get(at) {
                self.gap(&tokens[at - 1], next);
            }
        }
        self.trailing(&tokens[tokens.len() - 1]);
        self.made("\n");
    }

    fn segment(&mut self, span: Option<Span>, verbatim: bool) {
        self.map.push(Segment { start: self.text.len() as u32, span, verbatim });
    }

    /// How many of the tokens, from the first on, can be copied in one go from their file.
    fn run(&self, tokens: &[Tok]) -> usize {
        let first = &tokens[0];
        let is_spliced =
            (first.end - first.start) as usize != self.spellings.text(first.symbol).len();
        if !first.is_plain() || is_spliced {
            return 1;
        }
        let source = &self.modules[first.module as usize].tokens;
        let follows = |pair: &[Tok]| {
            let next = &pair[1];
            next.is_plain()
                && next.module == pair[0].module
                && next.before == pair[0].after + 1
                && source[next.before as usize].clean
        };
        1 + tokens.windows(2).take_while(|pair| follows(pair)).count()
    }

    fn tokens(&mut self, run: &[Tok]) {
        let (first, last) = (&run[0], &run[run.len() - 1]);
        let text = &self.modules[first.module as usize].text;
        let spelling = self.spellings.text(first.symbol);
        let span = Span { end: last.end, ..first.span(self.modules) };
        if run.len() > 1 || text[span.range()] == *spelling {
            self.segment(Some(span), !first.expanded);
            self.text.push_str(&text[span.range()]);
        } else {
            self.segment(Some(span), false);
            self.text.push_str(spelling);
        }
    }

    /// Bytes between a token and the one before it, or the beginning of its part of the file.
    fn gap_before(&self, tok: &Tok) -> Span {
        let module = &self.modules[tok.module as usize];
        let token = &module.tokens[tok.before as usize];
        let part = if token.first_of_part { module.text_part(tok.before) } else { None };
        let previous =
            || tok.before.checked_sub(1).map_or(0, |previous| module.tokens[previous as usize].end);
        let start = part.map_or_else(previous, |part| part.bytes.start);
        Span { source: module.source, start, end: token.start }
    }

    /// Bytes between a token and the one after it, or the end of its part of the file.
    fn gap_after(&self, tok: &Tok) -> Span {
        let module = &self.modules[tok.module as usize];
        let start = module.tokens[tok.after as usize].end;
        let end = match module.tokens.get(tok.after as usize + 1) {
            Some(next) if !next.first_of_part => next.start,
            _ => module.text_part(tok.after).map_or(start, |part| part.bytes.end),
        };
        Span { source: module.source, start, end }
    }

    fn source(&self, tok: &Tok, span: Span) -> &'a str {
        &self.modules[tok.module as usize].text[span.range()]
    }

    /// Writes the comments that belong to the first token of an item.
    fn leading(&mut self, first: &Tok) {
        if first.before == NONE {
            return;
        }
        let span = self.gap_before(first);
        let module = &self.modules[first.module as usize];
        let after_item = !module.tokens[first.before as usize].first_of_part;
        let text = self.source(first, span);
        let kept = gap::attached_part(text, after_item);
        self.pieces(
            &[(Span { start: span.start + kept.start as u32, ..span }, &text[kept])],
            false,
        );
    }

    fn trailing(&mut self, last: &Tok) {
        if last.after == NONE {
            return;
        }
        let span = self.gap_after(last);
        let text = self.source(last, span);
        let kept = gap::trailing_comments(text);
        if !kept.is_empty() {
            self.pieces(
                &[(Span { end: span.start + kept.end as u32, ..span }, &text[kept])],
                false,
            );
            self.text.truncate(self.text.trim_end().len());
        }
    }

    /// Writes what stands between two tokens of an item.
    fn gap(&mut self, left: &Tok, right: &Tok) {
        if right.before == NONE || left.after == NONE {
            return self.minimal_gap(left, right);
        }
        let before = self.gap_before(right);
        if left.module == right.module && left.after + 1 == right.before {
            return match self.source(right, before) {
                "" => self.minimal_gap(left, right),
                text => self.pieces(&[(before, text)], false),
            };
        }
        let after = self.gap_after(left);
        let text = self.source(left, after);
        // Between the two there is a directive, so that each is at the edge of its part, or a macro
        // that expanded to nothing.
        let ends_part = self.modules[left.module as usize]
            .tokens
            .get(left.after as usize + 1)
            .is_none_or(|next| next.first_of_part);
        let left = (after, if ends_part { text } else { "" });
        self.pieces(&[left, (before, self.source(right, before))], ends_part);
    }

    /// Writes a space where the author has one, or where the two tokens would otherwise become one.
    fn minimal_gap(&mut self, left: &Tok, right: &Tok) {
        let first = self.spellings.text(left.symbol).chars().next_back();
        let second = self.spellings.text(right.symbol).chars().next();
        if right.spaced || would_join(first, second) {
            self.made(" ");
        }
    }

    /// Writes comments as they are, and white space with at most one blank line and no trailing
    /// blanks.
    fn pieces(&mut self, gaps: &[(Span, &str)], new_line: bool) {
        let (mut newlines, mut indent, mut any) = (0, "", false);
        for (span, text) in gaps {
            for (at, piece) in gap::gap_pieces(text) {
                match piece {
                    GapPiece::Space(space) if piece.newlines() > 0 => {
                        newlines += piece.newlines();
                        indent = last_indentation(space);
                    }
                    GapPiece::Space(space) => {
                        indent = if newlines > 0 { last_indentation(space) } else { " " }
                    }
                    GapPiece::Comment(comment) => {
                        self.space(newlines, indent);
                        let start = span.start + at as u32;
                        self.segment(
                            Some(Span { start, end: start + comment.len() as u32, ..*span }),
                            true,
                        );
                        self.text.push_str(comment.trim_end());
                        (newlines, indent) = (
                            usize::from(
                                comment.starts_with("//") && at + comment.len() == text.len(),
                            ),
                            "",
                        );
                    }
                }
                any = true;
            }
        }
        if any || new_line {
            self.space(newlines.max(usize::from(new_line && newlines == 0)), indent);
        }
    }

    fn space(&mut self, newlines: usize, indent: &str) {
        self.segment(None, false);
        self.text.push_str(&"\n\n"[..newlines.min(2)]);
        self.text.push_str(indent);
    }
}

fn last_indentation(space: &str) -> &str {
    space.rsplit(['\n', '\r', '\\']).next().unwrap_or_default()
}

fn would_join(left: Option<char>, right: Option<char>) -> bool {
    let (Some(left), Some(right)) = (left, right) else { return false };
    let number = |c: char| c.is_ascii_digit() || c == '.';
    (continues_word(left) && continues_word(right))
        || (number(left) && number(right))
        || ("+-*/%<>=!&|^#".contains(left) && "+-*/<>=&|^#".contains(right))
}
