//! A number in f32 with the same number in f64 and the bound of its error beside it.

use crate::code::{Binary, Compare, Ternary, Unary};
use crate::number::{Bounded, Number};

/// What a device that rounds to nearest computes, and beside it what the code means and how far a
/// conforming computation may be from that.
///
/// The f32 decides: words, comparisons and addresses are those of a run in f32 alone, bit by bit.
/// So a run on these numbers takes the branches of that run.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Traced {
    single: f32,
    bounded: Bounded,
}

impl Traced {
    /// The value in f32, rounded to nearest after every operation.
    pub fn single(self) -> f32 {
        self.single
    }

    /// The value in f64.
    pub fn exact(self) -> f64 {
        self.bounded.value()
    }

    /// How far a computation that conforms to WGSL may be from [`Self::exact`].
    pub fn bound(self) -> f64 {
        self.bounded.error()
    }
}

impl Number for Traced {
    const BOUNDED: bool = true;

    fn from_word(word: u32) -> Self {
        Self { single: f32::from_word(word), bounded: Bounded::from_word(word) }
    }

    fn word(self) -> u32 {
        self.single.word()
    }

    fn from_f64(value: f64) -> Self {
        Self { single: value as f32, bounded: Bounded::from_f64(value) }
    }

    fn with_error(value: f64, error: f64) -> Self {
        Self { single: value as f32, bounded: Bounded::with_error(value, error) }
    }

    fn value(self) -> f64 {
        f64::from(self.single)
    }

    /// How far the code's meaning may be from the f32.
    fn error(self) -> f64 {
        self.bound() + (self.exact() - self.value()).abs()
    }

    fn unary(op: Unary, x: Self, doubt: &mut bool) -> Self {
        Self {
            single: f32::unary(op, x.single, doubt),
            bounded: Bounded::unary(op, x.bounded, doubt),
        }
    }

    fn binary(op: Binary, a: Self, b: Self, doubt: &mut bool) -> Self {
        Self {
            single: f32::binary(op, a.single, b.single, doubt),
            bounded: Bounded::binary(op, a.bounded, b.bounded, doubt),
        }
    }

    fn ternary(op: Ternary, a: Self, b: Self, c: Self, doubt: &mut bool) -> Self {
        Self {
            single: f32::ternary(op, a.single, b.single, c.single, doubt),
            bounded: Bounded::ternary(op, a.bounded, b.bounded, c.bounded, doubt),
        }
    }

    fn compare(op: Compare, a: Self, b: Self, doubt: &mut bool) -> bool {
        Bounded::compare(op, a.bounded, b.bounded, doubt);
        f32::compare(op, a.single, b.single, doubt)
    }

    fn dot(a: &[Self], b: &[Self]) -> Self {
        let part = |of: &[Self], i: usize| of.get(i).copied().unwrap_or_default();
        let singles = |of: &[Self]| [0, 1, 2, 3].map(|i| part(of, i).single);
        let bounds = |of: &[Self]| [0, 1, 2, 3].map(|i| part(of, i).bounded);
        let n = a.len().min(4);
        Self {
            single: f32::dot(&singles(a)[..n], &singles(b)[..n]),
            bounded: Bounded::dot(&bounds(a)[..n], &bounds(b)[..n]),
        }
    }
}
