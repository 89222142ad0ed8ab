//! Sources: Sousa, Kasyan and Schulz, 2011; Chan, 2018.

use super::Source::Published;
use super::{CallArguments, Expected, ReferenceEntry};

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "shadow::contact",
    functions: &[
        ("contact_hit", Published, hit),
        ("march_point", Published, march_point),
        ("edge_fade", Published, edge_fade),
        ("micro_shadow", Published, |a| micro_shadow(a.f64(), a.f64()).into()),
    ],
};

fn hit(a: &mut CallArguments<'_>) -> Expected {
    let (ray, scene, bias, thickness) = (a.f64(), a.f64(), a.f64(), a.f64());
    (ray > scene + bias && ray < scene + thickness).into()
}

fn march_point(a: &mut CallArguments<'_>) -> Expected {
    let (start, l, reach, index, count, jitter) =
        (a.vec3(), a.vec3(), a.f64(), a.f64(), a.f64(), a.f64());
    (start + l * reach * (index + jitter) / count.max(1.0)).into()
}

/// The least distance to the four edges over the width of the fade, from 0 to 1.
fn edge_fade(a: &mut CallArguments<'_>) -> Expected {
    let (uv, border) = (a.vec2(), a.f64());
    let nearest = [uv.x, 1.0 - uv.x, uv.y, 1.0 - uv.y].into_iter().fold(1.0, f64::min);
    if nearest <= 0.0 {
        return 0.0.into();
    }
    if nearest >= border { 1.0.into() } else { (nearest / border).into() }
}

/// The square of n.l over the cosine of the cone's edge, at most 1.
fn micro_shadow(visibility: f64, nl: f64) -> f64 {
    let edge = (1.0 - visibility.clamp(0.0, f64::from(0.9999f32))).sqrt();
    (nl.max(0.0) / edge).min(1.0).powi(2)
}
