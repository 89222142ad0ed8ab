//! Source: Lauritzen and McCool, 2008: moments of the depth as a share of an interval; the bound is
//! that of Chebyshev's one-sided inequality, which is reached by two depths.

use super::Source::Published;
use super::{CallArguments, Expected, ReferenceEntry};
use glam::{DVec2, DVec3};

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "shadow::layered",
    functions: &[
        ("lvsm_layer", Published, |a| (layer(a.f64(), a.vec3()) as f64).into()),
        ("lvsm_range", Published, |a| range(a.f64(), a.vec3(), a.f64()).into()),
        ("lvsm_warp", Published, |a| share(a.f64(), a.vec2()).into()),
        ("lvsm_moments", Published, |a| {
            let share = share(a.f64(), a.vec2());
            DVec2::new(share, share.powi(2)).into()
        }),
        ("lvsm_visibility", Published, visibility),
    ],
};

/// How many bounds are not behind the depth.
fn layer(t: f64, bounds: DVec3) -> usize {
    bounds.to_array().into_iter().filter(|bound| *bound <= t).count()
}

/// From the bound before the layer to the one behind it, widened.
fn range(layer: f64, bounds: DVec3, overlap: f64) -> DVec2 {
    let ends = [f64::NEG_INFINITY, bounds.x, bounds.y, bounds.z, f64::INFINITY];
    let first = (layer as usize).min(3);
    DVec2::new((ends[first] - overlap).clamp(0.0, 1.0), (ends[first + 1] + overlap).clamp(0.0, 1.0))
}

fn share(d: f64, range: DVec2) -> f64 {
    ((d - range.x) / (range.y - range.x).max(1e-6)).clamp(0.0, 1.0)
}

/// Of all depths with these moments, the largest share that can be at the point's depth or beyond:
/// with the deviation `s` and the distance `a` beyond the mean, 1/(1 + (a/s)^2).
fn visibility(a: &mut CallArguments<'_>) -> Expected {
    let (m, t, range, min_variance, bleed) = (a.vec2(), a.f64(), a.vec2(), a.f64(), a.f64());
    let beyond = share(t, range) - m.x;
    if beyond <= 0.0 {
        return 1.0.into();
    }
    let least = min_variance / (range.y - range.x).max(1e-6).powi(2);
    let deviation = (m.y - m.x * m.x).max(least).max(f64::from(f32::MIN_POSITIVE)).sqrt();
    let bound = 1.0 / (1.0 + (beyond / deviation).powi(2));
    if bleed >= 1.0 {
        return 0.0.into();
    }
    ((bound - bleed) / (1.0 - bleed)).clamp(0.0, 1.0).into()
}
