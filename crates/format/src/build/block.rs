//! Statements in a row, blocks in braces, and labels.

use lamplight_bundle::Language;
use lamplight_syntax::wesl::blank::is_line_break;

use super::{Builder, ConditionStyle};
use crate::op::{Break, GroupKind, Op, Place};
use crate::options::Braces;
use crate::token::Kind;

/// After so many comments in a row, it is not looked for a label.
const COMMENTS: usize = 64;

/// How far a statement goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Extent {
    /// Up to the semicolon at an index.
    Semicolon(usize),
    /// Up to the block whose brace is at an index.
    Block(usize),
    /// Up to an index at which something else begins.
    Open(usize),
}

impl Builder<'_> {
    /// Lays out statements, each in lines of its own.
    pub(super) fn statements(&mut self, start: usize, end: usize, level: u16) {
        let (mut index, mut own) = (start, level);
        while index < end {
            let is_label = self.is_label(index);
            if is_label || self.tokens[index].kind == Kind::Raw {
                own = level;
            }
            let token = &self.tokens[index];
            if token.is_comment() && index > start && self.is_trailing(index) {
                self.push(Op::Gap(index as u32));
                self.token(index);
                index += 1;
                continue;
            }
            let shown = if token.is_comment() && own > level && self.is_before_label(index, end) {
                level
            } else {
                own
            };
            if self.is_mark(index, ";") && token.breaks == 0 && index > start {
                // A semicolon too many.
                self.token(index);
                index += 1;
                continue;
            }
            match self.joins_condition(index) {
                true => self.push(Op::Space),
                false => self.line(index, shown, index == start),
            }
            self.last = None;
            index = self.statement(index, end, own);
            if is_label {
                own = level + 1;
            }
        }
    }

    /// Whether a comment in the column of a label stands before one.
    fn is_before_label(&self, index: usize, end: usize) -> bool {
        let next = (index..end).take(COMMENTS).find(|at| !self.tokens[*at].is_comment());
        next.is_none_or(|at| self.is_label(at))
    }

    /// Whether `@else` stands behind the `}` that its author wrote before it.
    fn joins_condition(&self, index: usize) -> bool {
        self.is_condition(index)
            && self.word(index + 1) != "if"
            && self.breaks(index) == 0
            && index > 0
            && self.is_mark(index - 1, "}")
            && self.last == Some(index - 1)
    }

    /// Lays out one statement; the index behind it.
    pub(super) fn statement(&mut self, index: usize, end: usize, level: u16) -> usize {
        let token = &self.tokens[index];
        let next = if token.is_comment() || token.begins_line() {
            self.token(index);
            index + 1
        } else {
            self.attributed(index, end, level)
        };
        if !token.is_comment() {
            self.layout.statements.push(index..next);
        }
        next
    }

    /// Lays out the attributes before a statement, which may stand in lines of their own, and the
    /// statement.
    fn attributed(&mut self, start: usize, end: usize, level: u16) -> usize {
        let mut index = start;
        while index < end && self.is_mark(index, "@") {
            let next = self.attribute_end(index, end);
            if index > start && self.last.is_some() {
                self.gap(index);
            }
            self.open(GroupKind::Element, false, false);
            self.run_from(index, next);
            self.close();
            let is_block = self.is_condition(index) && self.is_mark(next, "{");
            index = self.trailing_comments(next, end);
            if index >= end {
                return end;
            }
            if is_block {
                return self.condition_block(start, index, level);
            }
            if self.tokens[index].is_comment() || self.tokens[index].begins_line() {
                // The statement goes on below its comments.
                return index;
            }
            if self.breaks(index) > 0 {
                self.line(index, level, true);
                self.last = None;
            }
        }
        if self.last.is_some() && self.last != Some(index) && index > start {
            self.push(Op::Space);
            self.last = None;
        }
        if self.is_mark(index, "{") {
            return self.block(index, level);
        }
        self.bare_statement(index, end, level)
    }

    /// A run at whose first token nothing precedes.
    fn run_from(&mut self, start: usize, end: usize) {
        self.last = None;
        self.run(start, end);
    }

    /// A block under a condition of WESL, whose lines may stand where they would without it.
    fn condition_block(&mut self, start: usize, open: usize, level: u16) -> usize {
        let close = self.tokens[open].partner as usize;
        let joins = start > 0
            && self.word(start + 1) != "if"
            && self.breaks(start) == 0
            && self.is_mark(start - 1, "}");
        let is_margin = match joins {
            true => self.last_condition.is_margin,
            false => level > 0 && self.is_in_margin(start),
        };
        let column = |index: usize| {
            let at = self.tokens[index].start as usize;
            at - self.text[..at].rfind('\n').map_or(0, |line| line + 1)
        };
        // The first token that begins a line with code of the block.
        let is_passed = |at: &usize| {
            let token = &self.tokens[*at];
            token.kind == Kind::Directive || (token.is_comment() && token.breaks == 0)
        };
        let first = (open + 1..close).find(|at| !is_passed(at));
        let first = first.filter(|at| self.breaks(*at) > 0 && !self.is_in_margin(*at));
        let is_outside = |first: usize| {
            let head = (0..=start).rev().find(|at| *at == 0 || self.breaks(*at) > 0);
            column(first) <= column(head.unwrap_or(0))
        };
        let is_flat = is_margin
            || match joins {
                true => self.last_condition.is_flat,
                false => first.is_some_and(is_outside),
            };
        let below = self.is_brace_below(open);
        match below {
            true => self.plain_line(level, is_margin),
            false => self.push(Op::Space),
        }
        let inner = if is_flat { level } else { level + 1 };
        let next = self.braces(open, level, inner, is_margin);
        self.last_condition = ConditionStyle { is_margin, is_flat };
        next
    }

    /// Lays out a block in braces, which stand at a level; the index behind it.
    pub(super) fn block(&mut self, open: usize, level: u16) -> usize {
        self.braces(open, level, level + 1, false)
    }

    fn braces(&mut self, open: usize, level: u16, inner: u16, is_margin: bool) -> usize {
        let close = self.tokens[open].partner as usize;
        if self.nesting >= super::NESTING {
            self.run(open, close + 1);
            return close + 1;
        }
        self.nesting += 1;
        self.layout.blocks.push(open + 1..close);
        if close == open + 1 {
            self.token(open);
            self.token(close);
        } else if self.is_one_line(open, close) {
            self.one_line(open, close, inner, (level, is_margin));
        } else {
            self.token(open);
            let first = self.trailing_comments(open + 1, close);
            self.statements(first, close, inner);
            self.plain_line(level, is_margin);
            self.token(close);
        }
        self.nesting -= 1;
        close + 1
    }

    /// Whether the author wrote a block in one line that has neither blocks nor labels.
    fn is_one_line(&self, open: usize, close: usize) -> bool {
        self.options.braces != Braces::NextLine
            && (open + 1..=close).all(|at| {
                let token = &self.tokens[at];
                token.breaks == 0
                    && !token.ends_line()
                    && !self.is_mark(at, "{")
                    && (token.kind != Kind::Word || !self.is_control(at))
            })
            && !self.text[self.tokens[open].start as usize..self.tokens[close].end as usize]
                .contains(is_line_break)
    }

    /// Lays out a block that may stand in one line. `outer` says where its last brace begins its
    /// line otherwise.
    fn one_line(&mut self, open: usize, close: usize, inner: u16, outer: (u16, bool)) {
        self.open(GroupKind::Block, false, false);
        self.token(open);
        let mut index = open + 1;
        while index < close {
            self.level_break(inner, self.is_in_margin(index));
            index = self.statement(index, close, inner);
        }
        self.level_break(outer.0, outer.1);
        self.token(close);
        self.close();
    }

    pub(super) fn level_break(&mut self, level: u16, is_margin: bool) {
        self.push(Op::Break(Break {
            is_spaced: true,
            is_forced: false,
            is_empty: false,
            is_edge: false,
            place: Place::Level(level),
            is_margin,
        }));
        self.last = None;
    }

    /// How far the statement at an index goes. A list in braces is a part of it.
    pub(super) fn extent(&self, start: usize, end: usize) -> Extent {
        let mut index = start;
        while index < end {
            let token = &self.tokens[index];
            if index > start && (token.kind == Kind::Raw || self.is_cut(start, index)) {
                return Extent::Open(index);
            }
            if token.kind == Kind::Mark {
                match token.text(self.text) {
                    ";" => return Extent::Semicolon(index),
                    "{" if !self.is_list(start, index) => return Extent::Block(index),
                    _ => {}
                }
            }
            index = self.after(index);
        }
        Extent::Open(end)
    }

    /// Whether a statement of GLSL ends before a token without a semicolon: a macro in a line of
    /// its own.
    fn is_cut(&self, start: usize, index: usize) -> bool {
        if self.language != Language::Glsl || self.breaks(index) == 0 || !self.is_word(index) {
            return false;
        }
        let is_macro = |name: &str| {
            name.len() > 1
                && name.bytes().all(|byte| byte.is_ascii_uppercase() || !byte.is_ascii_alphabetic())
        };
        self.is_mark(index - 1, ")") && self.word(start) != "layout"
            || (index == start + 1 && is_macro(self.word(start)))
    }

    /// Whether a brace opens a list of values or names rather than a block.
    fn is_list(&self, start: usize, open: usize) -> bool {
        let before = (start..open).rev().find(|at| !self.tokens[*at].is_comment());
        let Some(before) = before else { return false };
        match self.tokens[before].kind {
            Kind::Mark => {
                matches!(self.word(before), "=" | "," | "(" | "::" | "]" | "{" | "?" | ":")
            }
            Kind::Word => {
                let word = self.word(before);
                word == "return" || word == "import"
            }
            _ => false,
        }
    }

    /// Whether a statement begins with a label of `switch`.
    pub(super) fn is_label(&self, index: usize) -> bool {
        let next = index + 1;
        self.is_word(index)
            && (self.word(index) == "case"
                || (self.word(index) == "default"
                    && (self.is_mark(next, ":") || self.is_mark(next, "{"))))
    }
}
