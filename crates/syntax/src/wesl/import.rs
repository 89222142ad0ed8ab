//! `import` statements, flattened to one entry for each name.

use super::cursor::Tokens;
use super::module::{ConditionId, Import, Module, Origin, Path, PathParts};
use super::name::Name;
use super::token::TokenKind;
use lamplight_diagnostic::{Diagnostic, codes};

/// Reads the statement whose `import` is at `at`; returns the index past its semicolon.
pub fn read_import(
    module: &mut Module,
    tokens: Tokens<'_>,
    at: usize,
    condition: Option<ConditionId>,
) -> Result<usize, Diagnostic> {
    let first = at + 1;
    let (origin, after) = read_origin(tokens, first)?;
    let nowhere = tokens.range(first, first);
    let parts =
        PathParts { first: nowhere.clone(), parents: nowhere.clone(), last: nowhere.clone() };
    let path = Path { origin, segments: Vec::new(), range: nowhere, parts };
    let mut reader = ImportReader { module, tokens, condition, at: after };
    match reader.tokens.is(after, b'{') {
        true => reader.collection(&path)?,
        false => reader.path(path, Some(first))?,
    }
    let end = reader.at;
    tokens.expect(end, b';', "`;` after the import")
}

/// `package ::`, repeated `super ::`, or nothing; and the index after it.
pub fn read_origin(tokens: Tokens<'_>, at: usize) -> Result<(Origin, usize), Diagnostic> {
    let word = tokens.word(at);
    let mut end = at;
    let mut ups = 0;
    while (word == Some(Name::PACKAGE) && end == at)
        || (word == Some(Name::SUPER) && tokens.is_word(end, Name::SUPER))
    {
        if tokens.kind(end + 1) != Some(TokenKind::Path) {
            return Err(tokens.expected(end + 1, "`::`"));
        }
        end += 2;
        ups += 1;
    }
    let origin = match word {
        Some(Name::PACKAGE) => Origin::Package,
        Some(Name::SUPER) => Origin::Super(ups),
        _ => Origin::Scope,
    };
    Ok((origin, end))
}

/// The error for `as` in the place of a name in a path.
fn misplaced_as(tokens: Tokens<'_>, at: usize) -> Diagnostic {
    let is_path = |at: usize| tokens.kind(at) == Some(TokenKind::Path);
    let error = Diagnostic::error(codes::SYNTAX_ERROR, "`as` cannot be a name in a path")
        .at(tokens.span(at), "a keyword");
    match at > 1 && is_path(at - 1) && is_path(at + 1) && tokens.word(at + 2).is_some() {
        true => {
            let (from, to) = (tokens.text(at - 2), tokens.text(at + 2));
            error.note(format!("help: without `::` around it: `{from} as {to}`"))
        }
        false => error,
    }
}

struct ImportReader<'a, 'b> {
    module: &'a mut Module,
    tokens: Tokens<'b>,
    condition: Option<ConditionId>,
    at: usize,
}

impl ImportReader<'_, '_> {
    /// Reads `a::b::c`, `a::b as c` or `a::{...}`. This recursion is bounded, since the nesting of
    /// brackets is.
    ///
    /// `start` is the path's first token, or `None` for a path in a collection.
    fn path(&mut self, mut path: Path, start: Option<usize>) -> Result<(), Diagnostic> {
        let own = start.unwrap_or(self.at);
        loop {
            if self.tokens.is_word(self.at, Name::AS) {
                return Err(misplaced_as(self.tokens, self.at));
            }
            let name = self.tokens.identifier(self.at, "a name")?;
            let place = self.tokens.range(self.at, self.at + 1);
            if path.segments.is_empty() {
                path.parts.first = place.clone();
            } else if self.at > own {
                path.parts.parents = self.tokens.range(own, self.at - 1);
            }
            path.parts.last = place;
            path.segments.push(name);
            self.at += 1;
            if self.tokens.kind(self.at) != Some(TokenKind::Path) {
                break;
            }
            self.at += 1;
            if self.tokens.is(self.at, b'{') {
                path.parts.parents = self.tokens.range(own, self.at - 1);
                return self.collection(&path);
            }
        }
        let last = self.at - 1;
        // In a collection the place of a path is that of its last name, since the rest is shared.
        path.range = self.tokens.range(start.unwrap_or(last), last + 1);
        let mut alias_at = last;
        if self.tokens.is_word(self.at, Name::AS) {
            alias_at = self.at + 1;
            self.at += 2;
        }
        let alias = self.tokens.identifier(alias_at, "a name after `as`")?;
        let alias_range = self.tokens.range(alias_at, alias_at + 1);
        self.module.imports.push(Import { condition: self.condition, path, alias, alias_range });
        Ok(())
    }

    /// `{ path, path, }`, with at least one path.
    fn collection(&mut self, prefix: &Path) -> Result<(), Diagnostic> {
        let close = self.tokens.partner(self.at);
        self.at += 1;
        loop {
            self.path(prefix.clone(), None)?;
            if self.tokens.is(self.at, b',') {
                self.at += 1;
            } else if self.at != close {
                return Err(self.tokens.expected(self.at, "`,` or `}`"));
            }
            if self.at == close {
                self.at += 1;
                return Ok(());
            }
        }
    }
}
