//! The mistakes that can be put into a function, one at a time.

use naga::valid::{FunctionInfo, ModuleInfo};
use naga::{
    BinaryOperator as Op, Block, Expression, Function, Handle, Literal, MathFunction as Math,
    Module, ScalarKind, Span, Statement, TypeInner, UnaryOperator,
};

/// One mistake: where, what, and the place in the composed text.
#[derive(Debug, Clone)]
pub struct Site {
    pub span: Span,
    pub edit: Edit,
}

/// What a mistake changes. Statements are counted in the order of the text, outer ones first.
#[derive(Debug, Clone)]
pub enum Edit {
    /// An expression becomes another over the same operands.
    Expression { at: Handle<Expression>, with: Expression, how: How },
    /// The branches of an `if` are swapped: its condition is negated.
    Negated { statement: usize, condition: Handle<Expression> },
    /// An `if` that leaves the function is removed.
    NoExit { statement: usize, condition: Handle<Expression> },
    /// An assignment is removed.
    NoStore { statement: usize },
    /// A call is replaced by its argument.
    Argument { statement: usize, result: Handle<Expression>, argument: Handle<Expression> },
}

/// How an expression was changed, for a description.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum How {
    Swapped,
    Operator(&'static str),
    /// Only this operand remains.
    Kept(Handle<Expression>),
    NoLowerBound,
    NoUpperBound,
    Number(f32),
    Whole(i64),
    Flipped,
    Function(&'static str),
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

/// The sites of a function of the module.
pub fn mutation_sites(module: &Module, info: &ModuleInfo, handle: Handle<Function>) -> Vec<Site> {
    let function = &module.functions[handle];
    let finder = Finder { module, info: &info[handle], function };
    let mut sites = Vec::new();
    for (at, expression) in function.expressions.iter() {
        let span = function.expressions.get_span(at);
        let changed = finder.expression(expression).into_iter();
        sites.extend(
            changed.map(|(with, how)| Site { span, edit: Edit::Expression { at, with, how } }),
        );
    }
    finder.block(&function.body, &mut 0, &mut sites);
    sites
}

/// A value that equals an operand, to replace another expression: the minimum of the operand and
/// itself.
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

    fn expression(&self, expression: &Expression) -> Changed {
        match *expression {
            Expression::Literal(literal) => wrong_literal(literal).into_iter().collect(),
            Expression::Constant(constant) => {
                match self.module.global_expressions[self.module.constants[constant].init] {
                    Expression::Literal(literal) => wrong_literal(literal).into_iter().collect(),
                    _ => Vec::new(),
                }
            }
            Expression::Binary { op, left, right } => self.binary(op, left, right),
            Expression::Unary { op: UnaryOperator::Negate | UnaryOperator::LogicalNot, expr } => {
                self.kept(expr)
            }
            Expression::Select { condition, accept, reject } => {
                vec![(
                    Expression::Select { condition, accept: reject, reject: accept },
                    How::Swapped,
                )]
            }
            Expression::Math { fun, arg, arg1, arg2, arg3 } => {
                self.math(fun, arg, [arg1, arg2, arg3])
            }
            _ => Vec::new(),
        }
    }

    fn binary(&self, op: Op, left: Handle<Expression>, right: Handle<Expression>) -> Changed {
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
        match fun {
            Math::Clamp => found.extend([
                (two(Math::Min, arg, arg2), How::NoLowerBound),
                (two(Math::Max, arg, arg1), How::NoUpperBound),
            ]),
            Math::Min => found.push((two(Math::Max, arg, arg1), How::Function("max"))),
            Math::Max => found.push((two(Math::Min, arg, arg1), How::Function("min"))),
            _ => {}
        }
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

    /// Whether it is a variable that naga made for `&&` or `
    ///
    /// `. Mistakes in its branches are covered by mistakes in the operator.
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
            Statement::If { condition, accept, .. } => {
                let place = self.function.expressions.get_span(*condition);
                sites.push(Site {
                    span: place,
                    edit: Edit::Negated { statement: at, condition: *condition },
                });
                if matches!(accept.last(), Some(Statement::Return { .. } | Statement::Kill)) {
                    sites.push(Site {
                        span: place,
                        edit: Edit::NoExit { statement: at, condition: *condition },
                    });
                }
            }
            Statement::Store { pointer, .. } if !self.is_unnamed(*pointer) => {
                sites.push(Site { span, edit: Edit::NoStore { statement: at } })
            }
            Statement::Call { arguments, result: Some(result), .. } => {
                let ty = self.ty(*result);
                let argument = arguments.iter().find(|argument| {
                    self.ty(**argument) == ty && equal_value(ty, **argument).is_some()
                });
                sites.extend(argument.map(|argument| Site {
                    span: self.function.expressions.get_span(*result),
                    edit: Edit::Argument { statement: at, result: *result, argument: *argument },
                }));
            }
            _ => {}
        }
    }
}

/// The blocks within a statement, in order.
fn inner_blocks(statement: &Statement) -> Vec<&Block> {
    match statement {
        Statement::Block(block) => vec![block],
        Statement::If { accept, reject, .. } => vec![accept, reject],
        Statement::Switch { cases, .. } => cases.iter().map(|case| &case.body).collect(),
        Statement::Loop { body, continuing, .. } => vec![body, continuing],
        _ => Vec::new(),
    }
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
