//! Reads a text into a [`Tree`], by the grammar of the specification.

mod expression;
mod item;
mod statement;

use rustc_hash::FxHashMap;

use super::syntax::{
    Attribute, Expr, ExprId, ExprKind, Filter, Filtered, Local, LocalId, Severity, Tree,
};
use super::token::{Kind, Token, tokenize};
use super::{Place, Problem, Rule};

/// How deep statements and expressions may nest. naga's own limit is lower.
const DEPTH: u16 = 900;

/// Something that is not WGSL.
pub type Parsed<T> = Result<T, Problem>;

/// Reads a text. `None` where it has something that is no token.
pub fn parse(text: &str) -> Option<Parsed<(Tree<'_>, Vec<Problem>)>> {
    let tokens = tokenize(text)?;
    let mut parser = Parser {
        tokens,
        at: 0,
        tree: Tree::default(),
        problems: Vec::new(),
        depth: 0,
        is_in_function: false,
        diagnostics: 0,
        scope: FxHashMap::default(),
        declared: Vec::new(),
    };
    Some(parser.module().map(|()| (parser.tree, parser.problems)))
}

pub struct Parser<'t> {
    tokens: Vec<Token<'t>>,
    at: usize,
    tree: Tree<'t>,
    problems: Vec<Problem>,
    depth: u16,
    /// Attributes belong to a statement.
    is_in_function: bool,
    /// Attributes with a filter so far.
    diagnostics: usize,
    /// What each name means here, if it is declared in the function, with what it meant around.
    scope: FxHashMap<&'t str, Vec<LocalId>>,
    /// The names of the scopes that are open, in the order of their declarations.
    declared: Vec<&'t str>,
}

impl<'t> Parser<'t> {
    fn token(&self) -> Token<'t> {
        self.tokens[self.at]
    }

    /// The token after the next one.
    fn second(&self) -> Token<'t> {
        self.tokens[(self.at + 1).min(self.tokens.len() - 1)]
    }

    fn next(&mut self) -> Token<'t> {
        let token = self.token();
        if token.kind != Kind::End {
            self.at += 1;
        }
        token
    }

    /// Whether the next token is a mark or a keyword.
    fn is(&self, text: &str) -> bool {
        let token = self.token();
        matches!(token.kind, Kind::Mark | Kind::Word) && token.text == text
    }

    fn take(&mut self, text: &str) -> bool {
        let is = self.is(text);
        self.at += usize::from(is);
        is
    }

    fn expect(&mut self, text: &str) -> Parsed<Place> {
        let place = self.token().place;
        match self.take(text) {
            true => Ok(place),
            false => Err(self.missing(text)),
        }
    }

    fn word(&mut self) -> Parsed<&'t str> {
        match self.token().kind {
            Kind::Word => Ok(self.next().text),
            _ => Err(self.unexpected("a name")),
        }
    }

    /// An error that names the mark or the keyword that must stand here.
    fn missing(&self, mark: &str) -> Problem {
        self.unexpected(&format!("`{mark}`"))
    }

    fn unexpected(&self, wanted: &str) -> Problem {
        let token = self.token();
        let found = match token.kind {
            Kind::End => "the end of the text".to_owned(),
            _ => format!("`{}`", token.text),
        };
        Problem::new(Rule::Grammar, token.place, format!("expected {wanted}, found {found}"))
    }

    /// Where the token before the next one ends.
    fn end(&self) -> u32 {
        self.tokens[self.at.saturating_sub(1)].place.end
    }

    fn add(&mut self, kind: ExprKind<'t>, start: u32) -> Parsed<ExprId> {
        let height = |id: &ExprId| self.tree.expressions[*id as usize].height;
        let below = match &kind {
            ExprKind::Literal(_) => 0,
            ExprKind::Name { name: _, template, local: _ } => {
                template.iter().map(height).max().unwrap_or(0)
            }
            ExprKind::Call { callee: _, template, arguments } => {
                template.iter().chain(arguments).map(height).max().unwrap_or(0)
            }
            ExprKind::Member { base: one, name: _ }
            | ExprKind::Unary { operator: _, operand: one }
            | ExprKind::AddressOf(one)
            | ExprKind::Indirection(one)
            | ExprKind::Parenthesized(one) => height(one),
            ExprKind::Index { base: one, index: other }
            | ExprKind::Binary { operator: _, left: one, right: other } => {
                height(one).max(height(other))
            }
        };
        let place = Place { start, end: self.end() };
        if below >= DEPTH {
            return Err(Problem::new(Rule::Depth, place, "expressions nest too deep".to_owned()));
        }
        self.tree.expressions.push(Expr { kind, place, height: below + 1 });
        Ok(self.tree.expressions.len() as ExprId - 1)
    }

    /// Goes one step deeper into what nests.
    fn deeper<T>(&mut self, read: impl FnOnce(&mut Self) -> Parsed<T>) -> Parsed<T> {
        if self.depth >= DEPTH {
            let place = self.token().place;
            return Err(Problem::new(Rule::Depth, place, "the text nests too deep".to_owned()));
        }
        self.depth += 1;
        let result = read(self);
        self.depth -= 1;
        result
    }

    /// Reads something whose names end with it.
    fn scoped<T>(&mut self, read: impl FnOnce(&mut Self) -> Parsed<T>) -> Parsed<T> {
        let outer = self.declared.len();
        let result = read(self);
        for name in self.declared.drain(outer..) {
            self.scope.get_mut(name).map(Vec::pop);
        }
        result
    }

    /// Gives a name its meaning from here to the end of its scope.
    fn declare(&mut self, name: &'t str, local: Local) -> LocalId {
        let id = self.tree.locals.len() as LocalId;
        self.tree.locals.push(local);
        self.scope.entry(name).or_default().push(id);
        self.declared.push(name);
        id
    }

    /// Attributes, and the filters among them.
    fn attributes(&mut self) -> Parsed<(Vec<Attribute<'t>>, Vec<Filter>)> {
        let (mut attributes, mut filters) = (Vec::new(), Vec::new());
        while self.is("@") {
            let start = self.next().place.start;
            let name = self.word()?;
            if name == "diagnostic" {
                let filter = self.diagnostic()?;
                let is_repeated = |filter: &Filter| {
                    filters.iter().any(|known: &Filter| known.rule == filter.rule)
                };
                if filter.as_ref().is_some_and(is_repeated) {
                    let place = Place { start, end: self.end() };
                    let message = "a second `@diagnostic` for the same rule".to_owned();
                    self.problems.push(Problem::new(Rule::Attribute, place, message));
                }
                filters.extend(filter);
                self.diagnostics += 1;
                if self.is_in_function {
                    let place = Place { start, end: self.end() };
                    self.tree.statement_filters.push(place);
                }
                continue;
            }
            let arguments = match self.is("(") {
                true => self.arguments()?,
                false => Vec::new(),
            };
            let place = Place { start, end: self.end() };
            attributes.push(Attribute { name, arguments, place });
        }
        Ok((attributes, filters))
    }

    /// Attributes where no filter of diagnostics may stand.
    fn plain_attributes(&mut self) -> Parsed<Vec<Attribute<'t>>> {
        let (place, count) = (self.token().place, self.diagnostics);
        let (attributes, _) = self.attributes()?;
        self.refuse_filters(count, place);
        Ok(attributes)
    }

    /// Reports filters that were read since there were `count` of them.
    fn refuse_filters(&mut self, count: usize, place: Place) {
        if self.diagnostics > count {
            let message = "`@diagnostic` does not belong here".to_owned();
            self.problems.push(Problem::new(Rule::Attribute, place, message));
        }
    }

    /// What stands in the brackets of `diagnostic`. Rules that are not known give nothing.
    fn diagnostic(&mut self) -> Parsed<Option<Filter>> {
        self.expect("(")?;
        let place = self.token().place;
        let severity = match self.word()? {
            "off" => Severity::Off,
            "info" => Severity::Info,
            "warning" => Severity::Warning,
            "error" => Severity::Error,
            other => {
                let message = format!("`{other}` is no severity of a diagnostic");
                return Err(Problem::new(Rule::Grammar, place, message));
            }
        };
        self.expect(",")?;
        let rule = match self.word()? {
            "derivative_uniformity" => Some(Filtered::DerivativeUniformity),
            "subgroup_uniformity" => Some(Filtered::SubgroupUniformity),
            _ => None,
        };
        let is_of_tool = self.take(".");
        if is_of_tool {
            self.word()?;
        }
        let rule = rule.filter(|_| !is_of_tool);
        self.take(",");
        self.expect(")")?;
        Ok(rule.map(|rule| Filter { severity, rule }))
    }
}
