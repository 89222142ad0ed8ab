//! Integers, bits and booleans, as WGSL defines them: they wrap, and division by zero gives the
//! dividend (its remainder 0).

use super::super::code::{Word1, Word2};

#[inline(always)]
pub fn word1(op: Word1, x: u32) -> u32 {
    match op {
        Word1::Negate => x.wrapping_neg(),
        Word1::Not => !x,
        Word1::LogicalNot => x ^ 1,
        Word1::Abs => (x as i32).wrapping_abs() as u32,
        Word1::Sign => (x as i32).signum() as u32,
        Word1::TrailingZeros => x.trailing_zeros(),
        Word1::LeadingZeros => x.leading_zeros(),
        Word1::CountOnes => x.count_ones(),
        Word1::Reverse => x.reverse_bits(),
        Word1::FirstTrailing => {
            if x == 0 {
                u32::MAX
            } else {
                x.trailing_zeros()
            }
        }
        Word1::FirstLeading => 31u32.wrapping_sub(x.leading_zeros()),
        // The highest bit that differs from the sign bit.
        Word1::FirstLeadingSigned => {
            31u32.wrapping_sub((x ^ ((x as i32) >> 31) as u32).leading_zeros())
        }
        Word1::Truth => u32::from(x != 0),
    }
}

#[inline(always)]
pub fn word2(op: Word2, a: u32, b: u32) -> u32 {
    let (signed_a, signed_b) = (a as i32, b as i32);
    match op {
        Word2::Add => a.wrapping_add(b),
        Word2::Subtract => a.wrapping_sub(b),
        Word2::Multiply => a.wrapping_mul(b),
        Word2::DivideS if b == 0 => a,
        Word2::DivideS => signed_a.wrapping_div(signed_b) as u32,
        Word2::DivideU => a.checked_div(b).unwrap_or(a),
        Word2::RemainderS if b == 0 => 0,
        Word2::RemainderS => signed_a.wrapping_rem(signed_b) as u32,
        Word2::RemainderU => a.checked_rem(b).unwrap_or(0),
        Word2::And => a & b,
        Word2::Or => a | b,
        Word2::Xor => a ^ b,
        Word2::ShiftLeft => a.wrapping_shl(b),
        Word2::ShiftRightS => signed_a.wrapping_shr(b) as u32,
        Word2::ShiftRightU => a.wrapping_shr(b),
        Word2::Equal => u32::from(a == b),
        Word2::NotEqual => u32::from(a != b),
        Word2::LessS => u32::from(signed_a < signed_b),
        Word2::LessU => u32::from(a < b),
        Word2::LessEqualS => u32::from(signed_a <= signed_b),
        Word2::LessEqualU => u32::from(a <= b),
        Word2::MinS => signed_a.min(signed_b) as u32,
        Word2::MinU => a.min(b),
        Word2::MaxS => signed_a.max(signed_b) as u32,
        Word2::MaxU => a.max(b),
        Word2::DotBytesS => byte_pairs(a, b)
            .map(|(a, b)| i32::from(a as i8) * i32::from(b as i8))
            .sum::<i32>() as u32,
        Word2::DotBytesU => byte_pairs(a, b).map(|(a, b)| u32::from(a) * u32::from(b)).sum(),
    }
}

/// Bits `[offset, offset + count)` of the word, with the range clamped to the word.
pub fn extract_bits(signed: bool, word: u32, offset: u32, count: u32) -> u32 {
    let offset = offset.min(32);
    let count = count.min(32 - offset);
    if count == 0 {
        return 0;
    }
    let raised = word << (32 - offset - count);
    if signed { ((raised as i32) >> (32 - count)) as u32 } else { raised >> (32 - count) }
}

/// `[word, new, offset, count]`: the word with bits `[offset, offset + count)` replaced.
pub fn insert_bits([word, new, offset, count]: [u32; 4]) -> u32 {
    let offset = offset.min(32);
    let count = count.min(32 - offset);
    if count == 0 {
        return word;
    }
    let mask = (u32::MAX >> (32 - count)) << offset;
    word & !mask | new << offset & mask
}

fn byte_pairs(a: u32, b: u32) -> impl Iterator<Item = (u8, u8)> {
    a.to_le_bytes().into_iter().zip(b.to_le_bytes())
}
