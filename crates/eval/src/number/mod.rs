//! The numbers a program can run on.

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

mod bounded;
mod half;
mod native;

pub use bounded::Bounded;
pub use half::{half_from, half_to};

use super::code::{Binary, Compare, Ternary, Unary};
use super::error::Error;
use super::machine::Machine;
use super::program::FunctionId;

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
    /// The value.
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
