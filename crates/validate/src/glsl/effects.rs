//! Which functions have effects, and the expressions in which naga computes an effect that should
//! not happen, or computes it twice.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use super::declared::DeclaredFunction;
use super::tokens::Tokens;
use super::{Found, construct};

/// A function, with the names of its parameters and local variables.
pub struct FunctionLocals<'w, 't> {
    pub function: &'w DeclaredFunction<'t>,
    pub locals: BTreeSet<&'t str>,
}

/// What is known of the functions of a text.
pub struct Effects<'w, 't> {
    tokens: &'w Tokens<'t>,
    /// The functions of each name.
    functions: BTreeMap<&'t str, Vec<&'w FunctionLocals<'w, 't>>>,
    /// Functions that change more than their own variables and outputs.
    changing: BTreeSet<&'t str>,
}

const ASSIGNMENTS: &[&str] = &["=", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<=", ">>="];

/// How the names of built-in functions with effects begin.
const CHANGING: &[&str] =
    &["imageStore", "imageAtomic", "atomic", "barrier", "memoryBarrier", "groupMemoryBarrier"];

impl<'w, 't> Effects<'w, 't> {
    /// Finds the functions with effects. A function has the effects of those that it calls.
    pub fn of(tokens: &'w Tokens<'t>, functions: &'w [FunctionLocals<'w, 't>]) -> Self {
        let mut named: BTreeMap<&str, Vec<&FunctionLocals<'_, '_>>> = BTreeMap::new();
        functions.iter().for_each(|one| named.entry(one.function.name).or_default().push(one));
        let mut effects = Self { tokens, functions: named, changing: BTreeSet::new() };
        let mut callers: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
        let mut open = Vec::new();
        for one in functions {
            let (name, body) = (one.function.name, one.function.body.clone());
            for called in body.clone().filter(|index| tokens.text(index + 1) == "(") {
                callers.entry(tokens.text(called)).or_default().insert(name);
            }
            open.extend(effects.first(body, &one.locals).map(|_| name));
        }
        while let Some(name) = open.pop() {
            if effects.changing.insert(name) {
                open.extend(callers.get(name).into_iter().flatten());
            }
        }
        effects
    }

    /// The first token of a range that changes anything but the variables in `locals`.
    fn first(&self, range: Range<usize>, locals: &BTreeSet<&str>) -> Option<usize> {
        range.into_iter().find(|index| {
            let text = self.tokens.text(*index);
            match text {
                "discard" => true,
                "++" | "--" => {
                    // The operator stands on either side of what it changes.
                    let next = index + 1;
                    let is_before = self.tokens.is_word(next) || self.tokens.text(next) == "(";
                    let next = self.tokens.text(next);
                    !locals.contains(if is_before { next } else { self.root(*index) })
                }
                _ if ASSIGNMENTS.contains(&text) => !locals.contains(self.root(*index)),
                _ => self.tokens.text(index + 1) == "(" && self.calls_with_effect(*index, locals),
            }
        })
    }

    fn calls_with_effect(&self, at: usize, locals: &BTreeSet<&str>) -> bool {
        let name = self.tokens.text(at);
        if !self.tokens.is_word(at) {
            return false;
        }
        if !self.functions.contains_key(name) {
            return CHANGING.iter().any(|start| name.starts_with(start));
        }
        self.changing.contains(name)
            || self.outputs(at).any(|part| !locals.contains(self.tokens.text(part.start)))
    }

    /// The arguments of a call that the function writes to.
    fn outputs(&self, call: usize) -> impl Iterator<Item = Range<usize>> {
        let name = self.tokens.text(call);
        let parts = self.tokens.parts(call + 1);
        let own = self.functions.get(name).map_or(&[][..], Vec::as_slice);
        let is_output: Vec<bool> = (0..parts.len())
            .map(|index| {
                let parameters = own.iter().map(|one| &one.function.parameters);
                let fitting = parameters.filter(|list| list.len() == parts.len());
                fitting.into_iter().any(|list| list[index].is_output)
            })
            .collect();
        parts.into_iter().zip(is_output).filter(|(_, is_output)| *is_output).map(|(part, _)| part)
    }

    /// The index of the first token of the variable, with its members and indices, that ends before
    /// `at`.
    fn chain_start(&self, at: usize) -> usize {
        let mut start = at;
        while let Some(last) = start.checked_sub(1) {
            let text = self.tokens.text(last);
            let follows =
                start == at || self.tokens.text(start) == "[" || self.tokens.text(start) == ".";
            match text {
                "]" | ")" if follows => start = self.tokens.pair(last),
                "." if self.tokens.is_word(start) => start = last,
                _ if self.tokens.is_word(last) && follows => start = last,
                _ => break,
            }
        }
        start
    }

    /// The name of the variable that ends before `at`; empty if there is none.
    fn root(&self, at: usize) -> &'t str {
        let start = self.chain_start(at);
        let start = (start..at).find(|index| self.tokens.text(*index) != "(").unwrap_or(start);
        if start < at && self.tokens.is_word(start) { self.tokens.text(start) } else { "" }
    }

    /// Looks for the expressions in a function's body.
    pub fn check(&self, body: Range<usize>, found: &mut Found) {
        let nothing = BTreeSet::new();
        for index in body {
            let (text, tokens) = (self.tokens.text(index), self.tokens);
            match text {
                "&&" | "||" => {
                    let right = index + 1..self.operand_end(index);
                    let last = right.end - 1;
                    if self.first(right, &nothing).is_some() {
                        found.add(&construct::SHORT_CIRCUIT, tokens.bytes(index, last));
                    }
                }
                _ if text != "=" && ASSIGNMENTS.contains(&text) => {
                    let start = self.chain_start(index);
                    if self.first(start..index, &nothing).is_some() {
                        found.add(&construct::INDEX_EFFECT, tokens.bytes(start, index));
                    }
                }
                _ if tokens.text(index + 1) == "(" && tokens.is_word(index) => {
                    for part in self.outputs(index) {
                        if self.first(part.clone(), &nothing).is_some() {
                            let bytes = tokens.bytes(part.start, part.end - 1);
                            found.add(&construct::OUTPUT_EFFECT, bytes);
                        }
                    }
                }
                _ => {}
            }
        }
    }

    /// The index behind the right operand of `&&` or `||`.
    fn operand_end(&self, operator: usize) -> usize {
        let mut stops = vec![";", ",", "?", ":", "||"];
        if self.tokens.text(operator) == "&&" {
            stops.extend(["&&", "^^"]);
        }
        stops.extend(ASSIGNMENTS);
        self.tokens.find(operator + 1, self.tokens.len(), &stops)
    }
}
