//! Gauss-Legendre quadrature, with which laws, scenes and tables integrate.

use std::f64::consts::PI;

/// The nodes and weights of the rule on [-1, 1]. The nodes are the zeros of the Legendre
/// polynomial, found by Newton's method.
pub fn gauss_legendre(count: usize) -> Vec<(f64, f64)> {
    let node = |index: usize| {
        let mut x = (PI * (index as f64 + 0.75) / (count as f64 + 0.5)).cos();
        for _ in 0..64 {
            let (value, slope) = legendre(count, x);
            let next = x - value / slope;
            if next == x {
                break;
            }
            x = next;
        }
        let (_, slope) = legendre(count, x);
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..count).map(node).collect()
}

/// The Legendre polynomial of a degree at `x`, and its derivative, by the three-term recurrence.
fn legendre(degree: usize, x: f64) -> (f64, f64) {
    let (mut before, mut value) = (1.0, x);
    for n in 2..=degree {
        let n = n as f64;
        (before, value) = (value, ((2.0 * n - 1.0) * x * value - (n - 1.0) * before) / n);
    }
    (value, degree as f64 * (x * value - before) / (x * x - 1.0))
}
