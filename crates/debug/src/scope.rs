//! Which variables a statement sees: those that are declared before it, in a block that it is in.

use std::ops::Range;

use lamplight_diagnostic::source::{SourceId, SourceSet};
use lamplight_eval::{FunctionId, Program, Variable, VariableKind};

use crate::text::{StatementId, Statements, comment_length};

/// Where each variable of a program is seen.
#[derive(Debug, Clone, Default)]
pub struct Scopes {
    /// By the number of the variable: the text, and from where to where in it. `None` for those of
    /// the module and parameters, which are seen everywhere.
    extents: Vec<Option<(SourceId, Range<usize>)>>,
}

impl Scopes {
    /// Finds the blocks of all declarations.
    pub fn new(program: &Program, statements: &Statements, sources: &SourceSet) -> Self {
        let extent = |(index, kind): (usize, VariableKind)| {
            if !matches!(kind, VariableKind::Let | VariableKind::Var) {
                return None;
            }
            let span = statements.get(statements.of_variable(index)?)?.span;
            let text = &*sources.get(span.source).text;
            Some((span.source, span.end as usize..block_end(text, span.range())))
        };
        let kinds = program.variables().iter().map(|one| one.kind).enumerate();
        Self { extents: kinds.map(extent).collect() }
    }

    /// The variables that a function sees where it is at a statement, by their numbers: those of the
    /// module last. Of several with one name, only the innermost is seen.
    pub fn visible(
        &self,
        program: &Program,
        statements: &Statements,
        function: FunctionId,
        statement: Option<StatementId>,
    ) -> Vec<usize> {
        let at = statement.and_then(|id| statements.get(id)).map(|one| one.span);
        let mut found: Vec<usize> = Vec::new();
        let (mut own, mut of_module) = (Vec::new(), Vec::new());
        for (index, variable) in program.variables().iter().enumerate() {
            match (variable.function, variable.kind) {
                (_, VariableKind::Result) => {}
                (None, _) => of_module.push(index),
                (Some(of), _) if of != function => {}
                (Some(_), VariableKind::Parameter) => own.push((0, index)),
                (Some(_), VariableKind::Let) if is_parameter(program, variable) => {}
                (Some(_), _) => {
                    let extent = self.extents.get(index).and_then(|extent| extent.as_ref());
                    let seen = extent.zip(at).filter(|((source, range), at)| {
                        *source == at.source && range.contains(&(at.start as usize))
                    });
                    own.extend(seen.map(|((_, range), _)| (range.start, index)));
                }
            }
        }
        own.sort_by_key(|(start, index)| (std::cmp::Reverse(*start), *index));
        let name = |index: usize| program.variables().get(index).map(|one| &one.name);
        for index in own.into_iter().map(|(_, index)| index).chain(of_module) {
            if !found.iter().any(|known| name(*known) == name(index)) {
                found.push(index);
            }
        }
        found.sort_by_key(|index| {
            let of = program.variables().get(*index).and_then(|one| one.function);
            (of.is_none(), *index)
        });
        found
    }
}

/// Whether a named value is a parameter by its own name, as naga names these too.
fn is_parameter(program: &Program, one: &Variable) -> bool {
    program.variables().iter().any(|other| {
        other.kind == VariableKind::Parameter
            && (other.function, &other.name) == (one.function, &one.name)
            && other.place == one.place
    })
}

/// Where the block ends in which a declaration is. That of a `for` is seen up to the end of its loop.
fn block_end(text: &str, declaration: Range<usize>) -> usize {
    let head = text.get(declaration.clone()).unwrap_or_default();
    let is_for = head.strip_prefix("for").is_some_and(|rest| rest.trim_start().starts_with('('));
    match is_for {
        true => loop_end(text, declaration.start),
        false => scan(text, declaration.end, -1, |depth, byte| (byte == b'}') & (depth < 0)),
    }
}

/// Where a loop ends that begins at a byte with `for`: after its block, or after one statement.
fn loop_end(text: &str, start: usize) -> usize {
    let mut round = 0;
    let mut head = start;
    head = scan(text, head, 0, |_, byte| {
        round += i32::from(byte == b'(') - i32::from(byte == b')');
        byte == b')' && round == 0
    });
    scan(text, head, 0, |depth, byte| matches!(byte, b'}' | b';') && depth == 0)
}

/// The byte after the first one that is meant, outside of comments. `is_meant` gets how many braces
/// are open behind the byte, which begin with those before the text's part.
fn scan(text: &str, from: usize, least: i32, mut is_meant: impl FnMut(i32, u8) -> bool) -> usize {
    let bytes = text.as_bytes();
    let (mut at, mut depth) = (from, 0);
    while let Some(byte) = bytes.get(at) {
        let comment = if *byte == b'/' { comment_length(&text[at..]) } else { 0 };
        if comment > 0 {
            at += comment;
            continue;
        }
        match byte {
            b'{' => depth += 1,
            b'}' => depth -= 1,
            _ => {}
        }
        at += 1;
        if is_meant(depth, *byte) || depth < least {
            return at;
        }
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks() {
        let text = "fn f() { let a = 1; { let b = 2; /* } */ g(); } h(); \
                    for (var i = 0; i < 4; i++) { k(i); } l(); } fn g() {}";
        let rest = |declared: &str| {
            let start = text.find(declared).unwrap();
            &text[block_end(text, start..start + declared.len())..]
        };
        assert_eq!(rest("let a = 1"), " fn g() {}");
        assert!(rest("let b = 2").starts_with(" h();"));
        assert!(rest("for (var i = 0").starts_with(" l();"));
        let plain = "for (int i = 0; i < 4; i++) sum += i; after();";
        assert_eq!(&plain[block_end(plain, 0..14)..], " after();");
    }
}
