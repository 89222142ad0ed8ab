//! Source: Christensen and Burley, 2015, equations 3, 5 and 11.

use super::Source::Published;
use super::{CallArguments, Expected, ReferenceEntry};
use std::f64::consts::PI;

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "brdf::subsurface",
    functions: &[
        ("diffusion_profile", Published, |a| profile(a.f64(), a.f64()).into()),
        ("diffusion_cdf", Published, |a| cdf(a.f64() * a.f64()).into()),
        ("diffusion_s", Published, diffusion_s),
        ("diffusion_sample", Published, |a| sample(a.f64(), a.f64()).into()),
    ],
};

/// s*(exp(-s*r) + exp(-s*r/3))/(8*pi*r), with r at least 1e-4/s.
pub fn profile(r: f64, s: f64) -> f64 {
    let s = s.clamp(0.0, 1e6);
    if s == 0.0 {
        return 0.0;
    }
    let r = r.max(f64::from(1e-4f32) / s);
    s * ((-s * r).exp() + (-s * r / 3.0).exp()) / (8.0 * PI * r)
}

/// 1 - exp(-x)/4 - 3*exp(-x/3)/4, without cancellation.
pub fn cdf(x: f64) -> f64 {
    let x = x.max(0.0);
    -0.25 * (-x).exp_m1() - 0.75 * (-x / 3.0).exp_m1()
}

fn diffusion_s(a: &mut CallArguments<'_>) -> Expected {
    Expected::words(a.vec3().to_array().map(|albedo| {
        let albedo = albedo.clamp(0.0, 1.0);
        1.85 - albedo + 7.0 * (albedo - 0.8).abs().powi(3)
    }))
}

/// The distance at which the cumulative distribution is `u`, by bisection.
fn sample(u: f64, s: f64) -> f64 {
    let share = u.clamp(0.0, 1.0 - (-24f64).exp2());
    let (mut low, mut high) = (0.0, 64.0);
    for _ in 0..100 {
        let middle = (low + high) / 2.0;
        if cdf(middle) < share { low = middle } else { high = middle }
    }
    low / s.max(f64::from(1e-6f32))
}
