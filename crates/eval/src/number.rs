//! The numbers a program can run on.
//!
//! `f64` is the value of the code as written. In `f32`, every operation is rounded to nearest.
//! Transcendental functions are computed in f64, since libraries for f32 are less exact.
//!
//! [`Bounded`] is a value with a bound of its error: what the code means, and how far a conforming
//! f32 computation may be from that. The value is computed in f64. The error is a first-order forward
//! bound. It is the arguments' errors times the slope of the operation, plus the error that WGSL
//! allows for the operation itself (section "Floating Point Accuracy" of its specification).

use crate::code::{Binary, Compare, Ternary, Unary};
use crate::error::Error;
use crate::machine::Machine;
use crate::program::FunctionId;

/// Writes `run_call` and `run_quad` into the trait, and again into the implementations for which the
/// machine is to be compiled with this crate. What only the trait has is compiled with each crate that
/// calls it, which may be optimised less.
macro_rules! machine_of_this_crate {
    () => {
        /// [`Machine::call`] without its result.
        ///
        /// # Errors
        /// Those of [`Machine::call`].
        fn run_call(
            machine: &mut Machine<'_, Self>,
            id: FunctionId,
            arguments: &[Self],
        ) -> Result<(), Error> {
            machine.run_call(id, arguments)
        }

        /// [`Machine::quad`].
        ///
        /// # Errors
        /// Those of [`Machine::quad`].
        fn run_quad(
            machine: &mut Machine<'_, Self>,
            id: FunctionId,
            arguments: [&[Self]; 4],
        ) -> Result<[Vec<Self>; 4], Error> {
            machine.run_quad(id, arguments)
        }
    };
}

/// A slot of the memory. It holds a number of the shader's type `f32`, or the 32-bit word of an
/// integer or a boolean; the instructions know which.
///
/// `doubt` is set where the arguments of a discontinuous function are closer to a jump than their
/// errors, so that the results on both sides of the jump are allowed.
pub trait Number: Copy + Default + Send + Sync + std::fmt::Debug + 'static {
    /// Whether numbers of this kind have errors.
    const BOUNDED: bool;
    /// A slot with a word. `from_word(0)` is the default.
    fn from_word(word: u32) -> Self;
    /// The word in the slot.
    fn word(self) -> u32;
    /// Nearest number, without error.
    fn from_f64(value: f64) -> Self;
    /// A number that is known to within `error`. Kinds without errors drop it.
    fn with_error(value: f64, error: f64) -> Self;
    fn value(self) -> f64;
    /// The bound of the absolute error; 0 for kinds without errors.
    fn error(self) -> f64;
    /// Applies a function of one argument.
    fn unary(op: Unary, x: Self, doubt: &mut bool) -> Self;
    /// Applies a function of two arguments.
    fn binary(op: Binary, a: Self, b: Self, doubt: &mut bool) -> Self;
    /// Applies a function of three arguments.
    fn ternary(op: Ternary, a: Self, b: Self, c: Self, doubt: &mut bool) -> Self;
    /// Compares; false where a side is NaN, except for `!=`.
    fn compare(op: Compare, a: Self, b: Self, doubt: &mut bool) -> bool;
    /// The sum of products of two slices of the same length.
    fn dot(a: &[Self], b: &[Self]) -> Self;

    machine_of_this_crate!();

    /// The bits as `f32`. All NaNs have the same bits.
    fn bits(self) -> u32 {
        let value = self.value() as f32;
        if value.is_nan() { f32::NAN.to_bits() } else { value.to_bits() }
    }

    /// Truncated towards zero and clamped to the range of `i32`; 0 for NaN.
    fn to_i32(self, doubt: &mut bool) -> i32 {
        clamped(Self::unary(Unary::Trunc, self, doubt).value(), 2147483520.0) as i32
    }

    /// Truncated towards zero and clamped to the range of `u32`; 0 for NaN.
    fn to_u32(self, doubt: &mut bool) -> u32 {
        clamped(Self::unary(Unary::Trunc, self, doubt).value(), 4294967040.0) as u32
    }
}

/// A number, or the largest one of `f32` that the integer type has. WGSL clamps to this, since the
/// type's own largest number has no f32. NaN stays.
fn clamped(value: f64, largest: f64) -> f64 {
    if value > largest { largest } else { value }
}

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

/// The bits of the nearest half, ties to even. A value that is too large becomes infinity.
pub fn half_from(value: f64) -> u16 {
    let sign = if value.is_sign_negative() { 0x8000 } else { 0 };
    let size = value.abs();
    if value.is_nan() {
        return 0x7e00;
    }
    if size >= 65520.0 {
        return sign | 0x7c00;
    }
    let exponent = (((size.to_bits() >> 52) as i32) - 1023).max(-14);
    let mantissa = (size * f64::from(10 - exponent).exp2()).round_ties_even() as u16;
    // The leading one of the mantissa's 11 bits is added to the exponent field.
    sign | ((((exponent + 14) as u16) << 10) + mantissa)
}

/// The value of a half's bits.
pub fn half_to(bits: u16) -> f64 {
    let sign = if bits & 0x8000 == 0 { 1.0 } else { -1.0 };
    let exponent = i32::from(bits >> 10 & 0x1f);
    let mantissa = f64::from(bits & 0x3ff);
    match exponent {
        0 => sign * mantissa * (-24f64).exp2(),
        31 if mantissa == 0.0 => sign * f64::INFINITY,
        31 => f64::NAN,
        _ => sign * (1024.0 + mantissa) * f64::from(exponent - 25).exp2(),
    }
}
