//! A value with a bound of its error: what the code means, and how far a conforming f32 computation
//! may be from that.
//!
//! The value is computed in f64. The error is a first-order forward bound. It is the arguments'
//! errors times the slope of the operation, plus the error that WGSL allows for the operation
//! itself (section "Floating Point Accuracy" of its specification).

use super::Number;
use crate::code::{Binary, Compare, Ternary, Unary};
use crate::{Error, FunctionId, Machine};

/// A value, and a bound of the absolute error that a computation of it in f32 may have.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Bounded {
    value: f64,
    error: f64,
}

/// The distance between neighbouring f32 at the value. It also covers a subnormal that is flushed
/// to zero.
fn ulp(value: f64) -> f64 {
    let size = value.abs();
    if size < f64::from(f32::MIN_POSITIVE) {
        return size.max(1e-45);
    }
    f64::from_bits(size.to_bits() & 0x7ff0_0000_0000_0000) * f64::from(f32::EPSILON)
}

/// The error that a correctly rounded operation adds. It is 0 where exact arguments give an exact
/// f32.
fn rounding(value: f64, inherited: f64) -> f64 {
    let exact = inherited == 0.0 && f64::from(value as f32) == value;
    if exact { 0.0 } else { ulp(value) }
}

/// `slope * error`, with 0 * infinity = 0.
fn times(slope: f64, error: f64) -> f64 {
    if slope == 0.0 || error == 0.0 { 0.0 } else { (slope * error).abs() }
}

/// The error of `log(x + sqrt(x*x + c))`, by which WGSL defines the accuracy of asinh and acosh.
/// Its error grows where terms cancel: in the sum for negative x, and under the root of acosh for x
/// near 1.
fn log_of_sum(x: f64, c: f64, value: f64) -> f64 {
    let square = (x * x + c).max(0.0);
    let (root, off) = (square.sqrt(), ulp(x * x) + ulp(square));
    let root_off = times(0.5 / root, off).min(off.sqrt()) + 4.5 * ulp(root);
    let sum = x + root;
    let log_own = if (0.5..=2.0).contains(&sum) { (-21f64).exp2() } else { 3.0 * ulp(value) };
    (root_off + ulp(sum)) / sum + log_own
}

impl Bounded {
    /// Where f32 may overflow, or the value is NaN, any result is allowed, so the error is
    /// infinite.
    fn new(value: f64, error: f64) -> Self {
        let held = value.abs() + error <= f64::from(f32::MAX);
        Self { value, error: if held { error } else { f64::INFINITY } }
    }

    /// Widens the bound of `mix(a, b, c)` to that of `a + (b - a) * c`, which drivers compute too.
    /// Where `c` is 1, that is not always `b`, since the difference is rounded.
    fn or_as_lerp(self, a: Self, b: Self, c: Self, doubt: &mut bool) -> Self {
        let (start, end, share) =
            (Self::exact(a.value), Self::exact(b.value), Self::exact(c.value));
        let span = Self::binary(Binary::Subtract, end, start, doubt);
        let part = Self::binary(Binary::Multiply, span, share, doubt);
        let rounded = Self::binary(Binary::Add, start, part, doubt);
        let inherited = times(1.0 - c.value, a.error)
            + times(c.value, b.error)
            + times(span.value, c.error)
            + times(c.error, a.error + b.error);
        let error = inherited + rounded.error + (rounded.value - self.value).abs();
        Self::new(self.value, self.error.max(error))
    }

    fn exact(value: f64) -> Self {
        Self { value, error: 0.0 }
    }

    /// The result of a correctly rounded operation, with an inherited error.
    fn rounded(value: f64, inherited: f64) -> Self {
        Self::new(value, inherited + rounding(value, inherited))
    }

    /// A piecewise constant function, such as `floor`. Its error is 0 where the argument's error
    /// does not reach a jump.
    fn stepped(op: Unary, x: Self, doubt: &mut bool) -> Self {
        let mut unused = false;
        let [low, value, high] =
            [x.value - x.error, x.value, x.value + x.error].map(|x| f64::unary(op, x, &mut unused));
        *doubt |= low != high;
        Self::new(
            value,
            if low == high { 0.0 } else { (high - value).abs().max((value - low).abs()) },
        )
    }

    /// The error of a smooth function: its slope times the argument's error, plus the operation's
    /// own.
    fn smooth(op: Unary, x: Self, value: f64) -> f64 {
        let v = x.value;
        let log_own =
            |value: f64| if (0.5..=2.0).contains(&v) { (-21f64).exp2() } else { 3.0 * ulp(value) };
        match op {
            Unary::Exp => times(value, x.error) + (3.0 + 2.0 * v.abs()) * ulp(value),
            Unary::Exp2 => {
                times(value * std::f64::consts::LN_2, x.error) + (3.0 + 2.0 * v.abs()) * ulp(value)
            }
            Unary::Log => times(1.0 / v, x.error) + log_own(value),
            Unary::Log2 => times(std::f64::consts::LOG2_E / v, x.error) + log_own(value),
            // As 1 / inverseSqrt(x). At 0 the slope is infinite, and the root of the error bounds
            // the result.
            Unary::Sqrt => {
                times(0.5 / value, x.error).min(x.error.sqrt())
                    + if v == 0.0 { 0.0 } else { 4.5 * ulp(value) }
            }
            Unary::InverseSqrt => times(0.5 * value / v, x.error) + 2.0 * ulp(value),
            Unary::Quantize => x.error + value.abs().max(6.2e-5) * (-11f64).exp2(),
            Unary::Radians => times(std::f64::consts::PI / 180.0, x.error) + 2.0 * ulp(value),
            Unary::Degrees => times(180.0 / std::f64::consts::PI, x.error) + 2.0 * ulp(value),
            _ => Self::trigonometric(op, x, value),
        }
    }

    /// The same for trigonometric and hyperbolic functions and their inverses.
    fn trigonometric(op: Unary, x: Self, value: f64) -> f64 {
        let v = x.value;
        // WGSL gives no bound outside [-pi, pi].
        let turn = if v.abs() <= std::f64::consts::PI * (1.0 + 1e-6) {
            (-11f64).exp2()
        } else {
            f64::INFINITY
        };
        let exp_relative = (4.0 + 2.0 * v.abs()) * f64::from(f32::EPSILON);
        let root = || (1.0 - v * v).max(0.0).sqrt();
        match op {
            Unary::Cos => times(v.sin(), x.error) + turn,
            Unary::Sin => times(v.cos(), x.error) + turn,
            Unary::Tan => {
                times(1.0 + value * value, x.error)
                    + turn * (1.0 + value.abs()) / v.cos().abs()
                    + 2.5 * ulp(value)
            }
            Unary::Cosh => times(v.sinh(), x.error) + exp_relative * v.cosh() + 2.0 * ulp(value),
            Unary::Sinh => times(v.cosh(), x.error) + exp_relative * v.cosh() + 2.0 * ulp(value),
            Unary::Tanh => {
                times(1.0 - value * value, x.error) + 2.0 * exp_relative + 4.0 * ulp(value)
            }
            Unary::Acos | Unary::Asin => {
                times(1.0 / root(), x.error).min(2.0 * x.error.sqrt())
                    + 6.81e-5
                    + 4096.0 * ulp(value)
            }
            Unary::Atan => times(1.0 / (1.0 + v * v), x.error) + 4096.0 * ulp(value),
            Unary::Asinh => times(1.0 / (v * v + 1.0).sqrt(), x.error) + log_of_sum(v, 1.0, value),
            Unary::Acosh => {
                times(1.0 / (v * v - 1.0).max(0.0).sqrt(), x.error).min(2.0 * x.error.sqrt())
                    + log_of_sum(v, -1.0, value)
            }
            Unary::Atanh => {
                times(1.0 / (1.0 - v * v).max(0.0), x.error) + (-20f64).exp2() + 4.0 * ulp(value)
            }
            _ => x.error,
        }
    }

    fn extreme(a: Self, b: Self, pick_a: bool) -> Self {
        let chosen = if pick_a { a } else { b };
        let near = (a.value - b.value).abs() <= a.error + b.error;
        Self::new(chosen.value, if near { a.error.max(b.error) } else { chosen.error })
    }

    fn divided(a: Self, b: Self) -> Self {
        let value = a.value / b.value;
        let room = b.value.abs() - b.error;
        let inherited =
            if room > 0.0 { (a.error + times(value, b.error)) / room } else { f64::INFINITY };
        Self::new(
            value,
            inherited + if a.value == 0.0 && a.error == 0.0 { 0.0 } else { 2.5 * ulp(value) },
        )
    }

    /// As `exp2(y * log2(x))`, with the relative error `ln2 (2^-21 |y| + ...) + (3 + 2|t|) u` where
    /// `t = y log2 x`, and `u` is the machine epsilon of f32.
    fn raised(x: Self, y: Self, doubt: &mut bool) -> Self {
        let value = f64::binary(Binary::Pow, x.value, y.value, doubt);
        if x.value <= 0.0 {
            return Self::new(
                value,
                if y.value > 0.0 { x.error.powf(y.value) } else { f64::INFINITY },
            );
        }
        let unit = f64::from(f32::EPSILON);
        let log = x.value.log2();
        let log_own = if (0.5..=2.0).contains(&x.value) { (-21f64).exp2() } else { 3.0 * ulp(log) };
        let log_error = log_own + times(std::f64::consts::LOG2_E / x.value, x.error);
        let exponent = y.value * log;
        let exponent_error =
            times(y.value, log_error) + times(log, y.error) + exponent.abs() * unit;
        let relative = (exponent_error * std::f64::consts::LN_2).exp_m1()
            + (3.0 + 2.0 * exponent.abs()) * unit;
        let error =
            times(value, relative) + if value < f64::from(f32::MIN_POSITIVE) { value } else { 0.0 };
        // Where the base is almost exact, the first-order bound is enough: the terms of higher
        // order are below the rounding.
        let is_coarse = x.error > x.value / 4096.0 && y.value > y.error;
        Self::new(value, if is_coarse { Self::raised_range(x, y, value) } else { error })
    }

    /// The error of a power with a positive exponent. The power grows with the base, so it is
    /// between the powers of the least and the largest base.
    ///
    /// The rounding error of the largest power also bounds that of the smaller ones. With `t` for
    /// `y log2 x`, its parts are proportional to `2^t` and to `|t| 2^t`. For negative `t`, the
    /// second is largest at `t = -1/ln2`. So `span`, which stands for `|t|`, is at least `1/ln2`.
    fn raised_range(x: Self, y: Self, value: f64) -> f64 {
        let unit = f64::from(f32::EPSILON);
        let least = (x.value - x.error).max(0.0).powf(y.value);
        let exponent = y.value * (x.value + x.error).log2();
        let (largest, span) = (exponent.exp2(), exponent.abs().max(std::f64::consts::LOG2_E));
        let exponent_error =
            y.value * (-21f64).exp2() + 4.0 * span * unit + span * y.error / y.value;
        let relative =
            (exponent_error * std::f64::consts::LN_2).exp_m1() + (3.0 + 2.0 * span) * unit;
        let farthest = (value - least).max(largest - value);
        farthest + largest * relative + f64::from(f32::MIN_POSITIVE)
    }

    fn remainder(a: Self, b: Self, doubt: &mut bool) -> Self {
        let quotient = Self::stepped(Unary::Trunc, Self::divided(a, b), doubt);
        let value = a.value % b.value;
        Self::rounded(
            value,
            a.error
                + times(quotient.value, b.error)
                + times(b.value, quotient.error)
                + ulp(a.value),
        )
    }
}

impl Number for Bounded {
    const BOUNDED: bool = true;

    fn from_word(word: u32) -> Self {
        Self::exact(f64::from_word(word))
    }

    fn word(self) -> u32 {
        self.value.word()
    }

    fn from_f64(value: f64) -> Self {
        Self::exact(value)
    }

    fn with_error(value: f64, error: f64) -> Self {
        Self::new(value, error)
    }

    fn value(self) -> f64 {
        self.value
    }

    fn error(self) -> f64 {
        self.error
    }

    fn unary(op: Unary, x: Self, doubt: &mut bool) -> Self {
        match op {
            Unary::Negate => Self::new(-x.value, x.error),
            Unary::Saturate => {
                Self::ternary(Ternary::Clamp, x, Self::exact(0.0), Self::exact(1.0), doubt)
            }
            Unary::Ceil | Unary::Floor | Unary::Round | Unary::Trunc | Unary::Sign => {
                Self::stepped(op, x, doubt)
            }
            Unary::Fract => {
                Self::binary(Binary::Subtract, x, Self::stepped(Unary::Floor, x, doubt), doubt)
            }
            _ => {
                let value = f64::unary(op, x.value, doubt);
                Self::new(value, Self::smooth(op, x, value))
            }
        }
    }

    fn binary(op: Binary, a: Self, b: Self, doubt: &mut bool) -> Self {
        let value = f64::binary(op, a.value, b.value, doubt);
        match op {
            Binary::Add | Binary::Subtract => Self::rounded(value, a.error + b.error),
            Binary::Multiply => Self::rounded(
                value,
                times(a.value, b.error) + times(b.value, a.error) + times(a.error, b.error),
            ),
            Binary::Divide => Self::divided(a, b),
            Binary::Remainder => Self::remainder(a, b, doubt),
            Binary::Min => Self::extreme(a, b, value == a.value),
            Binary::Max => Self::extreme(a, b, value == a.value),
            Binary::Atan2 => {
                let square = a.value * a.value + b.value * b.value;
                Self::new(
                    value,
                    (times(b.value, a.error) + times(a.value, b.error)) / square
                        + 4096.0 * ulp(value),
                )
            }
            Binary::Pow => Self::raised(a, b, doubt),
            Binary::Step => {
                let near =
                    (a.value - b.value).abs() <= a.error + b.error && a.error + b.error > 0.0;
                *doubt |= near;
                Self::new(value, f64::from(u8::from(near)))
            }
        }
    }

    fn ternary(op: Ternary, a: Self, b: Self, c: Self, doubt: &mut bool) -> Self {
        let one = Self::exact(1.0);
        match op {
            Ternary::Clamp => {
                Self::binary(Binary::Min, Self::binary(Binary::Max, a, b, doubt), c, doubt)
            }
            // The product may be rounded or not, since the operation may be fused or not.
            Ternary::Fma => {
                Self::binary(Binary::Add, Self::binary(Binary::Multiply, a, b, doubt), c, doubt)
            }
            Ternary::Mix => {
                let rest = Self::binary(Binary::Subtract, one, c, doubt);
                let first = Self::binary(Binary::Multiply, a, rest, doubt);
                let second = Self::binary(Binary::Multiply, b, c, doubt);
                Self::binary(Binary::Add, first, second, doubt).or_as_lerp(a, b, c, doubt)
            }
            Ternary::SmoothStep => {
                let numerator = Self::binary(Binary::Subtract, c, a, doubt);
                let share = Self::divided(numerator, Self::binary(Binary::Subtract, b, a, doubt));
                smooth_cubic(Self::unary(Unary::Saturate, share, doubt))
            }
        }
    }

    fn compare(op: Compare, a: Self, b: Self, doubt: &mut bool) -> bool {
        let error = a.error + b.error;
        *doubt |= error > 0.0 && (a.value - b.value).abs() <= error;
        f64::compare(op, a.value, b.value, doubt)
    }

    /// For any order of summing, fused or not: each of the n roundings is at most one ULP of the
    /// sum of the absolute products.
    fn dot(a: &[Self], b: &[Self]) -> Self {
        let mut sum = (0.0, 0.0, 0.0);
        for (a, b) in a.iter().zip(b) {
            let product = a.value * b.value;
            let inherited =
                times(a.value, b.error) + times(b.value, a.error) + times(a.error, b.error);
            sum = (sum.0 + product, sum.1 + product.abs(), sum.2 + inherited);
        }
        let exact = sum.2 == 0.0
            && sum.0.abs() == sum.1
            && f64::from(sum.0 as f32) == sum.0
            && a.len() == 1;
        Self::new(
            sum.0,
            sum.2 + if exact || sum.1 == 0.0 { 0.0 } else { a.len() as f64 * ulp(sum.1) },
        )
    }

    machine_of_this_crate!();
}

/// `t * t * (3 - 2t)`, whose slope is at most 1.5, with four roundings.
fn smooth_cubic(t: Bounded) -> Bounded {
    let slope = (6.0 * t.value * (1.0 - t.value)).abs() + 3.0 * t.error;
    let value = t.value * t.value * (3.0 - 2.0 * t.value);
    Bounded::new(
        value,
        times(slope, t.error)
            + if t.error == 0.0 && value.fract() == 0.0 { 0.0 } else { 4.0 * ulp(value) },
    )
}
