//! The mistakes that can be put into a function, one at a time.
//!
//! The tables say what authors confuse: operators, built-in functions, and operands that may not be
//! swapped. [`apply_mutation`] puts a mistake into a function, and [`QuotedSource`] describes it in
//! the author's terms, with its place.

use crate::limit::Limit;
use lamplight_compose::SourceMap;
use lamplight_diagnostic::source;
use lamplight_diagnostic::source::SourceSet;
use lamplight_syntax::words::is_word;
use lamplight_validate::{inner_blocks, inner_blocks_mut};
use naga::valid::{FunctionInfo, ModuleInfo};
use naga::{
    BinaryOperator as Op, Block, Expression, Function, Handle, Literal, MathFunction as Math,
    Module, Range, ScalarKind, Span, Statement, SwizzleComponent, Type, TypeInner, UnaryOperator,
    VectorSize,
};

/// One mistake: its place in the composed text, and the change.
#[derive(Debug, Clone)]
pub struct Site {
    pub span: Span,
    pub edit: Mutation,
}

/// What a mistake changes. Statements are counted in the order of the text, outer ones first.
#[derive(Debug, Clone)]
pub enum Mutation {
    /// An expression becomes another over the same operands.
    Expression { at: Handle<Expression>, with: Expression, how: How },
    /// The branches of an `if` are swapped: its condition is negated.
    Negated { statement: usize, condition: Handle<Expression> },
    /// An `if` whose branch leaves the function is replaced by its `else`.
    NoExit { statement: usize, condition: Handle<Expression> },
    /// Any other `if` is replaced by one of its branches.
    Decided { statement: usize, condition: Handle<Expression>, holds: bool },
    /// An assignment is removed.
    NoStore { statement: usize },
    /// A call is replaced by its argument.
    Argument { statement: usize, result: Handle<Expression>, argument: Handle<Expression> },
    /// Two arguments of a call change places.
    Exchanged { statement: usize, first: usize, arguments: [Handle<Expression>; 2] },
    /// All results of the function have a bound.
    Limited(Limit),
}

/// How an expression was changed, for a description.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum How {
    Swapped,
    Operator(&'static str),
    /// This operand replaces the expression.
    Kept(Handle<Expression>),
    NoLowerBound,
    NoUpperBound,
    Number(f32),
    Whole(i64),
    Flipped,
    Function(&'static str),
    /// These two neighbouring arguments of a constructor change places.
    Exchanged(Handle<Expression>, Handle<Expression>),
    /// Another component of a vector.
    Component(usize),
}

/// The sites of a function of the module.
pub fn mutation_sites(module: &Module, info: &ModuleInfo, handle: Handle<Function>) -> Vec<Site> {
    let function = &module.functions[handle];
    let finder = Finder { module, info: &info[handle], function };
    let mut sites = Vec::new();
    for (at, expression) in function.expressions.iter() {
        let span = function.expressions.get_span(at);
        let changed = finder.expression(at, expression).into_iter();
        sites.extend(
            changed.map(|(with, how)| Site { span, edit: Mutation::Expression { at, with, how } }),
        );
    }
    finder.block(&function.body, &mut 0, &mut sites);
    sites
}

/// An expression with the value of an operand, to replace another one in place: the minimum of the
/// operand with itself, or `||` for a boolean. There is none for other types.
pub fn equal_value(inner: &TypeInner, of: Handle<Expression>) -> Option<Expression> {
    match inner {
        TypeInner::Scalar(scalar) | TypeInner::Vector { scalar, .. }
            if scalar.kind != ScalarKind::Bool =>
        {
            Some(Expression::Math {
                fun: Math::Min,
                arg: of,
                arg1: Some(of),
                arg2: None,
                arg3: None,
            })
        }
        TypeInner::Scalar(_) => Some(Expression::Binary { op: Op::LogicalOr, left: of, right: of }),
        _ => None,
    }
}

struct Finder<'a> {
    module: &'a Module,
    info: &'a FunctionInfo,
    function: &'a Function,
}

type Changed = Vec<(Expression, How)>;

impl Finder<'_> {
    fn ty(&self, handle: Handle<Expression>) -> &TypeInner {
        self.info[handle].ty.inner_with(&self.module.types)
    }

    fn expression(&self, at: Handle<Expression>, expression: &Expression) -> Changed {
        match *expression {
            Expression::Literal(literal) => wrong_literal(literal).into_iter().collect(),
            Expression::Constant(constant) => {
                match self.module.global_expressions[self.module.constants[constant].init] {
                    Expression::Literal(literal) => wrong_literal(literal).into_iter().collect(),
                    _ => Vec::new(),
                }
            }
            Expression::Binary { op, left, right } => self.binary(at, op, left, right),
            Expression::Unary { op: UnaryOperator::Negate | UnaryOperator::LogicalNot, expr } => {
                self.kept(expr)
            }
            Expression::Select { condition, accept, reject } => {
                let swapped = Expression::Select { condition, accept: reject, reject: accept };
                let kept = [accept, reject].map(|side| self.kept(side)).concat();
                std::iter::once((swapped, How::Swapped)).chain(kept).collect()
            }
            Expression::Compose { ty, ref components } => self.exchanged(ty, components),
            Expression::AccessIndex { base, index } => self.component(base, index),
            Expression::Swizzle { size, vector, pattern } => swapped_swizzle(size, vector, pattern),
            Expression::Math { fun, arg, arg1, arg2, arg3 } => {
                self.math(fun, arg, [arg1, arg2, arg3])
            }
            _ => Vec::new(),
        }
    }

    /// Neighbouring arguments of a constructor change places, if they have the same type.
    fn exchanged(&self, ty: Handle<Type>, components: &[Handle<Expression>]) -> Changed {
        let pairs = components.windows(2).enumerate().filter(|(_, pair)| self.can_exchange(pair));
        pairs
            .map(|(index, pair)| {
                let mut components = components.to_vec();
                components.swap(index, index + 1);
                (Expression::Compose { ty, components }, How::Exchanged(pair[0], pair[1]))
            })
            .collect()
    }

    /// Whether both have the same type, and are not the same expression or literal.
    fn can_exchange(&self, pair: &[Handle<Expression>]) -> bool {
        let written = [pair[0], pair[1]].map(|side| &self.function.expressions[side]);
        let are_same = match written {
            [Expression::Literal(one), Expression::Literal(other)] => one == other,
            _ => pair[0] == pair[1],
        };
        !are_same && self.ty(pair[0]) == self.ty(pair[1])
    }

    /// The next component of the vector; after the last one, the first.
    fn component(&self, base: Handle<Expression>, index: u32) -> Changed {
        let vector = match *self.ty(base) {
            TypeInner::Pointer { base, .. } => &self.module.types[base].inner,
            ref inner => inner,
        };
        let TypeInner::Vector { size, .. } = *vector else { return Vec::new() };
        let next = (index + 1) % size as u32;
        vec![(Expression::AccessIndex { base, index: next }, How::Component(next as usize))]
    }

    fn binary(
        &self,
        at: Handle<Expression>,
        op: Op,
        left: Handle<Expression>,
        right: Handle<Expression>,
    ) -> Changed {
        let others =
            OPERATORS.iter().find(|(known, _)| *known == op).map_or(&[][..], |(_, others)| others);
        let mut found: Changed = others
            .iter()
            .map(|(op, name)| (Expression::Binary { op: *op, left, right }, How::Operator(name)))
            .collect();
        let matrices = [left, right]
            .iter()
            .any(|operand| matches!(self.ty(*operand), TypeInner::Matrix { .. }));
        if SIDED.contains(&op) || (op == Op::Multiply && matrices) {
            found.push((Expression::Binary { op, left: right, right: left }, How::Swapped));
        }
        let same = [left, right].into_iter().filter(|side| self.ty(*side) == self.ty(at));
        found.extend(same.flat_map(|side| self.kept(side)));
        found
    }

    fn math(
        &self,
        fun: Math,
        arg: Handle<Expression>,
        rest: [Option<Handle<Expression>>; 3],
    ) -> Changed {
        let [arg1, arg2, arg3] = rest;
        let mut found = Vec::new();
        let two = |fun, a, b| Expression::Math { fun, arg: a, arg1: b, arg2: None, arg3: None };
        if SIDED_MATH.contains(&fun)
            && let Some(second) = arg1
            && self.ty(arg) == self.ty(second)
        {
            found.push((
                Expression::Math { fun, arg: second, arg1: Some(arg), arg2, arg3 },
                How::Swapped,
            ));
        }
        if fun == Math::Clamp {
            found.extend([
                (two(Math::Min, arg, arg2), How::NoLowerBound),
                (two(Math::Max, arg, arg1), How::NoUpperBound),
            ]);
        }
        let others = BUILT_INS.iter().filter(|(known, ..)| *known == fun);
        found.extend(others.map(|(_, other, name)| (two(*other, arg, arg1), How::Function(name))));
        let gives_argument = !matches!(
            fun,
            Math::Dot
                | Math::Distance
                | Math::Length
                | Math::Outer
                | Math::Determinant
                | Math::Transpose
        );
        if gives_argument {
            found.extend(self.kept(arg));
        }
        if let (Math::Min | Math::Max, Some(second)) = (fun, arg1) {
            found.extend(self.kept(second));
        }
        found
    }

    fn kept(&self, operand: Handle<Expression>) -> Changed {
        equal_value(self.ty(operand), operand)
            .map(|with| (with, How::Kept(operand)))
            .into_iter()
            .collect()
    }

    fn block(&self, block: &Block, count: &mut usize, sites: &mut Vec<Site>) {
        for (statement, span) in block.span_iter() {
            self.statement(statement, *span, *count, sites);
            *count += 1;
            inner_blocks(statement).into_iter().for_each(|block| self.block(block, count, sites));
        }
    }

    /// Whether a store goes to a variable that naga made for `&&` or `||`. Mistakes in its branches
    /// are covered by mistakes in the operator.
    fn is_unnamed(&self, pointer: Handle<Expression>) -> bool {
        match self.function.expressions[pointer] {
            Expression::LocalVariable(variable) => {
                self.function.local_variables[variable].name.is_none()
            }
            _ => false,
        }
    }

    fn statement(&self, statement: &Statement, span: Span, at: usize, sites: &mut Vec<Site>) {
        match statement {
            Statement::If { condition, accept, reject } => {
                sites.extend(self.conditions(at, *condition, accept, reject));
            }
            Statement::Store { pointer, .. } if !self.is_unnamed(*pointer) => {
                sites.push(Site { span, edit: Mutation::NoStore { statement: at } })
            }
            Statement::Call { arguments, result: Some(result), .. } => {
                sites.extend(self.call(at, arguments, *result));
            }
            _ => {}
        }
    }

    fn conditions(
        &self,
        statement: usize,
        condition: Handle<Expression>,
        accept: &Block,
        reject: &Block,
    ) -> Vec<Site> {
        let span = self.function.expressions.get_span(condition);
        let mut edits = vec![Mutation::Negated { statement, condition }];
        if matches!(accept.last(), Some(Statement::Return { .. } | Statement::Kill)) {
            edits.push(Mutation::NoExit { statement, condition });
        } else if !ends_flow(accept) && !ends_flow(reject) {
            let decided =
                [true, false].map(|holds| Mutation::Decided { statement, condition, holds });
            edits.extend(decided);
        }
        edits.into_iter().map(|edit| Site { span, edit }).collect()
    }

    fn call(
        &self,
        statement: usize,
        arguments: &[Handle<Expression>],
        result: Handle<Expression>,
    ) -> Vec<Site> {
        let (span, ty) = (self.function.expressions.get_span(result), self.ty(result));
        let argument = arguments
            .iter()
            .find(|argument| self.ty(**argument) == ty && equal_value(ty, **argument).is_some())
            .map(|argument| Mutation::Argument { statement, result, argument: *argument });
        let pairs = arguments.windows(2).enumerate().filter(|(_, pair)| self.can_exchange(pair));
        let exchanged = pairs.map(|(first, pair)| Mutation::Exchanged {
            statement,
            first,
            arguments: [pair[0], pair[1]],
        });
        argument.into_iter().chain(exchanged).map(|edit| Site { span, edit }).collect()
    }
}

/// Whether the block ends in a jump, so that nothing after it runs.
fn ends_flow(block: &Block) -> bool {
    let ends = |statement: &Statement| {
        matches!(
            statement,
            Statement::Return { .. } | Statement::Kill | Statement::Break | Statement::Continue
        )
    };
    block.last().is_some_and(ends)
}

/// The first two components of a swizzle change places.
fn swapped_swizzle(
    size: VectorSize,
    vector: Handle<Expression>,
    pattern: [SwizzleComponent; 4],
) -> Changed {
    let [first, second, rest @ ..] = pattern;
    if first == second {
        return Vec::new();
    }
    let pattern = [second, first, rest[0], rest[1]];
    vec![(Expression::Swizzle { size, vector, pattern }, How::Swapped)]
}

/// A literal with a mistake: a float changed by one part in a hundred, an integer by one, a boolean
/// negated.
fn wrong_literal(literal: Literal) -> Option<(Expression, How)> {
    let (literal, how) = match literal {
        Literal::F32(value) => {
            let off = if value == 0.0 { 0.01 } else { value * 1.01 };
            (Literal::F32(off), How::Number(off))
        }
        Literal::I32(value) => {
            (Literal::I32(value.wrapping_add(1)), How::Whole(i64::from(value) + 1))
        }
        Literal::U32(value) => {
            (Literal::U32(value.wrapping_add(1)), How::Whole(i64::from(value) + 1))
        }
        Literal::Bool(value) => (Literal::Bool(!value), How::Flipped),
        _ => return None,
    };
    Some((Expression::Literal(literal), how))
}

/// Operators that authors confuse. Swapped operands are a mistake of their own.
const OPERATORS: &[(Op, &[(Op, &str)])] = &[
    (Op::Add, &[(Op::Subtract, "-")]),
    (Op::Subtract, &[(Op::Add, "+")]),
    (Op::Multiply, &[(Op::Divide, "/")]),
    (Op::Divide, &[(Op::Multiply, "*")]),
    (Op::Modulo, &[(Op::Divide, "/")]),
    (Op::Less, &[(Op::LessEqual, "<="), (Op::Greater, ">")]),
    (Op::LessEqual, &[(Op::Less, "<"), (Op::Greater, ">")]),
    (Op::Greater, &[(Op::GreaterEqual, ">="), (Op::Less, "<")]),
    (Op::GreaterEqual, &[(Op::Greater, ">"), (Op::Less, "<")]),
    (Op::Equal, &[(Op::NotEqual, "!=")]),
    (Op::NotEqual, &[(Op::Equal, "==")]),
    (Op::LogicalAnd, &[(Op::LogicalOr, "||")]),
    (Op::LogicalOr, &[(Op::LogicalAnd, "&&")]),
    (Op::And, &[(Op::InclusiveOr, "|")]),
    (Op::InclusiveOr, &[(Op::And, "&")]),
    (Op::ExclusiveOr, &[(Op::And, "&")]),
    (Op::ShiftLeft, &[(Op::ShiftRight, ">>")]),
    (Op::ShiftRight, &[(Op::ShiftLeft, "<<")]),
];

/// Operators whose operands cannot be swapped, apart from comparisons.
const SIDED: &[Op] = &[Op::Subtract, Op::Divide, Op::Modulo, Op::ShiftLeft, Op::ShiftRight];

/// Built-ins of two arguments that cannot be swapped.
const SIDED_MATH: &[Math] =
    &[Math::Pow, Math::Atan2, Math::Step, Math::Cross, Math::Reflect, Math::Mix, Math::SmoothStep];

/// Built-ins that authors confuse; both take the same arguments.
const BUILT_INS: &[(Math, Math, &str)] = &[
    (Math::Min, Math::Max, "max"),
    (Math::Max, Math::Min, "min"),
    (Math::Sqrt, Math::InverseSqrt, "inverseSqrt"),
    (Math::InverseSqrt, Math::Sqrt, "sqrt"),
    (Math::Sin, Math::Cos, "cos"),
    (Math::Cos, Math::Sin, "sin"),
    (Math::Asin, Math::Acos, "acos"),
    (Math::Acos, Math::Asin, "asin"),
    (Math::Tan, Math::Atan, "atan"),
    (Math::Atan, Math::Tan, "tan"),
    (Math::Exp, Math::Exp2, "exp2"),
    (Math::Exp2, Math::Exp, "exp"),
    (Math::Log, Math::Log2, "log2"),
    (Math::Log2, Math::Log, "log"),
    (Math::Floor, Math::Ceil, "ceil"),
    (Math::Ceil, Math::Floor, "floor"),
    (Math::Round, Math::Floor, "floor"),
    (Math::Trunc, Math::Floor, "floor"),
    (Math::Fract, Math::Floor, "floor"),
];

/// The components of a vector.
const COMPONENTS: [char; 4] = ['x', 'y', 'z', 'w'];

/// Puts the mistake into the function; `false` if the function does not have its site.
pub fn apply_mutation(
    function: &mut Function,
    site: &Site,
    inner: impl Fn(Handle<Expression>) -> Option<TypeInner>,
) -> bool {
    match &site.edit {
        Mutation::Expression { at, with, .. } => replace_expression(function, *at, with.clone()),
        Mutation::Negated { statement, .. } => {
            change_statement(&mut function.body, *statement, &mut |found| {
                if let Statement::If { accept, reject, .. } = found {
                    std::mem::swap(accept, reject);
                }
            })
        }
        Mutation::NoExit { statement, .. } => {
            change_statement(&mut function.body, *statement, &mut |found| {
                if let Statement::If { reject, .. } = found {
                    *found = Statement::Block(std::mem::take(reject));
                }
            })
        }
        Mutation::Decided { statement, holds, .. } => {
            change_statement(&mut function.body, *statement, &mut |found| {
                keep_branch(found, *holds)
            })
        }
        Mutation::Exchanged { statement, first, .. } => {
            change_statement(&mut function.body, *statement, &mut |found| {
                if let Statement::Call { arguments, .. } = found {
                    arguments.swap(*first, *first + 1);
                }
            })
        }
        Mutation::NoStore { statement } => {
            change_statement(&mut function.body, *statement, &mut remove_statement)
        }
        Mutation::Limited(limit) => limit.apply(function),
        Mutation::Argument { statement, result, argument } => {
            let Some(with) = inner(*argument).and_then(|inner| equal_value(&inner, *argument))
            else {
                return false;
            };
            let emit = Statement::Emit(Range::new_from_bounds(*result, *result));
            replace_expression(function, *result, with)
                && change_statement(&mut function.body, *statement, &mut |found| {
                    *found = emit.clone()
                })
        }
    }
}

fn remove_statement(found: &mut Statement) {
    *found = Statement::Block(Block::new());
}

/// Only one branch of an `if` remains.
fn keep_branch(found: &mut Statement, holds: bool) {
    if let Statement::If { accept, reject, .. } = found {
        let kept = if holds { accept } else { reject };
        *found = Statement::Block(std::mem::take(kept));
    }
}

fn replace_expression(function: &mut Function, at: Handle<Expression>, with: Expression) -> bool {
    let there = at.index() < function.expressions.len();
    if there {
        function.expressions[at] = with;
    }
    there
}

/// Applies `edit` to the statement of the number `wanted`, in the order of the text; `false` if
/// there is none.
fn change_statement(
    block: &mut Block,
    wanted: usize,
    edit: &mut dyn FnMut(&mut Statement),
) -> bool {
    let mut left = wanted;
    walk_statements(block, &mut left, edit)
}

fn walk_statements(
    block: &mut Block,
    left: &mut usize,
    edit: &mut dyn FnMut(&mut Statement),
) -> bool {
    for statement in block.iter_mut() {
        if *left == 0 {
            edit(statement);
            return true;
        }
        *left -= 1;
        if inner_blocks_mut(statement).into_iter().any(|inner| walk_statements(inner, left, edit)) {
            return true;
        }
    }
    false
}

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
    pub fn describe(&self, site: &Site) -> String {
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
            Mutation::Limited(limit) => limit.describe(),
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
