//! Source: Cigolle et al., 2014, section 3.1.

use super::Source::Published;
use super::{CallArguments, Expected, ReferenceEntry};
use glam::{DVec2, DVec3};

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "ambient::octahedral",
    functions: &[("octahedral_encode", Published, encode), ("octahedral_decode", Published, |a| decode(a.vec2()).into())],
};

fn sign(x: f64) -> f64 {
    if x >= 0.0 { 1.0 } else { -1.0 }
}

/// The direction scaled onto |x| + |y| + |z| = 1. The lower half is mirrored at the edges of the
/// diamond |x| + |y| = 1.
fn encode(a: &mut CallArguments<'_>) -> Expected {
    let n = a.vec3();
    if n.abs().max_element() <= f64::from(1e-30f32) {
        return DVec2::ZERO.into();
    }
    let on = n / n.abs().element_sum();
    let upper = DVec2::new(on.x, on.y);
    let lower = DVec2::new((1.0 - on.y.abs()) * sign(on.x), (1.0 - on.x.abs()) * sign(on.y));
    if n.z >= 0.0 { upper.into() } else { lower.into() }
}

/// The direction to the point of the octahedron: of its upper half inside the diamond |x| + |y| =
/// 1, of its lower half outside.
fn decode(e: DVec2) -> DVec3 {
    let e = e.clamp(DVec2::splat(-1.0), DVec2::ONE);
    let z = 1.0 - e.x.abs() - e.y.abs();
    if z >= 0.0 {
        return e.extend(z).normalize();
    }
    DVec3::new((1.0 - e.y.abs()) * sign(e.x), (1.0 - e.x.abs()) * sign(e.y), z).normalize()
}
