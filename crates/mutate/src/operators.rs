//! What authors confuse: operators, built-in functions, and operands that may not be swapped.

use naga::{BinaryOperator as Op, MathFunction as Math};

/// Operators that authors confuse. Swapped operands are a mistake of their own.
pub const OPERATORS: &[(Op, &[(Op, &str)])] = &[
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
pub const SIDED: &[Op] = &[Op::Subtract, Op::Divide, Op::Modulo, Op::ShiftLeft, Op::ShiftRight];

/// Built-ins of two arguments that cannot be swapped.
pub const SIDED_MATH: &[Math] =
    &[Math::Pow, Math::Atan2, Math::Step, Math::Cross, Math::Reflect, Math::Mix, Math::SmoothStep];

/// Built-ins that authors confuse; both take the same arguments.
pub const BUILT_INS: &[(Math, Math, &str)] = &[
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
pub const COMPONENTS: [char; 4] = ['x', 'y', 'z', 'w'];
