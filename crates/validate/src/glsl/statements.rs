//! The statements of a function's body: scopes, and forms of statements that naga reads in another
//! way.

use std::collections::BTreeSet;

use super::declared::{DeclaredFunction, FileScope};
use super::tokens::Tokens;
use super::{Found, construct};
use lamplight_files::limits::{COMPILED_NESTING, OPERATORS};

/// Walks over the statements of one function.
pub struct StatementWalk<'w, 't> {
    pub tokens: &'w Tokens<'t>,
    pub scope: &'w mut FileScope<'t>,
    pub found: &'w mut Found,
    /// The names of each open scope, the innermost last.
    open: Vec<BTreeSet<&'t str>>,
    /// Every name that the function declares.
    pub locals: BTreeSet<&'t str>,
    /// Whether `continue` would continue a `do` loop.
    in_do: bool,
    /// How many statements the current one is in.
    depth: usize,
}

impl<'w, 't> StatementWalk<'w, 't> {
    /// Walks over the body of a function, and returns the names that it declares.
    pub fn run(
        tokens: &'w Tokens<'t>,
        scope: &'w mut FileScope<'t>,
        function: &DeclaredFunction<'t>,
        found: &'w mut Found,
    ) -> BTreeSet<&'t str> {
        let parameters: BTreeSet<&str> =
            function.parameters.iter().map(|parameter| parameter.name).collect();
        let (open, locals) = (vec![parameters.clone()], parameters);
        let mut walk = Self { tokens, scope, found, open, locals, in_do: false, depth: 0 };
        walk.block(function.body.start);
        walk.locals
    }

    /// Walks over the statements in braces, in the scope that is open.
    fn block(&mut self, brace: usize) {
        let (mut at, close) = (brace + 1, self.tokens.pair(brace));
        while at < close {
            at = self.statement(at, close);
        }
    }

    /// Walks over the statement at `at`, and returns the index behind it. Statements that nest
    /// deeper than naga may read are not walked over: that text is refused for its limits.
    fn statement(&mut self, at: usize, end: usize) -> usize {
        if self.depth > COMPILED_NESTING + OPERATORS {
            return end;
        }
        self.depth += 1;
        let after = self.nested(at, end);
        self.depth -= 1;
        after
    }

    fn nested(&mut self, at: usize, end: usize) -> usize {
        let tokens = self.tokens;
        match tokens.text(at) {
            "{" => {
                self.open.push(BTreeSet::new());
                self.block(at);
                self.open.pop();
                tokens.pair(at) + 1
            }
            "if" => {
                let after = self.only_statement(tokens.pair(at + 1) + 1, end);
                match tokens.text(after) {
                    "else" => self.only_statement(after + 1, end),
                    _ => after,
                }
            }
            "switch" => self.nested(tokens.pair(at + 1) + 1, end),
            "for" | "while" => self.looped(at, end),
            "do" => {
                let outer = std::mem::replace(&mut self.in_do, true);
                let after = self.only_statement(at + 1, end);
                self.in_do = outer;
                tokens.find(after, end, &[";"]) + 1
            }
            "case" | "default" => tokens.find(at, end, &[":"]) + 1,
            "continue" if self.in_do => {
                self.found.add(&construct::CONTINUE_IN_DO, tokens.bytes(at, at));
                at + 2
            }
            _ => match self.declaration(at) {
                Some(after) => after,
                None => tokens.find(at, end, &[";"]) + 1,
            },
        }
    }

    /// A `for` or `while` loop, whose body shares the scope of what stands in its parentheses.
    fn looped(&mut self, at: usize, end: usize) -> usize {
        let tokens = self.tokens;
        let outer = std::mem::replace(&mut self.in_do, false);
        self.open.push(BTreeSet::new());
        self.declaration(at + 2);
        let body = tokens.pair(at + 1) + 1;
        let after = if tokens.text(body) == "{" {
            self.block(body);
            tokens.pair(body) + 1
        } else {
            self.only_statement(body, end)
        };
        self.open.pop();
        self.in_do = outer;
        after
    }

    /// The statement of an `if`, an `else` or a loop. naga puts what it declares into the scope
    /// around it.
    fn only_statement(&mut self, at: usize, end: usize) -> usize {
        let mut ignored = Found::default();
        let declared = self.scope.declaration(self.tokens, at, &mut ignored);
        if let Some(declared) = declared {
            self.found.add(&construct::LONE_DECLARATION, self.tokens.bytes(at, declared.end));
            return declared.end + 1;
        }
        self.statement(at, end)
    }

    fn declaration(&mut self, at: usize) -> Option<usize> {
        let declared = self.scope.declaration(self.tokens, at, self.found)?;
        for variable in declared.variables {
            let is_new = self.open.last_mut().is_none_or(|names| names.insert(variable.name));
            if !is_new {
                let name = self.tokens.bytes(variable.at, variable.at);
                self.found.add(&construct::DECLARED_TWICE, name);
            }
            self.locals.insert(variable.name);
        }
        Some(declared.end + 1)
    }
}
