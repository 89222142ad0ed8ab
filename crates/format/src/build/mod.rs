//! Makes a layout of tokens: statements and blocks here, what stands in a statement in
//! `element.rs`, and brackets with elements in `list.rs`.

mod block;
mod control;
mod element;
mod list;

use std::ops::Range;

use lamplight_bundle::Language;

use crate::op::{Group, GroupKind, Line, Op};
use crate::options::{Braces, Margin, Options};
use crate::token::{Kind, Token};

/// How deep statements without braces may nest; deeper ones are not indented.
const NESTING: usize = 100;

/// A layout, and where its statements are.
pub struct Layout {
    pub ops: Vec<Op>,
    /// The tokens of each statement.
    pub statements: Vec<Range<usize>>,
    /// The tokens between the braces of each block.
    pub blocks: Vec<Range<usize>>,
}

pub fn build_layout(text: &str, tokens: &[Token], language: Language, options: &Options) -> Layout {
    let mut builder = Builder {
        text,
        tokens,
        language,
        options,
        layout: Layout {
            ops: Vec::with_capacity(tokens.len() * 2),
            statements: Vec::new(),
            blocks: Vec::new(),
        },
        last: None,
        choices: 0,
        nesting: 0,
        last_condition: ConditionStyle::default(),
    };
    builder.statements(0, tokens.len(), 0);
    builder.layout
}

pub(crate) struct Builder<'t> {
    text: &'t str,
    tokens: &'t [Token],
    language: Language,
    options: &'t Options,
    layout: Layout,
    /// The token that was laid out last.
    last: Option<usize>,
    /// How many `?` wait for their `:`.
    choices: usize,
    nesting: usize,
    /// How the block of the last condition stands: an `@else` in the line of its `}` is alike.
    last_condition: ConditionStyle,
}

/// Where the block under a condition of WESL stands.
#[derive(Clone, Copy, Default)]
struct ConditionStyle {
    /// Whether its braces are in column 0.
    is_margin: bool,
    /// Whether its lines stand where they would without it.
    is_flat: bool,
}

impl Builder<'_> {
    fn word(&self, index: usize) -> &str {
        self.tokens.get(index).map_or("", |token| token.text(self.text))
    }

    fn is_word(&self, index: usize) -> bool {
        self.tokens.get(index).is_some_and(|token| token.kind == Kind::Word)
    }

    /// Whether a token is this mark, and no comment or word.
    fn is_mark(&self, index: usize, mark: &str) -> bool {
        self.tokens
            .get(index)
            .is_some_and(|token| token.kind == Kind::Mark && token.text(self.text) == mark)
    }

    fn breaks(&self, index: usize) -> u8 {
        self.tokens.get(index).map_or(0, |token| token.breaks)
    }

    /// The index behind the partner of a bracket, or behind any other token.
    fn after(&self, index: usize) -> usize {
        (self.tokens[index].partner as usize).max(index) + 1
    }

    fn push(&mut self, op: Op) {
        self.layout.ops.push(op);
    }

    fn token(&mut self, index: usize) {
        self.push(Op::Token(index as u32));
        self.last = Some(index);
    }

    fn open(&mut self, kind: GroupKind, is_forced: bool, is_filled: bool) {
        self.push(Op::Open(Group { kind, is_forced, is_filled }));
    }

    fn close(&mut self) {
        self.push(Op::Close);
    }

    /// Ends the line before a statement.
    fn line(&mut self, index: usize, level: u16, is_first: bool) {
        let is_empty = self.breaks(index) > 1 && !is_first;
        let is_margin = level > 0 && self.is_in_margin(index);
        self.push(Op::Line(Line { level, is_margin, is_empty }));
    }

    /// Ends the line before a token that is not the first one of a statement.
    fn plain_line(&mut self, level: u16, is_margin: bool) {
        self.push(Op::Line(Line { level, is_margin, is_empty: false }));
    }

    /// Whether a line that begins with a token begins in column 0, whatever its level.
    fn is_in_margin(&self, index: usize) -> bool {
        let Some(token) = self.tokens.get(index) else { return false };
        let setting = match token.kind {
            Kind::Directive => self.options.directives,
            _ if self.is_condition(index) => self.options.conditions,
            _ => return false,
        };
        match setting {
            Margin::Keep => token.is_margin,
            Margin::Start => true,
            Margin::Indented => false,
        }
    }

    /// Whether an attribute is a condition.
    fn is_condition(&self, index: usize) -> bool {
        self.is_mark(index, "@") && matches!(self.word(index + 1), "if" | "elif" | "else")
    }

    /// Whether a comment stands behind other tokens in its line.
    fn is_trailing(&self, index: usize) -> bool {
        let Some(token) = self.tokens.get(index) else { return false };
        token.is_comment() && token.breaks == 0 && self.last.is_some()
    }

    /// Lays out the comments that stand behind a token in its line, from an index on; the index
    /// behind them. A block comment counts if it ends its line.
    fn trailing_comments(&mut self, mut index: usize, end: usize) -> usize {
        let is_alone = |builder: &Self, mut at: usize| {
            while at < end && builder.is_trailing(at) {
                at += 1;
            }
            at >= end || builder.breaks(at) > 0
        };
        if !is_alone(self, index) {
            return index;
        }
        while index < end && self.is_trailing(index) {
            self.push(Op::Gap(index as u32));
            self.token(index);
            index += 1;
        }
        index
    }

    /// Where the brace of a block stands: on a line of its own, or behind its header.
    fn is_brace_below(&self, index: usize) -> bool {
        let is_ended = self.last.is_some_and(|last| self.tokens[last].ends_line());
        is_ended
            || match self.options.braces {
                Braces::Keep => self.breaks(index) > 0,
                Braces::SameLine => false,
                // Nothing is between the braces of an empty block.
                Braces::NextLine => self.after(index) > index + 2 || self.breaks(index) > 0,
            }
    }
}
