//! Answers what stands at a place of a text, for messages that quote its parts.

use std::ops::Range;

use super::Place;
use super::parse;
use super::syntax::{
    Block, Declaration, DeclarationKind, ExprId, ExprKind, Function, Statement, StatementKind, Tree,
};

/// What an expression is made of.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Piece<'t> {
    Literal,
    Name(&'t str),
    Call { name: &'t str, arguments: Vec<Place> },
    Member { base: Place, name: &'t str },
    Index { base: Place, index: Place },
    Unary { operator: &'t str, operand: Place },
    AddressOf(Place),
    Indirection(Place),
    Binary { operator: &'t str, left: Place, right: Place },
    Parenthesized(Place),
}

/// What a statement is made of, without the statements within it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Step<'t> {
    Declare { keyword: &'static str, name: &'t str, value: Option<Place> },
    Assign { target: Option<Place>, operator: &'t str, value: Place },
    Condition(Place),
    Return(Option<Place>),
    Other,
}

/// A parameter, or a declaration in a function or in the module.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Declared<'t> {
    /// `let`, `var`, `const`, `override`, or `parameter`.
    pub keyword: &'static str,
    pub name: &'t str,
    pub place: Place,
    pub of_type: Option<Place>,
    pub value: Option<Place>,
}

/// The head of a function.
#[derive(Debug, Clone)]
pub struct Head<'t> {
    pub name: &'t str,
    pub place: Place,
    pub parameters: Vec<Declared<'t>>,
    pub result: Option<Place>,
}

/// A text whose parts can be asked for.
#[derive(Debug)]
pub struct Lookup<'t> {
    tree: Tree<'t>,
}

impl<'t> Lookup<'t> {
    /// `None` where the text is no WGSL. It needs a large stack.
    pub fn read(text: &'t str) -> Option<Self> {
        let (tree, _) = parse::parse(text)?.ok()?;
        Some(Self { tree })
    }

    /// The expression that has a place.
    pub fn piece(&self, range: &Range<usize>) -> Option<Piece<'t>> {
        // Expressions are in the order in which they end.
        let ends = |end: usize| {
            self.tree.expressions.partition_point(|one| (one.place.end as usize) < end)
        };
        let (first, behind) = (ends(range.end), ends(range.end + 1));
        let found =
            (first..behind).rev().find(|at| self.tree.expressions[*at].place.range() == *range)?;
        Some(self.piece_of(found as ExprId))
    }

    /// The outermost call whose name begins at a place, with its own place.
    pub fn call(&self, start: usize) -> Option<(Place, Piece<'t>)> {
        let is_call = |one: &&super::syntax::Expr<'t>| {
            one.place.start as usize == start && matches!(one.kind, ExprKind::Call { .. })
        };
        let found = self.tree.expressions.iter().rposition(|one| is_call(&one))? as ExprId;
        Some((self.tree.place(found), self.piece_of(found)))
    }

    /// Every call within a function, with its place, its name and its arguments.
    pub fn calls(&self) -> Vec<(Place, &'t str, Vec<Place>)> {
        let calls = self.tree.expressions.iter().filter_map(|one| match &one.kind {
            ExprKind::Call { callee, template: _, arguments } => {
                let arguments = arguments.iter().map(|id| self.tree.place(*id)).collect();
                Some((one.place, *callee, arguments))
            }
            _ => None,
        });
        calls.filter(|(place, ..)| self.tree.enclosing(*place).is_some()).collect()
    }

    /// The expressions with an operator between two within a place: their own places, and those of
    /// their sides.
    pub fn operations(&self, operator: &str, within: &Range<usize>) -> Vec<[Place; 3]> {
        let found = self.tree.expressions.iter().filter_map(|one| match one.kind {
            ExprKind::Binary { operator: found, left, right } if found == operator => {
                Some([one.place, self.tree.place(left), self.tree.place(right)])
            }
            _ => None,
        });
        let is_within =
            |place: Place| within.start as u32 <= place.start && place.end <= within.end as u32;
        found.filter(|[place, ..]| is_within(*place)).collect()
    }

    /// The name of the first structure with members of these names, and of no others.
    pub fn structure_of(&self, members: &[&str]) -> Option<&'t str> {
        let has_them = |one: &&super::syntax::Struct<'t>| {
            one.members.iter().map(|member| member.name).eq(members.iter().copied())
        };
        self.tree.structs.iter().find(has_them).map(|one| one.name)
    }

    /// The heads of all functions.
    pub fn heads(&self) -> Vec<Head<'t>> {
        self.tree.functions.iter().map(|function| self.head_of(function)).collect()
    }

    /// The innermost call around a place, with its own place, and which of its arguments that is.
    pub fn call_around(&self, range: &Range<usize>) -> Option<(Place, &'t str, usize)> {
        self.tree.expressions.iter().find_map(|one| {
            let ExprKind::Call { callee, arguments, .. } = &one.kind else { return None };
            let at = arguments.iter().position(|argument| {
                let place = self.tree.place(*argument).range();
                place.start <= range.start && range.end <= place.end
            })?;
            Some((one.place, *callee, at))
        })
    }

    /// The innermost statement that holds a place.
    pub fn step(&self, range: &Range<usize>) -> Option<(Place, Step<'t>)> {
        let place = Place { start: range.start as u32, end: range.end as u32 };
        let function = &self.tree.functions[self.tree.enclosing(place)?];
        let mut found = None;
        each_statement(&function.body, &mut |statement| {
            if statement.place.start <= place.start && place.end <= statement.place.end {
                found = Some((statement.place, self.step_of(statement)));
            }
        });
        found
    }

    /// What a name means at a place: the last declaration before it, or one of the module.
    pub fn declared(&self, name: &str, at: usize) -> Option<Declared<'t>> {
        let place = Place { start: at as u32, end: at as u32 };
        let mut found = None;
        if let Some(function) = self.tree.enclosing(place) {
            let function = &self.tree.functions[function];
            found = self.parameters(function).into_iter().find(|one| one.name == name);
            each_statement(&function.body, &mut |statement| {
                if let StatementKind::Declare(_, declaration) = &statement.kind
                    && declaration.name == name
                    && (declaration.place.start as usize) < at
                {
                    found = Some(self.declared_by(declaration));
                }
            });
        }
        let of_module = || {
            let mut declarations = self.tree.declarations.iter();
            declarations.find(|one| one.name == name).map(|one| self.declared_by(one))
        };
        found.or_else(of_module)
    }

    /// All declarations of a name in the function around a place.
    pub fn all_declared(&self, name: &str, at: usize) -> Vec<Declared<'t>> {
        let place = Place { start: at as u32, end: at as u32 };
        let Some(function) = self.tree.enclosing(place) else { return Vec::new() };
        let mut found = Vec::new();
        each_statement(&self.tree.functions[function].body, &mut |statement| {
            if let StatementKind::Declare(_, declaration) = &statement.kind
                && declaration.name == name
            {
                found.push(self.declared_by(declaration));
            }
        });
        found
    }

    /// The function around a place, or the one whose name it is.
    pub fn head(&self, at: usize) -> Option<Head<'t>> {
        let at = at as u32;
        let holds = |one: &&Function<'t>| one.place.start <= at && at < one.body.place.end;
        let mut functions = self.tree.functions.iter();
        // The keyword and the attributes stand before the name.
        let behind = |one: &&Function<'t>| one.place.start > at;
        let function = functions.clone().find(holds).or_else(|| functions.find(behind))?;
        Some(self.head_of(function))
    }

    /// The function with a name.
    pub fn head_named(&self, name: &str) -> Option<Head<'t>> {
        self.tree.functions.iter().find(|one| one.name == name).map(|one| self.head_of(one))
    }

    /// A structure's members.
    pub fn members(&self, structure: &str) -> Vec<Declared<'t>> {
        let found = self.tree.structs.iter().find(|one| one.name == structure);
        let members = found.into_iter().flat_map(|one| &one.members);
        let declared = members.map(|member| Declared {
            keyword: "member",
            name: member.name,
            place: member.place,
            of_type: Some(self.tree.place(member.of_type)),
            value: None,
        });
        declared.collect()
    }

    fn head_of(&self, function: &Function<'t>) -> Head<'t> {
        Head {
            name: function.name,
            place: function.place,
            parameters: self.parameters(function),
            result: function.result.map(|result| self.tree.place(result)),
        }
    }

    fn parameters(&self, function: &Function<'t>) -> Vec<Declared<'t>> {
        let declared = function.parameters.iter().map(|parameter| Declared {
            keyword: "parameter",
            name: parameter.name,
            place: parameter.place,
            of_type: Some(self.tree.place(parameter.of_type)),
            value: None,
        });
        declared.collect()
    }

    fn declared_by(&self, declaration: &Declaration<'t>) -> Declared<'t> {
        Declared {
            keyword: keyword(declaration.kind),
            name: declaration.name,
            place: declaration.place,
            of_type: declaration.of_type.map(|id| self.tree.place(id)),
            value: declaration.value.map(|id| self.tree.place(id)),
        }
    }

    fn piece_of(&self, id: ExprId) -> Piece<'t> {
        let place = |id: &ExprId| self.tree.place(*id);
        match self.tree.kind(id) {
            ExprKind::Literal(_) => Piece::Literal,
            ExprKind::Name { name, template: _, local: _ } => Piece::Name(name),
            ExprKind::Call { callee, template: _, arguments } => {
                Piece::Call { name: callee, arguments: arguments.iter().map(place).collect() }
            }
            ExprKind::Member { base, name } => Piece::Member { base: place(base), name },
            ExprKind::Index { base, index } => {
                Piece::Index { base: place(base), index: place(index) }
            }
            ExprKind::Unary { operator, operand } => {
                Piece::Unary { operator, operand: place(operand) }
            }
            ExprKind::AddressOf(operand) => Piece::AddressOf(place(operand)),
            ExprKind::Indirection(operand) => Piece::Indirection(place(operand)),
            ExprKind::Binary { operator, left, right } => {
                Piece::Binary { operator, left: place(left), right: place(right) }
            }
            ExprKind::Parenthesized(inner) => Piece::Parenthesized(place(inner)),
        }
    }

    fn step_of(&self, statement: &Statement<'t>) -> Step<'t> {
        let place = |id: &ExprId| self.tree.place(*id);
        match &statement.kind {
            StatementKind::Declare(_, declaration) => Step::Declare {
                keyword: keyword(declaration.kind),
                name: declaration.name,
                value: declaration.value.as_ref().map(place),
            },
            StatementKind::Assign { target, operator, value } => {
                Step::Assign { target: target.as_ref().map(place), operator, value: place(value) }
            }
            StatementKind::If { condition, accept: _, reject: _ }
            | StatementKind::While { condition, body: _ }
            | StatementKind::BreakIf(condition) => Step::Condition(place(condition)),
            StatementKind::For(one) => one
                .condition
                .as_ref()
                .map_or(Step::Other, |condition| Step::Condition(place(condition))),
            StatementKind::Return(value) => Step::Return(value.as_ref().map(place)),
            _ => Step::Other,
        }
    }
}

fn keyword(kind: DeclarationKind) -> &'static str {
    match kind {
        DeclarationKind::Const => "const",
        DeclarationKind::Let => "let",
        DeclarationKind::Override => "override",
        DeclarationKind::Var => "var",
    }
}

/// Every statement of a block, each before those within it.
pub fn each_statement<'s, 't>(block: &'s Block<'t>, visit: &mut dyn FnMut(&'s Statement<'t>)) {
    block.statements.iter().for_each(|statement| each_within(statement, visit));
}

fn each_within<'s, 't>(statement: &'s Statement<'t>, visit: &mut dyn FnMut(&'s Statement<'t>)) {
    visit(statement);
    match &statement.kind {
        StatementKind::Block(block) | StatementKind::While { condition: _, body: block } => {
            each_statement(block, visit);
        }
        StatementKind::If { condition: _, accept, reject } => {
            each_statement(accept, visit);
            reject.iter().for_each(|reject| each_within(reject, visit));
        }
        StatementKind::Switch { selector: _, filters: _, values: _, clauses } => {
            clauses.iter().for_each(|clause| each_statement(clause, visit));
        }
        StatementKind::Loop { body, continuing } => {
            each_statement(body, visit);
            continuing.iter().for_each(|continuing| each_statement(continuing, visit));
        }
        StatementKind::For(one) => {
            one.start.iter().chain(&one.update).for_each(|each| each_within(each, visit));
            each_statement(&one.body, visit);
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::{Lookup, Piece, Step};

    const TEXT: &str = "fn f(x: f32) -> f32 {\n    let n = 3;\n    if x > 0.0 { return g(x * n); }\n    return x;\n}";

    fn range(part: &str) -> std::ops::Range<usize> {
        let start = TEXT.find(part).unwrap_or_default();
        start..start + part.len()
    }

    #[test]
    fn pieces_and_calls_are_found_by_their_places() {
        let lookup = Lookup::read(TEXT).unwrap();
        let product = lookup.piece(&range("x * n"));
        let Some(Piece::Binary { operator: "*", left, right }) = product else {
            panic!("{product:?}")
        };
        assert_eq!((&TEXT[left.range()], &TEXT[right.range()]), ("x", "n"));
        let (place, _) = lookup.call(range("g(").start).unwrap();
        assert_eq!(&TEXT[place.range()], "g(x * n)");
        assert_eq!(lookup.call_around(&range("x * n")).map(|found| found.1), Some("g"));
    }

    #[test]
    fn declarations_and_statements_are_found() {
        let lookup = Lookup::read(TEXT).unwrap();
        let declared = lookup.declared("n", range("x * n").start).unwrap();
        assert_eq!((declared.keyword, &TEXT[declared.value.unwrap().range()]), ("let", "3"));
        assert_eq!(lookup.declared("x", range("x * n").start).unwrap().keyword, "parameter");
        assert!(lookup.declared("y", TEXT.len() - 2).is_none());
        let (place, step) = lookup.step(&range("g(x")).unwrap();
        assert!(matches!(step, Step::Return(Some(_))) && TEXT[place.range()].starts_with("return"));
    }
}
