//! Functions of whole vectors and matrices, and those that return a number in two parts. Most are
//! written with the operations of [`Number`], so that their errors follow from the definitions in
//! WGSL.

use super::super::code::{Binary, Compare, Geometry, Unary};
use super::super::number::Number;

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
        Geometry::Determinant => m[to] = determinant(&m[a..a + n * n], n, doubt),
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
    let whole = determinant(&matrix[..n * n], n, doubt);
    for i in 0..n * n {
        let (column, row) = (i / n, i % n);
        let mut minor = [N::default(); 9];
        write_minor(&matrix[..n * n], n, row, column, &mut minor);
        let part = determinant(&minor[..(n - 1) * (n - 1)], n - 1, doubt);
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
