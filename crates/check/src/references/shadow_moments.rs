//! Sources: OpenGL: Build High Performance Graphics, recipe 7; Donnelly and Lauritzen, 2006;
//! Lauritzen, GPU Gems 3, chapter 8 (slope, bleeding); Lauritzen and McCool, 2008 (exponential);
//! Annen et al., 2008 (exponential shadow maps); Peters and Klein, 2015 (four moments).

use super::Source::Published;
use super::{CallArguments, Expected, ReferenceEntry};
use glam::{DMat3, DMat4, DVec2, DVec3, DVec4};

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "shadow::moments",
    functions: &[
        ("vsm_moments", Published, |a| moments(a.f64()).into()),
        ("vsm_moments_slope", Published, |a| {
            (moments(a.f64()) + DVec2::Y * 0.25 * a.vec2().length_squared()).into()
        }),
        ("chebyshev", Published, |a| chebyshev(a.vec2(), a.f64(), a.f64(), a.f64()).into()),
        ("vsm_visibility", Published, vsm_visibility),
        ("evsm_warp", Published, |a| warp(a.f64(), a.vec2()).into()),
        ("evsm_moments", Published, evsm_moments),
        ("evsm_visibility", Published, evsm_visibility),
        ("esm_moment", Published, |a| exponent(a.f64(), a.f64()).exp().into()),
        ("esm_visibility", Published, esm_visibility),
        ("msm_moments", Published, |a| powers(a.f64()).into()),
        ("msm_quantise", Published, |a| quantise(a.vec4()).into()),
        ("msm_dequantise", Published, |a| dequantise(a.vec4()).into()),
        ("msm_visibility", Published, |a| msm_visibility(a.vec4(), a.f64(), a.f64()).into()),
    ],
};

fn moments(d: f64) -> DVec2 {
    DVec2::new(d, d * d)
}

/// 1 up to the mean. Beyond it, var/(var + (t - m1)^2) with var = max(m2 - m1^2, min); then values
/// below `bleed` become 0, and the rest is scaled to [0, 1].
fn chebyshev(m: DVec2, t: f64, min_variance: f64, bleed: f64) -> f64 {
    if t <= m.x {
        return 1.0;
    }
    let variance = (m.y - m.x * m.x).max(min_variance).max(f64::from(f32::MIN_POSITIVE));
    let p = variance / (variance + (t - m.x).powi(2));
    if bleed >= 1.0 { 0.0 } else { ((p - bleed) / (1.0 - bleed)).clamp(0.0, 1.0) }
}

/// 1 up to the mean depth. Beyond it, Chebyshev's upper bound after the correction of light
/// bleeding, but at least `least`.
fn vsm_visibility(a: &mut CallArguments<'_>) -> Expected {
    let (m, t, min_variance, least, bleed) = (a.vec2(), a.f64(), a.f64(), a.f64(), a.f64());
    chebyshev(m, t, min_variance, bleed).max(least).into()
}

/// (exp(x*z), -exp(-y*z)) with z from -1 to 1.
fn warp(d: f64, exponents: DVec2) -> DVec2 {
    let z = 2.0 * d - 1.0;
    DVec2::new((exponents.x * z).exp(), -(-exponents.y * z).exp())
}

fn evsm_moments(a: &mut CallArguments<'_>) -> Expected {
    let w = warp(a.f64(), a.vec2());
    DVec4::new(w.x, w.x * w.x, w.y, w.y * w.y).into()
}

/// The smaller of the bounds of both warps. The least variance grows with the square of the slope
/// of the warp, 2*e*w.
fn evsm_visibility(a: &mut CallArguments<'_>) -> Expected {
    let (m, t, exponents, min_variance, bleed) = (a.vec4(), a.f64(), a.vec2(), a.f64(), a.f64());
    let w = warp(t, exponents);
    let least = min_variance * (2.0 * exponents * w).powf(2.0);
    let positive = chebyshev(DVec2::new(m.x, m.y), w.x, least.x, bleed);
    positive.min(chebyshev(DVec2::new(m.z, m.w), w.y, least.y, bleed)).into()
}

fn exponent(d: f64, c: f64) -> f64 {
    c.clamp(0.0, 80.0) * d.clamp(0.0, 1.0)
}

/// The filtered exponential over the exponential of the point's depth.
fn esm_visibility(a: &mut CallArguments<'_>) -> Expected {
    let (m, t, c) = (a.f64(), a.f64(), a.f64());
    (m / exponent(t, c).exp()).clamp(0.0, 1.0).into()
}

fn powers(d: f64) -> DVec4 {
    DVec4::from([1, 2, 3, 4].map(|power| d.powi(power)))
}

/// The matrix as it is printed, row by row.
const ROWS: [[f64; 4]; 4] = [
    [-2.07224649, 13.7948857237, 0.105877704, 9.7924062118],
    [32.23703778, -59.4683975703, -1.9077466311, -33.7652110555],
    [-68.571074599, 82.0359750338, 9.3496555107, 47.9456096605],
    [39.3703274134, -35.364903257, -6.6543490743, -23.9728048165],
];
const OFFSET: DVec4 = DVec4::new(0.035955884801, 0.0, 0.0, 0.0);

/// A row vector times the matrix, and an offset.
fn quantise(m: DVec4) -> DVec4 {
    DMat4::from_cols_array_2d(&ROWS) * m + OFFSET
}

/// By the numerical inverse of the matrix, not by the one that is printed next to it.
fn dequantise(q: DVec4) -> DVec4 {
    DMat4::from_cols_array_2d(&ROWS).inverse() * (q - OFFSET)
}

/// Finds three depths with weights that have these moments, where one of the depths is that of the
/// point. The two others are the roots of a polynomial, by Cramer's rule, and the weights follow
/// from the first moments. Depths nearer than the point shade it by their weights.
fn msm_visibility(m: DVec4, t: f64, bias: f64) -> f64 {
    let b = m.lerp(DVec4::splat(0.5), bias);
    if b.y - b.x * b.x <= f64::from(1e-12f32) {
        return f64::from(u8::from(t <= b.x));
    }
    let hankel = [DVec3::new(1.0, b.x, b.y), DVec3::new(b.x, b.y, b.z), DVec3::new(b.y, b.z, b.w)];
    let side = DVec3::new(1.0, t, t * t);
    let cramer = |column: usize| {
        let mut columns = hankel;
        columns[column] = side;
        DMat3::from_cols_array_2d(&columns.map(|column| column.to_array())).determinant()
    };
    // The determinant of the matrix itself is a common factor of all three, so it is left out.
    let [k0, k1, k2] = [cramer(0), cramer(1), cramer(2)];
    let root = (k1 * k1 - 4.0 * k2 * k0).max(0.0).sqrt();
    let far = -0.5 * (k1 + root.copysign(k1));
    let depths = [t, far / k2, k0 / far];
    let weight = |index: usize| {
        let (x, y, z) = (depths[index], depths[(index + 1) % 3], depths[(index + 2) % 3]);
        (b.y - (y + z) * b.x + y * z) / ((x - y) * (x - z))
    };
    let before: f64 = (1..3).filter(|index| depths[*index] < t).map(weight).sum();
    (1.0 - before).clamp(0.0, 1.0)
}
