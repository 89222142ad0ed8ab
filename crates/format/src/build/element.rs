//! What stands in a statement, or between two commas: operands and operators.

use super::Builder;
use crate::op::{Break, GroupKind, Op, Place};
use crate::space::{Placed, Role, ends_operand, is_spaced, precedence_of, role_of};
use crate::token::Kind;

/// An operator between operands, by its index, with its precedence. A comma has 0.
#[derive(Clone, Copy)]
struct Operator {
    index: usize,
    precedence: u8,
}

/// The precedence of a ternary operator, whose parts are `?` and `:`.
const CHOICE: u8 = 2;
const ASSIGNMENT: u8 = 1;
const COMMA: u8 = 0;

impl Builder<'_> {
    /// Lays out a statement or an element of a list.
    pub(super) fn element(&mut self, start: usize, end: usize) {
        if start >= end {
            return;
        }
        self.open(GroupKind::Element, false, false);
        let start = self.attributes(start, end);
        self.expression(start, end);
        self.close();
    }

    /// Lays out operands with their operators.
    pub(super) fn expression(&mut self, start: usize, end: usize) {
        let operators = self.operators(start, end);
        self.chain(start, end, &operators);
    }

    /// Lays out the attributes at the start of an element, with the comments below them; the index
    /// behind them.
    fn attributes(&mut self, mut index: usize, end: usize) -> usize {
        while index < end && self.is_mark(index, "@") {
            let next = self.attribute_end(index, end);
            self.run(index, next);
            index = self.trailing_comments(next, end);
            self.element_break(index, end);
            while index < end && self.tokens[index].is_comment() && self.last.is_none() {
                self.token(index);
                index += 1;
                self.element_break(index, end);
            }
        }
        index
    }

    /// Ends the line before a token of an element if its author did.
    fn element_break(&mut self, index: usize, end: usize) {
        if index < end && self.breaks(index) > 0 {
            self.push(Op::Break(Break {
                is_spaced: false,
                is_forced: true,
                is_empty: false,
                is_edge: false,
                place: Place::Element,
                is_margin: self.is_in_margin(index),
            }));
            self.last = None;
        }
    }

    /// The index behind an attribute.
    pub(super) fn attribute_end(&self, index: usize, end: usize) -> usize {
        let name = index + 1;
        if name >= end || !self.is_word(name) {
            return name.min(end);
        }
        let has_arguments = self.is_mark(name + 1, "(") && self.word(name) != "else";
        if has_arguments { self.after(name + 1).min(end) } else { name + 1 }
    }

    /// The operators between operands of an element, outside of its brackets.
    fn operators(&self, start: usize, end: usize) -> Vec<Operator> {
        let mut found = Vec::new();
        let mut choices = 0_usize;
        let mut before: Option<usize> = None;
        let mut index = start;
        while index < end {
            let token = &self.tokens[index];
            let word = token.text(self.text);
            if token.kind == Kind::Mark {
                let is_operand =
                    before.is_some_and(|before| ends_operand(&self.tokens[before], self.text));
                let precedence = match word {
                    "," => Some(COMMA),
                    ":" if choices > 0 => {
                        choices -= 1;
                        Some(CHOICE)
                    }
                    _ if !is_operand => None,
                    _ => precedence_of(word),
                };
                choices += usize::from(word == "?" && precedence.is_some());
                found.extend(precedence.map(|precedence| Operator { index, precedence }));
            }
            if !token.is_comment() {
                before = Some(self.after(index) - 1);
            }
            index = self.after(index);
        }
        found
    }

    /// Lays out operands, with the operators of the lowest precedence as one group.
    fn chain(&mut self, start: usize, end: usize, operators: &[Operator]) {
        let Some(lowest) = operators.iter().map(|operator| operator.precedence).min() else {
            return self.run(start, end);
        };
        if lowest == ASSIGNMENT {
            return self.assignment(start, end, operators);
        }
        let own: Vec<usize> =
            (0..operators.len()).filter(|at| operators[*at].precedence == lowest).collect();
        let is_below = |index: usize| self.breaks(index) > 0;
        let is_behind = |index: usize| index + 1 < end && is_below(index + 1);
        // Whether lines end with their operators, as its author has it.
        let trails = lowest == COMMA
            || (own.iter().any(|at| is_behind(operators[*at].index))
                && !own.iter().any(|at| is_below(operators[*at].index)));
        let is_forced = own.iter().any(|at| {
            let index = operators[*at].index;
            is_behind(index) || (lowest != COMMA && is_below(index))
        });
        self.open(GroupKind::Chain, is_forced, false);
        let (mut from, mut first) = (start, 0);
        for at in own {
            let index = operators[at].index;
            self.chain(from, index, &operators[first..at]);
            if lowest == COMMA {
                self.token(index);
            } else {
                self.operator(index, end, trails);
            }
            let next = self.trailing_comments(index + 1, end);
            (from, first) = (next, at + 1);
            if next < end && trails && !self.tokens[next].is_comment() {
                self.chain_break(self.breaks(next) > 0, Place::Trail);
            }
        }
        self.chain(from, end, &operators[first..]);
        self.close();
    }

    fn operator(&mut self, index: usize, end: usize, trails: bool) {
        if self.is_mark(index, ":") {
            self.choices = self.choices.saturating_sub(1);
        }
        if trails {
            self.push(Op::Space);
        } else {
            // A line ends before the operator if its author ended it on either side.
            let is_forced =
                self.breaks(index) > 0 || (index + 1 < end && self.breaks(index + 1) > 0);
            self.chain_break(is_forced, Place::Chain);
        }
        self.token(index);
        if self.is_mark(index, "?") {
            self.choices += 1;
        }
    }

    fn chain_break(&mut self, is_forced: bool, place: Place) {
        self.push(Op::Break(Break {
            is_spaced: true,
            is_forced,
            is_empty: false,
            is_edge: false,
            place,
            is_margin: false,
        }));
        self.last = None;
    }

    /// Lays out operands of assignments, of which an expression has one as a rule.
    fn assignment(&mut self, start: usize, end: usize, operators: &[Operator]) {
        let (mut from, mut first) = (start, 0);
        for (at, Operator { index, precedence }) in operators.iter().copied().enumerate() {
            if precedence != ASSIGNMENT {
                continue;
            }
            self.chain(from, index, &operators[first..at]);
            self.push(Op::Space);
            self.token(index);
            let next = self.trailing_comments(index + 1, end);
            if next < end && !self.tokens[next].is_comment() {
                self.push(Op::Soft { is_forced: self.breaks(next) > 0 });
                self.last = None;
            }
            (from, first) = (next, at + 1);
        }
        self.chain(from, end, &operators[first..]);
    }

    /// Lays out tokens without operators between operands outside of brackets.
    pub(super) fn run(&mut self, start: usize, end: usize) {
        let mut index = start;
        while index < end {
            self.gap(index);
            index = match self.after(index) {
                after if after > index + 1 && after <= end => {
                    self.list(index);
                    after
                }
                _ => {
                    self.token(index);
                    index + 1
                }
            };
        }
    }

    /// What stands before a token of a run.
    pub(super) fn gap(&mut self, index: usize) {
        let Some(last) = self.last else { return };
        let (left, right) = (&self.tokens[last], &self.tokens[index]);
        if left.ends_line() || right.begins_line() {
            return self.forced_break(index);
        }
        // The type of a declaration may stand below its name.
        if right.breaks > 0 && self.is_mark(last, ":") && self.choices == 0 {
            return self.forced_break(index);
        }
        if left.is_comment() || right.is_comment() {
            if right.breaks > 0 {
                self.forced_break(index);
            } else if right.kind == Kind::LineComment {
                self.push(Op::Gap(index as u32));
            } else if right.spaced {
                self.push(Op::Space);
            }
            return;
        }
        let before = last.checked_sub(1).map(|at| &self.tokens[at]);
        let left = Placed { token: left, role: self.role(last, before.is_some()) };
        let right = Placed { token: right, role: self.role(index, true) };
        let is_attribute = last > 0 && self.is_mark(last - 1, "@") && self.is_mark(index, "(");
        if !is_attribute && is_spaced(left, right, self.text) {
            self.push(Op::Space);
        }
    }

    /// The role of a token. Comments before it do not count.
    pub(super) fn role(&self, index: usize, has_before: bool) -> Role {
        let before = (0..index).rev().find(|at| !self.tokens[*at].is_comment());
        let before = before.filter(|_| has_before).map(|at| &self.tokens[at]);
        role_of(&self.tokens[index], before, self.text, self.choices > 0)
    }

    fn forced_break(&mut self, index: usize) {
        let is_margin = self.is_in_margin(index);
        self.push(Op::Break(Break {
            is_spaced: false,
            is_forced: true,
            is_empty: false,
            is_edge: false,
            place: Place::Chain,
            is_margin,
        }));
    }
}
