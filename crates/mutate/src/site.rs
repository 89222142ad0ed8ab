//! The mistakes that can be put into a function, one at a time.

use naga::valid::{FunctionInfo, ModuleInfo};
use naga::{
    BinaryOperator as Op, Block, Expression, Function, Handle, Literal, MathFunction as Math,
    Module, ScalarKind, Span, Statement, SwizzleComponent, Type, TypeInner, UnaryOperator,
    VectorSize,
};

use super::operators::{BUILT_INS, OPERATORS, SIDED, SIDED_MATH};
use lamplight_emit::blocks::inner_blocks;

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
