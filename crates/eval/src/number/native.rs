//! `f64`: the value of the code as written. `f32`: every operation rounded to nearest.
//! Transcendental functions are computed in f64, since libraries for f32 are less exact.

use super::{Number, half_from, half_to};
use crate::code::{Binary, Compare, Ternary, Unary};
use crate::{Error, FunctionId, Machine};

macro_rules! native {
    ($float:ident, $from_word:expr, $to_word:expr) => {
        impl Number for $float {
            const BOUNDED: bool = false;

            #[inline(always)]
            fn from_word(word: u32) -> Self {
                $from_word(word)
            }

            #[inline(always)]
            fn word(self) -> u32 {
                $to_word(self)
            }

            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                value as $float
            }

            #[inline(always)]
            fn with_error(value: f64, _: f64) -> Self {
                value as $float
            }

            #[inline(always)]
            fn value(self) -> f64 {
                f64::from(self)
            }

            #[inline(always)]
            fn error(self) -> f64 {
                0.0
            }

            #[inline]
            fn unary(op: Unary, x: Self, _: &mut bool) -> Self {
                match op {
                    Unary::Negate => -x,
                    Unary::Abs => x.abs(),
                    Unary::Saturate => x.max(0.0).min(1.0),
                    Unary::Cos => f64::from(x).cos() as $float,
                    Unary::Cosh => f64::from(x).cosh() as $float,
                    Unary::Sin => f64::from(x).sin() as $float,
                    Unary::Sinh => f64::from(x).sinh() as $float,
                    Unary::Tan => f64::from(x).tan() as $float,
                    Unary::Tanh => f64::from(x).tanh() as $float,
                    Unary::Acos => f64::from(x).acos() as $float,
                    Unary::Asin => f64::from(x).asin() as $float,
                    Unary::Atan => f64::from(x).atan() as $float,
                    Unary::Asinh => f64::from(x).asinh() as $float,
                    Unary::Acosh => f64::from(x).acosh() as $float,
                    Unary::Atanh => f64::from(x).atanh() as $float,
                    Unary::Radians => f64::from(x).to_radians() as $float,
                    Unary::Degrees => f64::from(x).to_degrees() as $float,
                    Unary::Ceil => x.ceil(),
                    Unary::Floor => x.floor(),
                    Unary::Round => x.round_ties_even(),
                    Unary::Fract => x - x.floor(),
                    Unary::Trunc => x.trunc(),
                    Unary::Exp => f64::from(x).exp() as $float,
                    Unary::Exp2 => f64::from(x).exp2() as $float,
                    Unary::Log => f64::from(x).ln() as $float,
                    Unary::Log2 => f64::from(x).log2() as $float,
                    Unary::Sign => {
                        [0.0, 1.0, -1.0][usize::from(x > 0.0) + 2 * usize::from(x < 0.0)]
                    }
                    Unary::Sqrt => x.sqrt(),
                    Unary::InverseSqrt => (1.0 / f64::from(x).sqrt()) as $float,
                    Unary::Quantize => half_to(half_from(f64::from(x))) as $float,
                }
            }

            #[inline]
            fn binary(op: Binary, a: Self, b: Self, _: &mut bool) -> Self {
                match op {
                    Binary::Add => a + b,
                    Binary::Subtract => a - b,
                    Binary::Multiply => a * b,
                    Binary::Divide => a / b,
                    Binary::Remainder => a % b,
                    Binary::Min => a.min(b),
                    Binary::Max => a.max(b),
                    Binary::Atan2 => f64::from(a).atan2(f64::from(b)) as $float,
                    // WGSL defines pow by the log2 of the base, which does not exist for a negative
                    // base.
                    Binary::Pow if a < 0.0 => $float::NAN,
                    Binary::Pow => f64::from(a).powf(f64::from(b)) as $float,
                    Binary::Step => [0.0, 1.0][usize::from(a <= b)],
                }
            }

            #[inline]
            fn ternary(op: Ternary, a: Self, b: Self, c: Self, _: &mut bool) -> Self {
                match op {
                    Ternary::Clamp => a.max(b).min(c),
                    Ternary::Fma => a.mul_add(b, c),
                    Ternary::Mix => a * (1.0 - c) + b * c,
                    Ternary::SmoothStep => {
                        let t = ((c - a) / (b - a)).max(0.0).min(1.0);
                        t * t * (3.0 - 2.0 * t)
                    }
                }
            }

            #[inline]
            fn compare(op: Compare, a: Self, b: Self, _: &mut bool) -> bool {
                match op {
                    Compare::Equal => a == b,
                    Compare::NotEqual => a != b,
                    Compare::Less => a < b,
                    Compare::LessEqual => a <= b,
                    Compare::Greater => a > b,
                    Compare::GreaterEqual => a >= b,
                }
            }

            #[inline]
            fn dot(a: &[Self], b: &[Self]) -> Self {
                a.iter().zip(b).map(|(a, b)| a * b).reduce(|sum, term| sum + term).unwrap_or(0.0)
            }

            machine_of_this_crate!();
        }
    };
}

native!(f64, |word: u32| f64::from_bits(u64::from(word)), |slot: f64| slot.to_bits() as u32);
native!(f32, f32::from_bits, f32::to_bits);
