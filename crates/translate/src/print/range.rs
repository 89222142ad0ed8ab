//! What is known of the values of numbers: whether a guard can be left out.

use std::collections::BTreeMap;

use crate::tree::Unary;
use crate::tree::{Binary, Callee, Expression, ExpressionKind, Meaning, NumberValue, Scalar, Type};

/// The least and the largest value of a number, as far as they are known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    pub least: f64,
    pub most: f64,
}

impl Range {
    /// The range of what is in either.
    fn union(self, other: Self) -> Self {
        Self { least: self.least.min(other.least), most: self.most.max(other.most) }
    }
}

/// What is known of locals: of variables of loops that count up, and of values that never change.
pub type Counters = BTreeMap<u32, Range>;

/// The range of a variable that counts up from zero or more, below a bound.
pub const COUNTER: Range = Range { least: 0.0, most: 2_147_483_646.0 };

/// The range of a number.
pub fn range_of(value: &Expression, counters: &Counters) -> Range {
    let all = whole_range(&value.ty);
    let found = known_range(value, counters).unwrap_or(all);
    // What wraps around may be anything.
    match (value.ty.scalar(), found.least >= all.least && found.most <= all.most) {
        (Some(Scalar::F32), _) | (_, true) => found,
        _ => all,
    }
}

/// Whether one number is surely at most another one.
pub fn is_at_most(low: &Expression, high: &Expression, counters: &Counters) -> bool {
    let of = |value: &Expression| range_of(value, counters);
    if of(low).most <= of(high).least {
        return true;
    }
    // `x - a` and `x + b`, which cannot wrap around.
    match (&low.bare().kind, &high.bare().kind) {
        (
            ExpressionKind::Binary { operator: Binary::Subtract, left, right: below, .. },
            ExpressionKind::Binary { operator: Binary::Add, left: other, right: above, .. },
        ) => {
            let is_same = matches!(
                (&left.bare().kind, &other.bare().kind),
                (ExpressionKind::Name(_, one), ExpressionKind::Name(_, two)) if one == two
            );
            let is_natural = of(below).least >= 0.0 && of(above).least >= 0.0;
            is_same && is_natural && low.ty.scalar() == Some(Scalar::F32)
        }
        _ => false,
    }
}

fn whole_range(ty: &Type) -> Range {
    let (least, most) = match ty.scalar() {
        Some(Scalar::U32) => (0.0, f64::from(u32::MAX)),
        Some(Scalar::I32) => (f64::from(i32::MIN), f64::from(i32::MAX)),
        _ => (f64::NEG_INFINITY, f64::INFINITY),
    };
    Range { least, most }
}

fn known_range(value: &Expression, counters: &Counters) -> Option<Range> {
    let of = |one: &Expression| range_of(one, counters);
    match &value.kind {
        ExpressionKind::Number(number) => {
            let number = match number.value {
                NumberValue::Integer(value) => value as f64,
                NumberValue::Float(value) => value,
            };
            Some(Range { least: number, most: number })
        }
        ExpressionKind::Name(_, Meaning::Local(numbers)) => {
            let ranges: Option<Vec<Range>> =
                numbers.iter().map(|number| counters.get(number).copied()).collect();
            ranges?.into_iter().reduce(Range::union)
        }
        ExpressionKind::Parenthesised(inner) => Some(of(inner)),
        ExpressionKind::Unary(Unary::Negate, inner) => {
            let Range { least, most } = of(inner);
            Some(Range { least: -most, most: -least })
        }
        ExpressionKind::Binary { operator, left, right, .. } => {
            binary_range(*operator, of(left), of(right), value.ty.scalar())
        }
        ExpressionKind::Member(object, _) if matches!(object.ty, Type::Vector(..)) => {
            Some(of(object))
        }
        ExpressionKind::Call { callee: Callee::Construct(ty), arguments, .. } => {
            construct_range(ty, arguments.iter().map(|argument| &argument.value), counters)
        }
        ExpressionKind::Call { callee: Callee::Builtin(name), arguments, .. } => {
            let ranges: Vec<Range> = arguments.iter().map(|one| of(&one.value)).collect();
            function_range(name, &ranges)
        }
        _ => None,
    }
}

fn construct_range<'a>(
    ty: &Type,
    arguments: impl Iterator<Item = &'a Expression>,
    counters: &Counters,
) -> Option<Range> {
    let ranges: Vec<Range> = arguments.map(|one| range_of(one, counters)).collect();
    let whole = whole_range(ty);
    match ty {
        // Numbers beyond the range become its ends, or wrap around.
        Type::Scalar(_) => {
            let range = ranges.first()?;
            let fits = range.least >= whole.least && range.most <= whole.most;
            fits.then_some(*range)
        }
        Type::Vector(..) if !ranges.is_empty() => {
            let least = ranges.iter().map(|one| one.least).fold(f64::INFINITY, f64::min);
            let most = ranges.iter().map(|one| one.most).fold(f64::NEG_INFINITY, f64::max);
            Some(Range { least, most })
        }
        _ => None,
    }
}

fn binary_range(
    operator: Binary,
    left: Range,
    right: Range,
    scalar: Option<Scalar>,
) -> Option<Range> {
    let is_natural = left.least >= 0.0 && right.least >= 0.0;
    let is_integer = matches!(scalar, Some(Scalar::I32 | Scalar::U32));
    match operator {
        Binary::Add => {
            Some(Range { least: left.least + right.least, most: left.most + right.most })
        }
        Binary::Subtract => {
            Some(Range { least: left.least - right.most, most: left.most - right.least })
        }
        Binary::Multiply if is_natural => {
            Some(Range { least: left.least * right.least, most: left.most * right.most })
        }
        Binary::BitAnd if is_natural => Some(Range { least: 0.0, most: left.most.min(right.most) }),
        Binary::ShiftRight if is_natural && is_integer && right.most < 32.0 => {
            Some(Range { least: 0.0, most: (left.most / 2.0_f64.powf(right.least)).floor() })
        }
        Binary::Divide if is_natural && is_integer => Some(Range { least: 0.0, most: left.most }),
        Binary::Remainder if is_natural && is_integer && right.least > 0.0 => {
            Some(Range { least: 0.0, most: left.most.min(right.most - 1.0) })
        }
        _ => None,
    }
}

fn function_range(name: &str, ranges: &[Range]) -> Option<Range> {
    match (name, ranges) {
        // The lower one of the bounds is the last word if they are the wrong way round.
        ("clamp", [value, low, high]) => Some(Range {
            least: value.least.max(low.least).min(high.least),
            most: value.most.max(low.most).min(high.most),
        }),
        ("min", [left, right]) => {
            Some(Range { least: left.least.min(right.least), most: left.most.min(right.most) })
        }
        ("max", [left, right]) => {
            Some(Range { least: left.least.max(right.least), most: left.most.max(right.most) })
        }
        ("saturate" | "fract", [_]) => Some(Range { least: 0.0, most: 1.0 }),
        ("floor" | "ceil" | "round" | "trunc", [value]) => {
            Some(Range { least: value.least.floor(), most: value.most.ceil() })
        }
        _ => None,
    }
}
