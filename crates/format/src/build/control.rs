//! Statements by what they begin with: loops, choices, labels, functions, and all others.

use lamplight_bundle::Language;
use lamplight_syntax::wesl::blank::is_line_break;

use super::Builder;
use super::block::Extent;
use crate::op::{GroupKind, Op};
use crate::token::Kind;

/// Tokens behind the block of a structure in GLSL, before its semicolon.
const TAIL: usize = 32;

impl Builder<'_> {
    /// Whether a word begins a statement that has others in it.
    pub(super) fn is_control(&self, index: usize) -> bool {
        matches!(
            self.word(index),
            "if" | "for" | "while" | "switch" | "loop" | "continuing" | "do" | "else"
        ) || self.is_label(index)
    }

    /// Lays out a statement without attributes; the index behind it.
    pub(super) fn bare_statement(&mut self, index: usize, end: usize, level: u16) -> usize {
        if self.nesting >= super::NESTING {
            return self.simple(index, end, level);
        }
        self.nesting += 1;
        let next = if self.is_label(index) {
            self.label(index, end, level)
        } else if self.is_word(index) && self.is_control(index) {
            self.control(index, end, level)
        } else if self.is_struct(index + 2) && index + 2 < end {
            self.structure(index, end, level)
        } else {
            self.simple(index, end, level)
        };
        self.nesting -= 1;
        next
    }

    /// A statement up to its semicolon, or an item with a block.
    fn simple(&mut self, start: usize, end: usize, level: u16) -> usize {
        let next = match self.extent(start, end) {
            Extent::Semicolon(at) => {
                self.element(start, at + 1);
                return at + 1;
            }
            Extent::Open(at) => {
                self.element(start, at);
                return at;
            }
            Extent::Block(open) => {
                self.element(start, open);
                self.body(open, level)
            }
        };
        if self.language == Language::Glsl && !self.is_mark(self.code_before(next), ")") {
            return self.tail(start, next, end);
        }
        self.semicolon(next, end)
    }

    /// The last token of code before the block that ends before an index.
    fn code_before(&self, end: usize) -> usize {
        let open = self.tokens[end - 1].partner as usize;
        (0..open).rev().find(|at| !self.tokens[*at].is_comment()).unwrap_or(open)
    }

    /// What stands between a block in GLSL and its semicolon: the name of an instance.
    fn tail(&mut self, start: usize, next: usize, end: usize) -> usize {
        if next - start < 2 {
            return next;
        }
        let mut index = next;
        while index < end.min(next + TAIL) {
            if self.is_mark(index, ";") {
                self.element_behind(next, index + 1);
                return index + 1;
            }
            let is_part = self.is_word(index)
                || self.tokens[index].is_comment()
                || ["[", ",", "="].iter().any(|mark| self.is_mark(index, mark));
            if !is_part || (self.breaks(index) > 0 && index > next) {
                break;
            }
            index = self.after(index);
        }
        next
    }

    /// An element behind a `}` in its line.
    fn element_behind(&mut self, start: usize, end: usize) {
        if !self.is_mark(start, ";") {
            self.push(Op::Space);
            self.last = None;
        }
        self.element(start, end);
    }

    /// The semicolon that may follow a block.
    fn semicolon(&mut self, index: usize, end: usize) -> usize {
        if index < end && self.is_mark(index, ";") {
            self.token(index);
            return index + 1;
        }
        index
    }

    /// A structure of WESL, whose members are a list.
    fn structure(&mut self, start: usize, end: usize, level: u16) -> usize {
        let open = start + 2;
        self.open(GroupKind::Element, false, false);
        self.run(start, open);
        match self.is_brace_below(open) {
            true => self.plain_line(level, false),
            false => self.push(Op::Space),
        }
        self.list(open);
        self.close();
        let next = self.after(open);
        self.layout.blocks.push(open + 1..next - 1);
        self.semicolon(next, end)
    }

    /// A block behind a header.
    fn body(&mut self, open: usize, level: u16) -> usize {
        match self.is_brace_below(open) {
            true => self.plain_line(level, false),
            false => self.push(Op::Space),
        }
        self.block(open, level)
    }

    /// A loop or a choice, with the branches behind it.
    fn control(&mut self, start: usize, end: usize, level: u16) -> usize {
        let mut index = start;
        loop {
            let is_do = self.word(index) == "do";
            index = self.branch(index, end, level);
            let joins = if is_do { "while" } else { "else" };
            if index >= end || !self.is_word(index) || self.word(index) != joins {
                break;
            }
            let is_block = self.is_mark(index - 1, "}");
            let is_below = match is_block {
                true => !is_do && self.is_brace_below(index),
                false => self.breaks(index) > 0 || self.last_ends_line(),
            };
            match is_below {
                true => self.plain_line(level, false),
                false => self.push(Op::Space),
            }
            self.last = None;
            if is_do {
                return self.simple(index, end, level);
            }
        }
        if index > start && self.is_mark(index - 1, "}") {
            return self.semicolon(index, end);
        }
        index
    }

    fn last_ends_line(&self) -> bool {
        self.last.is_some_and(|last| self.tokens[last].ends_line())
    }

    /// One header with its block or statement: `if (x) ...`, `else ...`, `for (...) ...`.
    fn branch(&mut self, start: usize, end: usize, level: u16) -> usize {
        let mut head = start;
        if self.word(start) == "else" && self.is_word(start + 1) && self.word(start + 1) == "if" {
            head = start + 1;
        }
        let is_bare = matches!(self.word(head), "else" | "do" | "loop" | "continuing");
        let body = match self.language {
            _ if is_bare => head + 1,
            Language::Glsl if self.is_mark(head + 1, "(") => self.after(head + 1),
            Language::Glsl => head + 1,
            Language::Wesl => match self.extent(start, end) {
                Extent::Block(open) => open,
                Extent::Semicolon(_) | Extent::Open(_) => return self.simple(start, end, level),
            },
        };
        self.element(start, body.min(end));
        let body = self.trailing_comments(body, end);
        if body >= end {
            return end;
        }
        if self.is_mark(body, "{") {
            return self.body(body, level);
        }
        self.nested(body, end, level)
    }

    /// The statement of a branch without braces.
    fn nested(&mut self, start: usize, end: usize, level: u16) -> usize {
        let mut index = start;
        if self.is_mark(index, ";") {
            self.token(index);
            return index + 1;
        }
        // Comments, and lines of the preprocessor, before the statement.
        while index < end && (self.tokens[index].is_comment() || self.tokens[index].begins_line()) {
            if self.tokens[index].kind == Kind::Raw {
                return index;
            }
            self.line(index, level + 1, true);
            self.token(index);
            index += 1;
        }
        if index >= end {
            return end;
        }
        if index == start && self.breaks(index) == 0 {
            self.push(Op::Space);
            self.last = None;
            return self.bare_statement(index, end, level);
        }
        self.line(index, level + 1, true);
        self.last = None;
        self.statement(index, end, level + 1)
    }

    /// `case 1:`, `default:`, `case 1u, 2u {`, with what the author put into the same line.
    fn label(&mut self, start: usize, end: usize, level: u16) -> usize {
        let mut index = start + 1;
        while index < end && !self.is_mark(index, ":") && !self.is_mark(index, "{") {
            if self.is_mark(index, ";") || self.tokens[index].begins_line() {
                break;
            }
            index = self.after(index);
        }
        let body = if self.is_mark(index, ":") { index + 1 } else { index };
        self.element(start, body);
        if body < end && self.is_mark(body, "{") {
            return self.body(body, level);
        }
        let stop = self.simple_run(body, end);
        if stop == body {
            return body;
        }
        self.open(GroupKind::Block, false, false);
        let mut index = body;
        while index < stop {
            self.level_break(level + 1, false);
            index = self.statement(index, stop, level + 1);
        }
        self.close();
        stop
    }

    /// The index behind the simple statements that stand in the line of a label.
    fn simple_run(&self, start: usize, end: usize) -> usize {
        let mut index = start;
        while index < end && self.breaks(index) == 0 {
            let token = &self.tokens[index];
            let is_label_or_block = self.is_word(index) && self.is_control(index);
            if token.is_comment()
                || token.begins_line()
                || self.is_mark(index, "@")
                || is_label_or_block
            {
                break;
            }
            let Extent::Semicolon(at) = self.extent(index, end) else { break };
            let bytes = token.start as usize..self.tokens[at].end as usize;
            if self.text[bytes].contains(is_line_break) {
                break;
            }
            index = at + 1;
        }
        index
    }
}
