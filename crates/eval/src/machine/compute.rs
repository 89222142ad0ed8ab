//! Runs the instructions that only read and write memory.
//!
//! Integers, bits and booleans are as WGSL defines them: they wrap, and division by zero gives the
//! dividend (its remainder 0). Functions of whole vectors and matrices, and those that return a
//! number in two parts, are mostly written with the operations of [`Number`], so that their errors
//! follow from the definitions in WGSL.

use crate::code::{
    Binary, Compare, Convert, Geometry, Instruction, Operand, Packing, Product, Unary, Word1, Word2,
};
use crate::number::{Number, half_from, half_to};

/// Runs one instruction. `doubt` is as for [`Number`].
#[inline(always)]
pub(super) fn compute<N: Number>(instruction: &Instruction, m: &mut [N], doubt: &mut bool) {
    match *instruction {
        Instruction::Copy { to, from, n } => copy_slots(m, to, from, n),
        Instruction::Fill { to, from, n } => {
            let value = m[from as usize];
            m[to as usize..(to + n) as usize].fill(value);
        }
        Instruction::Zero { to, n } => m[to as usize..(to + n) as usize].fill(N::default()),
        Instruction::Float1 { op, n, to, a } => {
            each_component(m, n, to, |m, i| N::unary(op, m[a.at(i)], doubt))
        }
        Instruction::Float2 { op, n, to, a, b } => {
            each_component(m, n, to, |m, i| N::binary(op, m[a.at(i)], m[b.at(i)], doubt))
        }
        Instruction::Float3 { op, n, to, a, b, c } => each_component(m, n, to, |m, i| {
            N::ternary(op, m[a.at(i)], m[b.at(i)], m[c.at(i)], doubt)
        }),
        Instruction::Compare { op, n, to, a, b } => {
            each_word(m, n, to, |m, i| u32::from(N::compare(op, m[a.at(i)], m[b.at(i)], doubt)))
        }
        Instruction::Word1 { op, n, to, a } => {
            each_word(m, n, to, |m, i| word1(op, m[a.at(i)].word()))
        }
        Instruction::Word2 { op, n, to, a, b } => {
            each_word(m, n, to, |m, i| word2(op, m[a.at(i)].word(), m[b.at(i)].word()))
        }
        Instruction::ExtractBits { signed, n, to, from, offset, count } => {
            each_word(m, n, to, |m, i| {
                extract_bits(
                    signed,
                    m[from.at(i)].word(),
                    m[offset as usize].word(),
                    m[count as usize].word(),
                )
            });
        }
        Instruction::InsertBits { n, to, from, new, offset, count } => {
            each_word(m, n, to, |m, i| {
                insert_bits(
                    [m[from.at(i)], m[new.at(i)], m[offset as usize], m[count as usize]]
                        .map(N::word),
                )
            });
        }
        Instruction::Convert { op, n, to, a } => convert(m, op, n, to, a, doubt),
        Instruction::Pack { op, to, from } => pack(m, op, to, from, doubt),
        Instruction::Select { n, to, condition, accept, reject } => {
            each_component(m, n, to, |m, i| {
                if m[condition.at(i)].word() != 0 { m[accept.at(i)] } else { m[reject.at(i)] }
            });
        }
        Instruction::Reduce { all, n, to, a } => {
            let set = m[a as usize..a as usize + usize::from(n)]
                .iter()
                .filter(|slot| slot.word() != 0)
                .count();
            m[to as usize] =
                N::from_word(u32::from(if all { set == usize::from(n) } else { set > 0 }));
        }
        Instruction::Geometry { op, n, to, a, b, c } => {
            geometry(m, op, usize::from(n), [to, a, b, c].map(|slot| slot as usize), doubt)
        }
        Instruction::Product { op, inner, rows, columns, to, a, b } => {
            matrix_product(m, op, [inner, rows, columns], to, a, b)
        }
        Instruction::Transpose { rows, columns, to, from } => {
            let (rows, columns) = (u32::from(rows), u32::from(columns));
            (0..rows * columns).for_each(|i| {
                m[(to + i) as usize] = m[(from + i % columns * rows + i / columns) as usize]
            });
        }
        Instruction::Index { to, base, index, size, count } => {
            let last = m[count as usize].word().saturating_sub(1);
            m[to as usize] = N::from_word(
                m[base as usize]
                    .word()
                    .wrapping_add(m[index as usize].word().min(last).wrapping_mul(size)),
            );
        }
        Instruction::Pick { to, from, index, size, count } => {
            copy_slots(
                m,
                to,
                from + m[index as usize].word().min(count.saturating_sub(1)) * size,
                size,
            );
        }
        Instruction::Load { to, pointer, offset, n } => {
            copy_slots(m, to, m[pointer as usize].word().wrapping_add(offset), n)
        }
        Instruction::Store { pointer, offset, from, n } => {
            copy_slots(m, m[pointer as usize].word().wrapping_add(offset), from, n)
        }
        _ => {}
    }
}

#[inline(always)]
fn copy_slots<N: Number>(m: &mut [N], to: u32, from: u32, n: u32) {
    let (to, from, n) = (to as usize, from as usize, n as usize);
    // An address outside the memory can only come from a buffer that is not bound. Nothing is
    // copied then.
    if from + n <= m.len() && to + n <= m.len() {
        m.copy_within(from..from + n, to);
    }
}

#[inline(always)]
fn each_component<N: Number>(m: &mut [N], n: u8, to: u32, mut f: impl FnMut(&[N], u32) -> N) {
    for i in 0..u32::from(n) {
        m[(to + i) as usize] = f(m, i);
    }
}

#[inline(always)]
fn each_word<N: Number>(m: &mut [N], n: u8, to: u32, mut f: impl FnMut(&[N], u32) -> u32) {
    each_component(m, n, to, |m, i| N::from_word(f(m, i)));
}

fn convert<N: Number>(m: &mut [N], op: Convert, n: u8, to: u32, a: Operand, doubt: &mut bool) {
    each_component(m, n, to, |m, i| convert_slot(op, m[a.at(i)], doubt));
}

/// Converts one slot between words and numbers.
#[inline(always)]
pub fn convert_slot<N: Number>(op: Convert, x: N, doubt: &mut bool) -> N {
    match op {
        Convert::FloatFromS => whole_number(f64::from(x.word() as i32)),
        Convert::FloatFromU => whole_number(f64::from(x.word())),
        Convert::SFromFloat => N::from_word(x.to_i32(doubt) as u32),
        Convert::UFromFloat => N::from_word(x.to_u32(doubt)),
        Convert::BoolFromFloat => N::from_word(u32::from(x.value() != 0.0)),
        Convert::FloatFromBits => N::from_f64(f64::from(f32::from_bits(x.word()))),
        Convert::BitsFromFloat => N::from_word(x.bits()),
        Convert::IsNan => N::from_word(u32::from(x.value().is_nan())),
        Convert::IsInf => N::from_word(u32::from(x.value().is_infinite())),
    }
}

/// An integer as a number. Its error is twice that of rounding to f32.
#[inline(always)]
fn whole_number<N: Number>(value: f64) -> N {
    let rounded = f64::from(value as f32);
    N::with_error(value, 2.0 * (value - rounded).abs())
}

/// Products of matrices and vectors, computed by columns of `b`.
fn matrix_product<N: Number>(
    m: &mut [N],
    op: Product,
    [inner, rows, columns]: [u8; 3],
    to: u32,
    a: u32,
    b: u32,
) {
    let (inner, rows, columns, to, a, b) = (
        usize::from(inner),
        usize::from(rows),
        usize::from(columns),
        to as usize,
        a as usize,
        b as usize,
    );
    // The distance in slots between the elements of a row of `a`. A vector on the left of a matrix
    // is a matrix of one row.
    let stride = if op == Product::VectorMatrix { 1 } else { rows };
    for column in 0..columns {
        let mut right = [N::default(); 4];
        right[..inner].copy_from_slice(&m[b + column * inner..b + (column + 1) * inner]);
        for row in 0..rows {
            let mut left = [N::default(); 4];
            (0..inner).for_each(|k| left[k] = m[a + k * stride + row]);
            m[to + column * rows + row] = N::dot(&left[..inner], &right[..inner]);
        }
    }
}

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

/// A vector of up to four numbers.
type Vector<N> = [N; 4];

/// Runs one function on the slots `[to, a, b, c]`.
pub fn geometry<N: Number>(
    m: &mut [N],
    op: Geometry,
    n: usize,
    [to, a, b, c]: [usize; 4],
    doubt: &mut bool,
) {
    match op {
        Geometry::Dot => m[to] = N::dot(&m[a..a + n], &m[b..b + n]),
        Geometry::DotWord => {
            m[to] = N::from_word(
                (0..n)
                    .map(|i| m[a + i].word().wrapping_mul(m[b + i].word()))
                    .fold(0, u32::wrapping_add),
            )
        }
        Geometry::Cross => put(m, to, 3, cross(&load(m, a, 3), &load(m, b, 3), doubt)),
        Geometry::Distance => {
            m[to] =
                length(&zip(Binary::Subtract, &load(m, a, n), &load(m, b, n), doubt)[..n], doubt)
        }
        Geometry::Length => m[to] = length(&m[a..a + n], doubt),
        Geometry::Normalize => put(m, to, n, normalize(&load(m, a, n), n, doubt)),
        Geometry::FaceForward => {
            let front = N::compare(
                Compare::Less,
                N::dot(&m[c..c + n], &m[b..b + n]),
                N::from_f64(0.0),
                doubt,
            );
            let e1 = load(m, a, n);
            put(m, to, n, if front { e1 } else { e1.map(|x| N::unary(Unary::Negate, x, doubt)) });
        }
        Geometry::Reflect => put(m, to, n, reflect(&load(m, a, n), &load(m, b, n), n, doubt)),
        Geometry::Refract => put(m, to, n, refract(&load(m, a, n), &load(m, b, n), m[c], n, doubt)),
        Geometry::Determinant => m[to] = any_determinant(&m[a..a + n * n], n, doubt),
        Geometry::Inverse => inverse(m, n, to, a, doubt),
        Geometry::Modf => (0..n).for_each(|i| {
            let whole = N::unary(Unary::Trunc, m[a + i], doubt);
            (m[to + i], m[to + n + i]) =
                (N::binary(Binary::Subtract, m[a + i], whole, doubt), whole);
        }),
        Geometry::Frexp => (0..n).for_each(|i| {
            let (fraction, exponent) = frexp(m[a + i]);
            (m[to + i], m[to + n + i]) = (fraction, N::from_word(exponent as u32));
        }),
        Geometry::Ldexp => (0..n).for_each(|i| m[to + i] = ldexp(m[a + i], m[b + i].word() as i32)),
    }
}

fn load<N: Number>(m: &[N], from: usize, n: usize) -> Vector<N> {
    let mut vector = [N::default(); 4];
    vector[..n].copy_from_slice(&m[from..from + n]);
    vector
}

fn put<N: Number>(m: &mut [N], to: usize, n: usize, vector: Vector<N>) {
    m[to..to + n].copy_from_slice(&vector[..n]);
}

fn zip<N: Number>(op: Binary, a: &Vector<N>, b: &Vector<N>, doubt: &mut bool) -> Vector<N> {
    std::array::from_fn(|i| N::binary(op, a[i], b[i], doubt))
}

fn times<N: Number>(vector: &Vector<N>, factor: N, doubt: &mut bool) -> Vector<N> {
    vector.map(|x| N::binary(Binary::Multiply, x, factor, doubt))
}

fn cross<N: Number>(a: &Vector<N>, b: &Vector<N>, doubt: &mut bool) -> Vector<N> {
    let mut minor = |i: usize, j: usize| {
        let (left, right) = (
            N::binary(Binary::Multiply, a[i], b[j], doubt),
            N::binary(Binary::Multiply, a[j], b[i], doubt),
        );
        N::binary(Binary::Subtract, left, right, doubt)
    };
    [minor(1, 2), minor(2, 0), minor(0, 1), N::default()]
}

fn length<N: Number>(vector: &[N], doubt: &mut bool) -> N {
    if let [x] = vector {
        return N::unary(Unary::Abs, *x, doubt);
    }
    N::unary(Unary::Sqrt, N::dot(vector, vector), doubt)
}

fn normalize<N: Number>(vector: &Vector<N>, n: usize, doubt: &mut bool) -> Vector<N> {
    let length = length(&vector[..n], doubt);
    vector.map(|x| N::binary(Binary::Divide, x, length, doubt))
}

/// `e1 - 2 dot(e2, e1) e2`.
fn reflect<N: Number>(e1: &Vector<N>, e2: &Vector<N>, n: usize, doubt: &mut bool) -> Vector<N> {
    let twice = N::binary(Binary::Multiply, N::from_f64(2.0), N::dot(&e2[..n], &e1[..n]), doubt);
    zip(Binary::Subtract, e1, &times(e2, twice, doubt), doubt)
}

/// `k = 1 - r^2 (1 - dot(e2, e1)^2)`; 0 if k < 0, else `r e1 - (r dot(e2, e1) + sqrt(k)) e2`.
fn refract<N: Number>(
    e1: &Vector<N>,
    e2: &Vector<N>,
    ratio: N,
    n: usize,
    doubt: &mut bool,
) -> Vector<N> {
    let one = N::from_f64(1.0);
    let cosine = N::dot(&e2[..n], &e1[..n]);
    let mut apply = |op, a, b| N::binary(op, a, b, doubt);
    let rest = apply(Binary::Subtract, one, apply_square(cosine));
    let share = apply(Binary::Multiply, apply_square(ratio), rest);
    let k = apply(Binary::Subtract, one, share);
    let projected = apply(Binary::Multiply, ratio, cosine);
    if N::compare(Compare::Less, k, N::from_f64(0.0), doubt) {
        return [N::default(); 4];
    }
    let root = N::unary(Unary::Sqrt, k, doubt);
    let along = N::binary(Binary::Add, projected, root, doubt);
    zip(Binary::Subtract, &times(e1, ratio, doubt), &times(e2, along, doubt), doubt)
}

fn apply_square<N: Number>(x: N) -> N {
    N::dot(&[x], &[x])
}

/// The determinant with a bound for every way to expand it: drivers differ in which products they
/// round, also where the terms cancel.
fn any_determinant<N: Number>(matrix: &[N], n: usize, doubt: &mut bool) -> N {
    let whole = determinant(matrix, n, doubt);
    if !N::BOUNDED {
        return whole;
    }
    let sizes: Vec<f64> = matrix.iter().map(|one| one.value().abs()).collect();
    // One rounding for each sum of n! products, and n - 1 for those within a product.
    let roundings = (1..=n).product::<usize>() + n - 1;
    let error = roundings as f64 * f64::from(f32::EPSILON) * permanent(&sizes, n);
    N::with_error(whole.value(), whole.error() + error)
}

/// The determinant of a matrix of sizes in which no term is subtracted.
fn permanent(matrix: &[f64], n: usize) -> f64 {
    let minor = |row: usize| {
        let kept = (n..n * n).filter(|index| index % n != row);
        kept.map(|index| matrix[index]).collect::<Vec<f64>>()
    };
    match n {
        1 => matrix[0],
        _ => (0..n).map(|row| matrix[row] * permanent(&minor(row), n - 1)).sum(),
    }
}

/// The determinant, expanded along the first column.
fn determinant<N: Number>(matrix: &[N], n: usize, doubt: &mut bool) -> N {
    if n == 1 {
        return matrix[0];
    }
    let mut sum = N::default();
    for row in 0..n {
        let mut minor = [N::default(); 9];
        write_minor(matrix, n, 0, row, &mut minor);
        let part = determinant(&minor[..(n - 1) * (n - 1)], n - 1, doubt);
        let term = N::binary(Binary::Multiply, matrix[row], part, doubt);
        sum =
            N::binary(if row % 2 == 0 { Binary::Add } else { Binary::Subtract }, sum, term, doubt);
    }
    sum
}

/// Writes the matrix without one column and one row.
fn write_minor<N: Number>(matrix: &[N], n: usize, column: usize, row: usize, minor: &mut [N; 9]) {
    let kept = (0..n * n).filter(|i| i / n != column && i % n != row);
    kept.zip(minor).for_each(|(i, to)| *to = matrix[i]);
}

/// The transposed cofactors over the determinant.
fn inverse<N: Number>(m: &mut [N], n: usize, to: usize, from: usize, doubt: &mut bool) {
    let mut matrix = [N::default(); 16];
    matrix[..n * n].copy_from_slice(&m[from..from + n * n]);
    let whole = any_determinant(&matrix[..n * n], n, doubt);
    for i in 0..n * n {
        let (column, row) = (i / n, i % n);
        let mut minor = [N::default(); 9];
        write_minor(&matrix[..n * n], n, row, column, &mut minor);
        let part = any_determinant(&minor[..(n - 1) * (n - 1)], n - 1, doubt);
        let signed =
            if (column + row) % 2 == 0 { part } else { N::unary(Unary::Negate, part, doubt) };
        m[to + i] = N::binary(Binary::Divide, signed, whole, doubt);
    }
}

/// A fraction in [0.5, 1) and an exponent.
fn frexp<N: Number>(x: N) -> (N, i32) {
    let value = x.value();
    if value == 0.0 || !value.is_finite() {
        return (x, 0);
    }
    // A subnormal is scaled into the normal range, so that the bits have its exponent.
    let raised = value.abs() < f64::MIN_POSITIVE;
    let bits = (if raised { value * 64f64.exp2() } else { value }).to_bits();
    let exponent = (bits >> 52 & 0x7ff) as i32 - 1022 - if raised { 64 } else { 0 };
    (ldexp(x, -exponent), exponent)
}

/// `x * 2^exponent`, in two steps so that neither factor overflows.
fn ldexp<N: Number>(x: N, exponent: i32) -> N {
    let exponent = exponent.clamp(-2100, 2100);
    let (first, second) = (exponent / 2, exponent - exponent / 2);
    let factor = |x: f64| x * f64::from(first).exp2() * f64::from(second).exp2();
    N::with_error(factor(x.value()), factor(x.error()))
}
