//! Describes a mistake in the author's terms, with its place.

use naga::{Expression, Function, Handle, Span};

use super::operators::COMPONENTS;
use super::site::{How, Mutation, Site};
use lamplight_compose::SourceMap;
use lamplight_diagnostic::source::{self, SourceSet};
use lamplight_syntax::words::is_word;

/// The most characters of an excerpt.
const LONGEST: usize = 80;

/// What is needed to quote a composed function as its author wrote it.
pub struct QuotedSource<'a> {
    pub sources: &'a SourceSet,
    pub map: &'a SourceMap,
    pub function: &'a Function,
}

impl QuotedSource<'_> {
    /// `file:line` and the trimmed line.
    pub fn place(&self, span: Span) -> (String, String) {
        let Some(found) = author_span(self.map, span) else {
            return ("?".to_owned(), String::new());
        };
        let source = self.sources.get(found.source);
        let (line, _) = self.sources.position(found.source, found.start as usize);
        let text = source.text.lines().nth(line - 1).unwrap_or_default().trim();
        (format!("{}:{line}", source.path), text.to_owned())
    }

    /// A description of the mistake.
    pub fn words(&self, site: &Site) -> String {
        let whole = self.excerpt(site.span);
        match &site.edit {
            Mutation::Expression { how, .. } => self.expression(*how, &whole),
            Mutation::Negated { condition, .. } => {
                format!("`{}` negated", self.operand(*condition))
            }
            Mutation::NoExit { condition, .. } => {
                format!("no early exit at `{}`", self.operand(*condition))
            }
            Mutation::Decided { condition, holds, .. } => {
                format!("`{holds}` instead of `{}`", self.operand(*condition))
            }
            Mutation::Exchanged { arguments: [one, other], .. } => {
                self.exchange(*one, *other, &whole)
            }
            Mutation::NoStore { .. } => format!("no assignment `{whole}`"),
            Mutation::Argument { argument, .. } => {
                format!("`{}` instead of `{whole}`", self.operand(*argument))
            }
        }
    }

    fn expression(&self, how: How, whole: &str) -> String {
        match how {
            How::Swapped => format!("operands swapped in `{whole}`"),
            How::Operator(operator) => format!("operator `{operator}` in `{whole}`"),
            How::Kept(operand) => format!("`{}` instead of `{whole}`", self.operand(operand)),
            How::NoLowerBound => format!("no lower bound in `{whole}`"),
            How::NoUpperBound => format!("no upper bound in `{whole}`"),
            How::Number(value) => format!("`{value}` instead of `{whole}`"),
            How::Whole(value) => format!("`{value}` instead of `{whole}`"),
            How::Flipped => format!("the opposite of `{whole}`"),
            How::Function(name) => format!("`{name}` in `{whole}`"),
            How::Exchanged(one, other) => self.exchange(one, other, whole),
            How::Component(index) => {
                let name = COMPONENTS.get(index).copied().unwrap_or('?');
                format!("component `{name}` in `{whole}`")
            }
        }
    }

    fn exchange(&self, one: Handle<Expression>, other: Handle<Expression>, whole: &str) -> String {
        let [one, other] = [one, other].map(|side| self.operand(side));
        format!("`{one}` and `{other}` exchanged in `{whole}`")
    }

    fn operand(&self, handle: Handle<Expression>) -> String {
        match self.function.expressions[handle] {
            Expression::FunctionArgument(index) => self
                .function
                .arguments
                .get(index as usize)
                .and_then(|argument| argument.name.clone())
                .unwrap_or_default(),
            // naga gives the load of a variable no place.
            Expression::Load { pointer } => self
                .variable(pointer)
                .unwrap_or_else(|| self.excerpt(self.function.expressions.get_span(handle))),
            _ => self.excerpt(self.function.expressions.get_span(handle)),
        }
    }

    fn variable(&self, pointer: Handle<Expression>) -> Option<String> {
        match self.function.expressions[pointer] {
            Expression::LocalVariable(variable) => {
                self.function.local_variables[variable].name.clone()
            }
            _ => None,
        }
    }

    /// The author's text, with white space replaced by single blanks.
    fn excerpt(&self, span: Span) -> String {
        let text = author_span(self.map, span).map_or("?", |found| self.whole_call(found));
        let spaced = text.split_whitespace().collect::<Vec<_>>().join(" ");
        match spaced.char_indices().nth(LONGEST) {
            Some((end, _)) => format!("{}...", &spaced[..end]),
            None => spaced,
        }
    }

    /// naga gives a call the place of the function's name, so its arguments are added.
    fn whole_call(&self, span: source::Span) -> &str {
        let text = &self.sources.get(span.source).text;
        let (name, rest) = (self.sources.text(span), &text[span.end as usize..]);
        if !is_word(name) || !rest.starts_with('(') {
            return name;
        }
        let mut depth = 0;
        let end = rest.bytes().position(|byte| {
            depth += i32::from(byte == b'(') - i32::from(byte == b')');
            depth == 0
        });
        &text[span.start as usize..span.end as usize + end.map_or(0, |end| end + 1)]
    }
}

/// The author's span of a span of the composed text.
pub fn author_span(map: &SourceMap, span: Span) -> Option<source::Span> {
    map.lookup(span.to_range()?)
}
