//! Sources: Newcastle University, tutorial 11 (face normals); Blinn, 1978, and glTF 2.0 (normal
//! maps with the bitangent's sign).

use super::{Arguments, Entry, Expected};
use glam::DVec3;

pub const REFERENCES: Entry = Entry {
    module: "surface::normal",
    functions: &[
        ("face_normal_area", |a| area(a.vec3(), a.vec3(), a.vec3()).into()),
        ("face_normal", |a| {
            area(a.vec3(), a.vec3(), a.vec3()).try_normalize().unwrap_or(DVec3::Z).into()
        }),
        ("perturb_normal", perturb),
    ],
};

/// (b - a) x (c - a).
fn area(a: DVec3, b: DVec3, c: DVec3) -> DVec3 {
    (b - a).cross(c - a)
}

/// The texel as a vector over tangent, bitangent and normal; the tangent made square to the normal.
fn perturb(a: &mut Arguments<'_>) -> Expected {
    let (n, tangent, sign, texel) = (a.vec3(), a.vec3(), a.f64(), a.vec3());
    let Some(t) = (tangent - n * n.dot(tangent)).try_normalize() else { return n.into() };
    let bent = 2.0 * texel - 1.0;
    let sum = t * bent.x + n.cross(t) * sign * bent.y + n * bent.z;
    sum.try_normalize().unwrap_or(n).into()
}
