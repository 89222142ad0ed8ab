//! Built-ins that pack vectors into words.

use super::super::code::{Packing, Unary};
use super::super::number::{Number, half_from, half_to};

/// Packs the vector at `from`, or unpacks the word there.
pub fn pack<N: Number>(m: &mut [N], op: Packing, to: u32, from: u32, doubt: &mut bool) {
    let (to, from) = (to as usize, from as usize);
    let word = m[from].word();
    match op {
        Packing::Pack4Snorm8 => {
            m[to] = join_parts(8, (0..4).map(|i| normalised_word(m[from + i], -1.0, 127.0, doubt)))
        }
        Packing::Pack4Unorm8 => {
            m[to] = join_parts(8, (0..4).map(|i| normalised_word(m[from + i], 0.0, 255.0, doubt)))
        }
        Packing::Pack2Snorm16 => {
            m[to] =
                join_parts(16, (0..2).map(|i| normalised_word(m[from + i], -1.0, 32767.0, doubt)))
        }
        Packing::Pack2Unorm16 => {
            m[to] =
                join_parts(16, (0..2).map(|i| normalised_word(m[from + i], 0.0, 65535.0, doubt)))
        }
        Packing::Pack2Half => {
            m[to] = join_parts(16, (0..2).map(|i| u32::from(half_from(m[from + i].value()))))
        }
        Packing::Pack4 => m[to] = join_parts(8, (0..4).map(|i| m[from + i].word())),
        Packing::PackClampS => {
            m[to] =
                join_parts(8, (0..4).map(|i| (m[from + i].word() as i32).clamp(-128, 127) as u32))
        }
        Packing::PackClampU => m[to] = join_parts(8, (0..4).map(|i| m[from + i].word().min(255))),
        Packing::Unpack4Snorm8 => {
            (0..4).for_each(|i| m[to + i] = normalised_value(signed_part(word, 8, i), 127.0))
        }
        Packing::Unpack4Unorm8 => (0..4).for_each(|i| {
            m[to + i] = normalised_value(f64::from(unsigned_part(word, 8, i)), 255.0)
        }),
        Packing::Unpack2Snorm16 => {
            (0..2).for_each(|i| m[to + i] = normalised_value(signed_part(word, 16, i), 32767.0))
        }
        Packing::Unpack2Unorm16 => (0..2).for_each(|i| {
            m[to + i] = normalised_value(f64::from(unsigned_part(word, 16, i)), 65535.0)
        }),
        Packing::Unpack2Half => {
            (0..2).for_each(|i| m[to + i] = N::from_f64(half_to(unsigned_part(word, 16, i) as u16)))
        }
        Packing::Unpack4S => {
            (0..4).for_each(|i| m[to + i] = N::from_word(signed_part(word, 8, i) as i32 as u32))
        }
        Packing::Unpack4U => {
            (0..4).for_each(|i| m[to + i] = N::from_word(unsigned_part(word, 8, i)))
        }
    }
}

fn join_parts<N: Number>(width: u32, parts: impl Iterator<Item = u32>) -> N {
    let mask = (1 << width) - 1;
    N::from_word(
        parts
            .enumerate()
            .fold(0, |word, (index, part)| word | (part & mask) << (width * index as u32)),
    )
}

fn unsigned_part(word: u32, width: u32, index: usize) -> u32 {
    word >> (width * index as u32) & ((1 << width) - 1)
}

fn signed_part(word: u32, width: u32, index: usize) -> f64 {
    f64::from((unsigned_part(word, width, index) << (32 - width)) as i32 >> (32 - width))
}

/// `floor(0.5 + scale * clamp(x, low, 1))`. `doubt` is set where the error reaches another integer.
fn normalised_word<N: Number>(x: N, low: f64, scale: f64, doubt: &mut bool) -> u32 {
    let clamped = x.value().clamp(low, 1.0);
    // The product and the sum are rounded, unless f32 can represent their exact values.
    let exact = |value: f64| f64::from(value as f32) == value;
    let product = scale * clamped;
    let rounding = if exact(product) && exact(product + 0.5) {
        0.0
    } else {
        (product.abs() + 0.5) * f64::from(f32::EPSILON)
    };
    let moved = N::with_error(0.5 + product, scale * x.error() + rounding);
    let clamped = if clamped.is_nan() { N::default() } else { moved };
    N::unary(Unary::Floor, clamped, doubt).value() as i32 as u32
}

/// One component of a normalised format, with an error of 3 ULP.
fn normalised_value<N: Number>(value: f64, scale: f64) -> N {
    let exact = (value / scale).max(-1.0);
    N::with_error(
        exact,
        if exact.fract() == 0.0 { 0.0 } else { 3.0 * exact.abs() * f64::from(f32::EPSILON) },
    )
}
