//! Dual numbers: a value with its derivatives by some seeds.

use crate::code::{Binary, Compare, Ternary, Unary};
use crate::number::Number;

/// How many derivatives a [`Dual`] carries.
pub const DUAL_SEEDS: usize = 8;

/// A value in f32 with its derivatives by [`DUAL_SEEDS`] seeds. Integers, comparisons and textures
/// have none: theirs are 0.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Dual {
    value: f32,
    slopes: [f64; DUAL_SEEDS],
}

impl Dual {
    /// The derivatives by the seeds.
    pub fn slopes(self) -> [f64; DUAL_SEEDS] {
        self.slopes
    }

    /// The same value, which grows with a seed by `slope` more than it did.
    pub fn seeded(mut self, seed: usize, slope: f64) -> Self {
        if let Some(own) = self.slopes.get_mut(seed) {
            *own += slope;
        }
        self
    }

    /// A value whose derivative is a sum of those of others, each times a factor. A factor of 0
    /// takes nothing, also where the other has no finite derivative.
    fn of<const COUNT: usize>(value: f32, parts: [(f64, Self); COUNT]) -> Self {
        let mut slopes = [0.0; DUAL_SEEDS];
        for (factor, part) in parts.into_iter().filter(|(factor, _)| *factor != 0.0) {
            for (slope, own) in slopes.iter_mut().zip(part.slopes) {
                if own != 0.0 {
                    *slope += factor * own;
                }
            }
        }
        Self { value, slopes }
    }

    fn one() -> Self {
        Self { value: 1.0, ..Self::default() }
    }
}

/// The derivative of a function of one argument; 0 for those that are constant between jumps.
fn slope(op: Unary, x: f64) -> f64 {
    match op {
        Unary::Negate => -1.0,
        Unary::Abs => x.signum(),
        Unary::Saturate => f64::from(u8::from((0.0..=1.0).contains(&x))),
        Unary::Cos => -x.sin(),
        Unary::Cosh => x.sinh(),
        Unary::Sin => x.cos(),
        Unary::Sinh => x.cosh(),
        Unary::Tan => 1.0 + x.tan().powi(2),
        Unary::Tanh => 1.0 - x.tanh().powi(2),
        Unary::Acos => -1.0 / (1.0 - x * x).sqrt(),
        Unary::Asin => 1.0 / (1.0 - x * x).sqrt(),
        Unary::Atan => 1.0 / (1.0 + x * x),
        Unary::Asinh => 1.0 / (x * x + 1.0).sqrt(),
        Unary::Acosh => 1.0 / (x * x - 1.0).sqrt(),
        Unary::Atanh => 1.0 / (1.0 - x * x),
        Unary::Radians => 1f64.to_radians(),
        Unary::Degrees => 1f64.to_degrees(),
        Unary::Ceil | Unary::Floor | Unary::Round | Unary::Trunc | Unary::Sign => 0.0,
        Unary::Fract | Unary::Quantize => 1.0,
        Unary::Exp => x.exp(),
        Unary::Exp2 => x.exp2() * std::f64::consts::LN_2,
        Unary::Log => 1.0 / x,
        Unary::Log2 => std::f64::consts::LOG2_E / x,
        Unary::Sqrt => 0.5 / x.sqrt(),
        Unary::InverseSqrt => -0.5 / (x * x.sqrt()),
    }
}

impl Number for Dual {
    const BOUNDED: bool = false;

    fn from_word(word: u32) -> Self {
        Self { value: f32::from_word(word), ..Self::default() }
    }

    fn word(self) -> u32 {
        self.value.word()
    }

    fn from_f64(value: f64) -> Self {
        Self { value: value as f32, ..Self::default() }
    }

    fn with_error(value: f64, _: f64) -> Self {
        Self::from_f64(value)
    }

    fn value(self) -> f64 {
        f64::from(self.value)
    }

    fn error(self) -> f64 {
        0.0
    }

    fn unary(op: Unary, x: Self, doubt: &mut bool) -> Self {
        Self::of(f32::unary(op, x.value, doubt), [(slope(op, x.value()), x)])
    }

    fn binary(op: Binary, a: Self, b: Self, doubt: &mut bool) -> Self {
        let value = f32::binary(op, a.value, b.value, doubt);
        let (x, y) = (a.value(), b.value());
        let chosen = |is_a: bool| [f64::from(u8::from(is_a)), f64::from(u8::from(!is_a))];
        let [along_a, along_b] = match op {
            Binary::Add => [1.0, 1.0],
            Binary::Subtract => [1.0, -1.0],
            Binary::Multiply => [y, x],
            Binary::Divide => [1.0 / y, -x / (y * y)],
            Binary::Remainder => [1.0, -(x / y).trunc()],
            Binary::Min => chosen(x <= y),
            Binary::Max => chosen(x >= y),
            Binary::Atan2 => [y / (x * x + y * y), -x / (x * x + y * y)],
            Binary::Pow => [y * x.powf(y - 1.0), x.powf(y) * x.ln()],
            Binary::Step => [0.0, 0.0],
        };
        Self::of(value, [(along_a, a), (along_b, b)])
    }

    fn ternary(op: Ternary, a: Self, b: Self, c: Self, doubt: &mut bool) -> Self {
        let value = f32::ternary(op, a.value, b.value, c.value, doubt);
        let mut apply = |op, a, b| Self::binary(op, a, b, doubt);
        let result = match op {
            Ternary::Clamp => {
                let low = apply(Binary::Max, a, b);
                apply(Binary::Min, low, c)
            }
            Ternary::Fma => {
                let product = apply(Binary::Multiply, a, b);
                apply(Binary::Add, product, c)
            }
            Ternary::Mix => {
                let rest = apply(Binary::Subtract, Self::one(), c);
                let (first, second) =
                    (apply(Binary::Multiply, a, rest), apply(Binary::Multiply, b, c));
                apply(Binary::Add, first, second)
            }
            Ternary::SmoothStep => {
                let (above, span) = (apply(Binary::Subtract, c, a), apply(Binary::Subtract, b, a));
                let share = apply(Binary::Divide, above, span);
                let share = Self::unary(Unary::Saturate, share, doubt);
                let t = share.value();
                Self::of(share.value, [(6.0 * t * (1.0 - t), share)])
            }
        };
        Self { value, ..result }
    }

    fn compare(op: Compare, a: Self, b: Self, doubt: &mut bool) -> bool {
        f32::compare(op, a.value, b.value, doubt)
    }

    fn dot(a: &[Self], b: &[Self]) -> Self {
        let products =
            a.iter().zip(b).map(|(a, b)| Self::binary(Binary::Multiply, *a, *b, &mut false));
        products
            .reduce(|sum, term| Self::binary(Binary::Add, sum, term, &mut false))
            .unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Derivatives of products, quotients, powers and of functions of one argument, by hand.
    #[test]
    fn derivatives() {
        let x = Dual::from_f64(2.0).seeded(0, 1.0);
        let y = Dual::from_f64(4.0).seeded(1, 1.0);
        let by = |result: Dual| [result.slopes()[0], result.slopes()[1]];
        let binary = |op| by(Dual::binary(op, x, y, &mut false));
        assert_eq!(binary(Binary::Multiply), [4.0, 2.0]);
        assert_eq!(binary(Binary::Divide), [0.25, -0.125]);
        assert_eq!(binary(Binary::Max), [0.0, 1.0]);
        let [by_base, by_exponent] = binary(Binary::Pow);
        assert_eq!(by_base, 32.0);
        assert!((by_exponent - 16.0 * 2f64.ln()).abs() < 1e-12);
        assert_eq!(by(Dual::unary(Unary::Sqrt, y, &mut false)), [0.0, 0.25]);
        assert_eq!(by(Dual::dot(&[x, x], &[x, y])), [8.0, 2.0]);
        let half = Dual::from_f64(0.5);
        assert_eq!(by(Dual::ternary(Ternary::Mix, x, y, half, &mut false)), [0.5, 0.5]);
        // (2 - 0) / (4 - 0) = 0.5, where the slope of the cubic is 1.5.
        let smooth = Dual::ternary(Ternary::SmoothStep, Dual::default(), y, x, &mut false);
        assert_eq!(by(smooth), [1.5 * 0.25, -1.5 * 0.125]);
    }
}
