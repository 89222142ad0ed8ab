//! Which mistakes an author makes in a function and in its reference alike.

use naga::{Expression, Function, Handle, MathFunction as Math};

use crate::site::{How, Mutation, Site};

/// What is changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// A guard is left out: a bound, a choice, a branch, an early exit.
    Guard,
    /// The number of a guard: of a bound, or of a comparison.
    Bound,
    /// A guard that the source does not have: results are kept at least 0, or at most 1.
    Added,
    /// Another number.
    Constant,
    /// The order of operands, arguments or components.
    Order,
}

impl Kind {
    pub const ALL: [Self; 5] = [Self::Guard, Self::Bound, Self::Added, Self::Constant, Self::Order];

    pub fn name(self) -> &'static str {
        match self {
            Self::Guard => "guard left out",
            Self::Bound => "number of a guard",
            Self::Added => "guard put in",
            Self::Constant => "other number",
            Self::Order => "order",
        }
    }

    /// Whether the mistake is in a guard.
    pub fn is_of_guard(self) -> bool {
        matches!(self, Self::Guard | Self::Bound | Self::Added)
    }
}

/// The kind of a mistake; `None` for those that nobody would repeat.
pub fn kind_of(function: &Function, site: &Site) -> Option<Kind> {
    match &site.edit {
        Mutation::Expression { at, how, .. } => of_expression(function, *at, *how),
        Mutation::NoExit { .. } | Mutation::Decided { .. } => Some(Kind::Guard),
        Mutation::Limited(_) => Some(Kind::Added),
        Mutation::Exchanged { .. } => Some(Kind::Order),
        Mutation::Negated { .. } | Mutation::NoStore { .. } | Mutation::Argument { .. } => None,
    }
}

fn of_expression(function: &Function, at: Handle<Expression>, how: How) -> Option<Kind> {
    match how {
        How::NoLowerBound | How::NoUpperBound => Some(Kind::Guard),
        How::Kept(operand) => is_guarded(function, at, operand).then_some(Kind::Guard),
        How::Number(_) | How::Whole(_) | How::Flipped => Some(match is_bound(function, at) {
            true => Kind::Bound,
            false => Kind::Constant,
        }),
        How::Swapped => match function.expressions[at] {
            Expression::Select { .. } => None,
            _ => Some(Kind::Order),
        },
        How::Exchanged(..) => Some(Kind::Order),
        How::Operator(_) | How::Function(_) | How::Component(_) => None,
    }
}

/// Whether an operand is what an expression guards, and no bound that is a number.
fn is_guarded(function: &Function, at: Handle<Expression>, operand: Handle<Expression>) -> bool {
    let guards = match function.expressions[at] {
        Expression::Select { .. } => true,
        Expression::Math { fun, .. } => is_guard(fun),
        _ => false,
    };
    guards && !is_number(function, operand)
}

fn is_guard(fun: Math) -> bool {
    matches!(fun, Math::Min | Math::Max | Math::Clamp | Math::Saturate | Math::Abs)
}

/// Whether an expression is a number, or a vector of the same number.
fn is_number(function: &Function, handle: Handle<Expression>) -> bool {
    match function.expressions[handle] {
        Expression::Literal(_) | Expression::Constant(_) => true,
        Expression::Splat { value, .. } => is_number(function, value),
        Expression::Unary { expr, .. } => is_number(function, expr),
        Expression::Compose { ref components, .. } => {
            components.iter().all(|part| is_number(function, *part))
        }
        _ => false,
    }
}

/// Whether a number is the bound of a guard or a side of a comparison.
fn is_bound(function: &Function, number: Handle<Expression>) -> bool {
    let is_it = |handle: Handle<Expression>| {
        handle == number
            || match function.expressions[handle] {
                Expression::Splat { value, .. } => value == number,
                Expression::Unary { expr, .. } => expr == number,
                _ => false,
            }
    };
    function.expressions.iter().any(|(_, expression)| match *expression {
        Expression::Math { fun, arg, arg1, arg2, .. } => {
            is_guard(fun) && [Some(arg), arg1, arg2].into_iter().flatten().any(is_it)
        }
        Expression::Binary { op, left, right } => {
            use naga::BinaryOperator as Op;
            let compares = matches!(
                op,
                Op::Less
                    | Op::LessEqual
                    | Op::Greater
                    | Op::GreaterEqual
                    | Op::Equal
                    | Op::NotEqual
            );
            compares && (is_it(left) || is_it(right))
        }
        Expression::Select { accept, reject, .. } => is_it(accept) || is_it(reject),
        _ => false,
    })
}
