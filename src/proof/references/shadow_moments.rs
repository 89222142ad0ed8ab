//! Sources: OpenGL: Build High Performance Graphics, recipe 7; Donnelly and Lauritzen, 2006;
//! Lauritzen, GPU Gems 3, chapter 8 (slope, bleeding); Lauritzen and McCool, 2008 (exponential).

use super::{Arguments, Entry, Expected};
use glam::{DVec2, DVec4};

pub const REFERENCES: Entry = Entry {
    module: "shadow::moments",
    functions: &[
        ("vsm_moments", |a| moments(a.f64()).into()),
        ("vsm_moments_slope", |a| {
            (moments(a.f64()) + DVec2::Y * 0.25 * a.vec2().length_squared()).into()
        }),
        ("chebyshev", |a| chebyshev(a.vec2(), a.f64(), a.f64(), a.f64()).into()),
        ("vsm_visibility", vsm_visibility),
        ("evsm_warp", |a| warp(a.f64(), a.vec2()).into()),
        ("evsm_moments", evsm_moments),
        ("evsm_visibility", evsm_visibility),
    ],
};

fn moments(d: f64) -> DVec2 {
    DVec2::new(d, d * d)
}

/// var/(var + (t - m1)^2) with var = max(m2 - m1^2, min), less the bleed, stretched back; 1 up to
/// the mean.
fn chebyshev(m: DVec2, t: f64, min_variance: f64, bleed: f64) -> f64 {
    if t <= m.x {
        return 1.0;
    }
    let variance = (m.y - m.x * m.x).max(min_variance).max(f64::from(f32::MIN_POSITIVE));
    let p = variance / (variance + (t - m.x).powi(2));
    if bleed >= 1.0 { 0.0 } else { ((p - bleed) / (1.0 - bleed)).clamp(0.0, 1.0) }
}

/// max(p, t <= m1 ? 1 : least).
fn vsm_visibility(a: &mut Arguments<'_>) -> Expected {
    let (m, t, min_variance, least, bleed) = (a.vec2(), a.f64(), a.f64(), a.f64(), a.f64());
    chebyshev(m, t, min_variance, bleed).max(least).into()
}

/// (exp(x*z), -exp(-y*z)) with z from -1 to 1.
fn warp(d: f64, exponents: DVec2) -> DVec2 {
    let z = 2.0 * d - 1.0;
    DVec2::new((exponents.x * z).exp(), -(-exponents.y * z).exp())
}

fn evsm_moments(a: &mut Arguments<'_>) -> Expected {
    let w = warp(a.f64(), a.vec2());
    DVec4::new(w.x, w.x * w.x, w.y, w.y * w.y).into()
}

/// The smaller bound; the least variance grows with the square of the warp's slope, 2*e*w.
fn evsm_visibility(a: &mut Arguments<'_>) -> Expected {
    let (m, t, exponents, min_variance, bleed) = (a.vec4(), a.f64(), a.vec2(), a.f64(), a.f64());
    let w = warp(t, exponents);
    let least = min_variance * (2.0 * exponents * w).powf(2.0);
    let positive = chebyshev(DVec2::new(m.x, m.y), w.x, least.x, bleed);
    positive.min(chebyshev(DVec2::new(m.z, m.w), w.y, least.y, bleed)).into()
}
