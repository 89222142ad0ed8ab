//! Sources: Majercik et al., 2019, section 5.2; NVIDIA, RTXGI SDK 1.3, 2022.

use super::Source::Published;
use super::{CallArguments, Expected, ReferenceEntry};

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "ambient::ddgi",
    functions: &[
        ("ddgi_chebyshev", Published, |a| chebyshev(a, None).into()),
        ("ddgi_weight", Published, |a| weight(a, Some(0.0))),
        ("ddgi_weight_rtxgi", Published, |a| weight(a, Some(0.05))),
        ("ddgi_crushed", Published, |a| weight(a, None)),
    ],
};

/// 1 up to the mean distance. Beyond it, the cube of var/(var + (d - mean)^2), but at least
/// `least`, which is read from the arguments if it is `None`.
fn chebyshev(a: &mut CallArguments<'_>, least: Option<f64>) -> f64 {
    let (mean, mean2, dist) = (a.f64(), a.f64(), a.f64());
    let least = least.unwrap_or_else(|| a.f64()).clamp(0.0, 1.0);
    if dist <= mean {
        return 1.0;
    }
    let variance = (mean2 - mean.powi(2)).abs();
    let below = (variance + (dist - mean).powi(2)).max(f64::from(1e-30f32));
    (variance / below).powi(3).clamp(least, 1.0)
}

/// The wrapped cosine, squared, plus 0.2, times the visibility. A weight w below 0.2 becomes
/// w^3/0.2^2. The result is multiplied by the trilinear share. Without `least`, the visibility is
/// an argument.
fn weight(a: &mut CallArguments<'_>, least: Option<f64>) -> Expected {
    let (n, dir, share) = (a.vec3(), a.vec3(), a.f64());
    let visibility = if least.is_some() { chebyshev(a, least) } else { a.f64() };
    let w = ((((n.dot(dir) + 1.0) / 2.0).powi(2) + 0.2) * visibility).max(f64::from(1e-6f32));
    let crushed = if w < 0.2 { w.powi(3) / 0.2f64.powi(2) } else { w };
    (crushed * share.max(f64::from(0.001f32))).into()
}
