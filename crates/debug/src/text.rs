//! Statements of the authors' texts, and which of them each instruction belongs to.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use lamplight_compose::SourceMap;
use lamplight_diagnostic::source::{SourceId, SourceSet, Span};
use lamplight_eval::{Program, VariableKind, VariablePlace};
use lamplight_syntax::wesl::blank;
use lamplight_syntax::words::{Word, words};

/// Index of a statement in [`Statements`].
pub type StatementId = u32;

/// A statement of an author's text, or the head of one that has a block.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Statement {
    /// Where it is.
    pub span: Span,
    /// The line on which it begins, from 1.
    pub line: u32,
}

/// The statements that a program runs.
#[derive(Debug, Clone, Default)]
pub struct Statements {
    all: Vec<Statement>,
    /// That of each instruction.
    of_code: Vec<Option<StatementId>>,
    /// That of each variable's declaration.
    of_variables: Vec<Option<StatementId>>,
    /// That which can begin with each instruction.
    begun_by: Vec<Option<StatementId>>,
    /// Those with which something runs.
    running: BTreeSet<StatementId>,
}

impl Statements {
    /// Finds the statements of a program, in the text that `map` leads back from.
    pub fn new(program: &Program, text: &str, map: &SourceMap, sources: &SourceSet) -> Self {
        let mut finder =
            Finder { map, sources, ends: BTreeMap::new(), known: BTreeMap::new(), all: Vec::new() };
        let mut of_code: Vec<_> = program.spans().iter().map(|span| finder.find(*span)).collect();
        let variables = program.variables().iter();
        let mut of_variables: Vec<_> =
            variables.map(|variable| finder.find(variable.span)).collect();
        for (index, at) in plain_lets(program, text, map) {
            let found = finder.find(at);
            of_variables[index] = found;
            let place = program.variables()[index].place;
            let VariablePlace::At { slot, stride: _ } = place else { continue };
            if let Some(code) = program.copy_to(slot).and_then(|pc| of_code.get_mut(pc as usize)) {
                *code = found;
            }
        }
        let begins = program.beginnings().into_iter().zip(&of_code);
        let begun_by: Vec<Option<StatementId>> =
            begins.map(|(begins, at)| at.filter(|_| begins)).collect();
        let running = begun_by.iter().copied().flatten().collect();
        Self { all: finder.all, of_code, of_variables, begun_by, running }
    }

    /// Whether something runs with a statement, so that a run can stop there.
    pub fn runs(&self, id: StatementId) -> bool {
        self.running.contains(&id)
    }

    /// The statement at which a run stops for a line of a text: the first one that begins there or
    /// below.
    pub fn from_line(&self, source: SourceId, line: u32) -> Option<StatementId> {
        let own = |id: &StatementId| {
            self.get(*id).is_some_and(|one| one.span.source == source && one.line >= line)
        };
        let place = |id: &StatementId| self.get(*id).map(|one| one.span.start);
        self.running.iter().copied().filter(own).min_by_key(place)
    }

    /// The statement that declares a variable, by its number.
    pub fn of_variable(&self, index: usize) -> Option<StatementId> {
        self.of_variables.get(index).copied().flatten()
    }

    /// The statement of an instruction; `None` for what nobody wrote.
    pub fn at(&self, pc: u32) -> Option<StatementId> {
        self.of_code.get(pc as usize).copied().flatten()
    }

    /// The statement that can begin with an instruction.
    pub fn begun_by(&self, pc: u32) -> Option<StatementId> {
        self.begun_by.get(pc as usize).copied().flatten()
    }

    /// The first instruction of a statement.
    pub fn first_code(&self, id: StatementId) -> Option<u32> {
        self.of_code.iter().position(|at| *at == Some(id)).map(|pc| pc as u32)
    }

    /// A statement by its index.
    pub fn get(&self, id: StatementId) -> Option<&Statement> {
        self.all.get(id as usize)
    }

    /// All statements, in the order of the program's instructions.
    pub fn all(&self) -> &[Statement] {
        &self.all
    }
}

/// The places of `let` statements that only name what a variable has: naga gives what they read no
/// place. Each with the number of its variable.
fn plain_lets(program: &Program, text: &str, map: &SourceMap) -> Vec<(usize, naga::Span)> {
    let mut found: Vec<(usize, naga::Span)> = Vec::new();
    for (index, variable) in program.variables().iter().enumerate() {
        let is_plain = variable.kind == VariableKind::Let && !variable.span.is_defined();
        let function = variable.function.and_then(|id| program.signature(id));
        let Some(function) = function.filter(|_| is_plain) else { continue };
        let Some(body) = body_of(text, &function.name) else { continue };
        // Several of one name are in the order of the text; those with a place are known.
        let own = program
            .variables()
            .iter()
            .filter(|other| (other.function, &other.name) == (variable.function, &variable.name));
        let known: Vec<usize> =
            own.filter_map(|other| Some(other.span.to_range()?.start)).collect();
        let place = lets_named(text, body, &variable.name).into_iter().find(|at| {
            let end = at + text[*at..].find(';').unwrap_or(0);
            let span = naga::Span::new(*at as u32, end as u32);
            !known.iter().any(|start| (*at..end).contains(start))
                && !found.iter().any(|(_, other)| *other == span)
                && map.lookup(*at..end).is_some()
        });
        if let Some(at) = place {
            let end = at + text[at..].find(';').unwrap_or(0);
            found.push((index, naga::Span::new(at as u32, end as u32)));
        }
    }
    found
}

/// The text of a function.
fn body_of(text: &str, name: &str) -> Option<Range<usize>> {
    let head = format!("fn {name}(");
    let start = text.find(&head)?;
    let open = start + text[start..].find('{')?;
    let rest = &text[start + head.len()..];
    let end = rest.find("\nfn ").map_or(text.len(), |end| start + head.len() + end);
    Some(open..end)
}

/// Where `let` gives a name in a part of a text.
fn lets_named(text: &str, part: Range<usize>, name: &str) -> Vec<usize> {
    let all: Vec<Word<'_>> = words(&text[part.clone()]).collect();
    let pairs = all.windows(2).filter(|pair| pair[0].text == "let" && pair[1].text == name);
    pairs.map(|pair| part.start + pair[0].at).collect()
}

/// Finds statements by places in the text that naga parsed.
struct Finder<'a> {
    map: &'a SourceMap,
    sources: &'a SourceSet,
    /// Where statements and lines end in each text.
    ends: BTreeMap<SourceId, Ends>,
    /// Statements by where they begin.
    known: BTreeMap<(SourceId, usize), StatementId>,
    all: Vec<Statement>,
}

impl Finder<'_> {
    fn find(&mut self, span: naga::Span) -> Option<StatementId> {
        let place = self.map.lookup(span.to_range()?)?;
        let text = &*self.sources.get(place.source).text;
        let Ends { cuts, lines } = self.ends.entry(place.source).or_insert_with(|| Ends::of(text));
        let range = statement_around(text, cuts, place.start as usize);
        let all = &mut self.all;
        let id = self.known.entry((place.source, range.start)).or_insert_with(|| {
            let line = lines.partition_point(|end| *end < range.start) as u32 + 1;
            all.push(Statement { span: Span::new(place.source, range), line });
            all.len() as StatementId - 1
        });
        Some(*id)
    }
}

/// Where things end in a text.
struct Ends {
    /// As [`cuts_of`] has them.
    cuts: Vec<usize>,
    /// The places of line breaks.
    lines: Vec<usize>,
}

impl Ends {
    fn of(text: &str) -> Self {
        let lines = text.match_indices('\n').map(|(at, _)| at).collect();
        Self { cuts: cuts_of(text), lines }
    }
}

/// The bytes after which a statement, or the head of one, ends: `;`, `{` and `}` outside of comments.
fn cuts_of(text: &str) -> Vec<usize> {
    let (mut cuts, mut at) = (vec![0], 0);
    while let Some(byte) = text.as_bytes().get(at) {
        let comment = if *byte == b'/' { comment_length(&text[at..]) } else { 0 };
        at += comment.max(1);
        if matches!(byte, b';' | b'{' | b'}') {
            cuts.push(at);
        }
    }
    cuts.push(text.len());
    cuts
}

/// The bytes of the comment that a text begins with; 0 if it begins with none. Those of GLSL do not
/// nest: one that would not end in WGSL ends as there.
pub(crate) fn comment_length(text: &str) -> usize {
    if text.starts_with("/*") && !blank::block_comment(text).1 {
        return text.find("*/").map_or(text.len(), |end| end + 2);
    }
    blank::comment_length(text)
}

/// The statement that holds a byte, without comments and blanks before it.
fn statement_around(text: &str, cuts: &[usize], byte: usize) -> Range<usize> {
    let after = cuts.partition_point(|cut| *cut <= byte).min(cuts.len() - 1);
    let (first, end) = (cuts[after.saturating_sub(1)], cuts[after]);
    let mut start = first;
    loop {
        let rest = &text[start..end.max(start)];
        let trimmed = rest.trim_start();
        start += rest.len() - trimmed.len();
        let skipped = match trimmed {
            _ if trimmed.starts_with('#') => trimmed.find('\n').unwrap_or(trimmed.len()),
            _ => comment_length(trimmed),
        };
        if skipped == 0 {
            break;
        }
        start += skipped;
    }
    let start = start.min(end);
    let is_end = |c: char| c.is_whitespace() || matches!(c, ';' | '{' | '}');
    let mut kept = text[start..end].trim_end_matches(is_end);
    // The last part of the head of a `for` ends with the bracket that the first part opens.
    if kept.matches(')').count() > kept.matches('(').count() {
        kept = kept.strip_suffix(')').unwrap_or(kept);
    }
    start..start + kept.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statements_of_a_text() {
        let text = "// a;\nfn f() {\n  let x = 1.0; /* ; /* } */ */ let y = 2.0;\n  for (var i = 0; i < 4; i++) {}\n}";
        let cuts = cuts_of(text);
        let found = |word: &str| &text[statement_around(text, &cuts, text.find(word).unwrap())];
        assert_eq!(found("x ="), "let x = 1.0");
        assert_eq!(found("y ="), "let y = 2.0");
        assert_eq!(found("i = 0"), "for (var i = 0");
        assert_eq!(found("i < 4"), "i < 4");
        assert_eq!(found("i++"), "i++");
        assert_eq!(found("f()"), "fn f()");
    }
}
