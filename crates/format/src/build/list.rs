//! Brackets with elements: arguments, parameters, members of structures, imports, template lists.

use lamplight_bundle::Language;

use super::Builder;
use crate::op::{Break, GroupKind, Op, Place};
use crate::token::Kind;

/// Characters of an element of which many stand in a line, such as a number.
const SHORT: usize = 12;

/// What a list looks like.
struct Shape {
    /// Whether it has a line break of its own.
    is_forced: bool,
    is_filled: bool,
    /// Whether spaces stand inside of its brackets.
    is_padded: bool,
}

impl Builder<'_> {
    /// Lays out the brackets at an index, with what is in them.
    pub(super) fn list(&mut self, open: usize) {
        let close = self.tokens[open].partner as usize;
        let choices = std::mem::take(&mut self.choices);
        if close == open + 1 {
            self.token(open);
            self.token(close);
        } else {
            self.filled_list(open, close);
        }
        self.choices = choices;
    }

    fn filled_list(&mut self, open: usize, close: usize) {
        let shape = self.shape(open, close);
        let is_attribute = open > 1 && self.is_mark(open - 2, "@");
        let is_rigid = is_attribute || self.tokens[open].kind == Kind::TemplateOpen;
        let kind = if is_rigid { GroupKind::Rigid } else { GroupKind::List };
        self.open(kind, shape.is_forced, shape.is_filled);
        self.token(open);
        let mut index = self.trailing_comments(open + 1, close);
        if index == close {
            // Only comments.
            self.edge(shape.is_forced, false, Place::Outer);
        } else {
            self.list_break(index, &shape, true);
        }
        while index < close {
            let end = self.item_end(index, close);
            index = self.item(index, end, close);
            if index < close {
                self.list_break(index, &shape, false);
            } else {
                self.edge(shape.is_forced, shape.is_padded, Place::Outer);
            }
        }
        self.token(close);
        self.close();
    }

    /// Lays out an element with its separator and the comments behind it; the index behind them.
    fn item(&mut self, mut start: usize, end: usize, close: usize) -> usize {
        self.last = None;
        while self.tokens[start].is_comment() || self.tokens[start].begins_line() {
            // A line of its own, or a comment before an element.
            self.token(start);
            let next = start + 1;
            let is_inline = self.tokens[start].kind == Kind::BlockComment
                && next < close
                && self.breaks(next) == 0;
            if !is_inline {
                return next;
            }
            self.push(Op::Space);
            self.last = None;
            start = next;
        }
        self.element(start, end);
        let mut next = end;
        if next < close {
            self.gap(next);
            self.token(next);
            next += 1;
        }
        self.trailing_comments(next, close)
    }

    /// The index of the separator behind an element, or of what ends it otherwise.
    fn item_end(&self, start: usize, close: usize) -> usize {
        let mut index = start;
        if self.tokens[start].is_comment() {
            index += 1;
        }
        while index < close {
            if self.is_mark(index, ",") || self.is_mark(index, ";") {
                return index;
            }
            let next = self.after(index);
            // A line of the preprocessor, or a comment in a line of its own that the author put
            // behind the last element.
            if next <= close && index > start && self.ends_item(index) {
                return index;
            }
            index = next;
        }
        close
    }

    /// Whether a token begins what is no longer the element before it, though no comma ends that.
    fn ends_item(&self, index: usize) -> bool {
        self.tokens[index].begins_line()
    }

    fn shape(&self, open: usize, close: usize) -> Shape {
        let is_brace = self.is_mark(open, "{");
        let is_import = is_brace
            && open > 0
            && matches!(self.word(open - 1), "::" | "import" | "," | "{")
            && self.language == Language::Wesl;
        let mut is_forced = self.tokens[open + 1].breaks > 0;
        let (mut is_short, mut has_nested, mut index) = (true, false, open + 1);
        let (mut is_start, mut operands) = (true, 0);
        while index < close {
            let token = &self.tokens[index];
            let is_end = self.is_mark(index, ",") || self.is_mark(index, ";");
            let is_own = token.begins_line()
                || token.kind == Kind::LineComment
                || (is_start && token.breaks > 0)
                || (token.is_comment() && token.breaks > 0);
            is_forced |= is_own;
            has_nested |= self.after(index) > index + 1;
            operands = if is_end { 0 } else { operands + usize::from(!self.is_mark(index, "-")) };
            is_short &= is_end
                || self.is_mark(index, "-")
                || (operands == 1
                    && matches!(token.kind, Kind::Number | Kind::Word)
                    && token.text(self.text).len() <= SHORT);
            if is_start && self.is_mark(index, "@") {
                is_forced |= self.has_broken_attribute(index, close);
            }
            is_start = is_end || (is_start && token.is_comment());
            index = self.after(index);
        }
        let is_padded = is_brace && !is_import && self.tokens[open + 1].spaced;
        let is_padded = is_padded || (is_brace && !is_import && self.is_struct(open));
        let is_filled = (is_short && is_many(close - open)) || (is_import && !has_nested);
        Shape { is_forced, is_filled, is_padded }
    }

    /// Whether a line ends behind one of the attributes of an element.
    fn has_broken_attribute(&self, mut index: usize, close: usize) -> bool {
        while index < close && self.is_mark(index, "@") {
            index = self.attribute_end(index, close);
            if index < close && self.breaks(index) > 0 {
                return true;
            }
        }
        false
    }

    /// Whether a brace opens the members of a structure of WESL.
    pub(super) fn is_struct(&self, open: usize) -> bool {
        self.language == Language::Wesl
            && open >= 2
            && self.is_mark(open, "{")
            && self.is_word(open - 1)
            && self.word(open - 2) == "struct"
    }

    /// A place between two elements, or before the first one.
    fn list_break(&mut self, next: usize, shape: &Shape, is_edge: bool) {
        let ends = self.last.is_some_and(|last| self.tokens[last].ends_line());
        let token = &self.tokens[next];
        let is_own = token.begins_line() || (token.is_comment() && token.breaks > 0);
        let is_forced = ends || is_own || token.breaks > 0 || (is_edge && shape.is_forced);
        let is_margin = self.is_in_margin(next);
        let is_spaced = if is_edge { shape.is_padded } else { !token.is_comment() || token.spaced };
        self.push(Op::Break(Break {
            is_spaced,
            is_forced,
            is_empty: token.breaks > 1 && !is_edge,
            is_edge,
            place: Place::Inner,
            is_margin,
        }));
        self.last = None;
    }

    fn edge(&mut self, is_forced: bool, is_spaced: bool, place: Place) {
        let ends = self.last.is_some_and(|last| self.tokens[last].ends_line());
        self.push(Op::Break(Break {
            is_spaced,
            is_forced: is_forced || ends,
            is_empty: false,
            is_edge: true,
            place,
            is_margin: false,
        }));
    }
}

/// Whether a list of so many tokens is a table rather than a few arguments.
fn is_many(tokens: usize) -> bool {
    tokens > 16
}
