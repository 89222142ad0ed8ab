//! Sources: Newcastle University, tutorial 11 (face normals); Blinn, 1978, and glTF 2.0 (normal
//! maps and tangents with the bitangent's sign); Hill, 2012 (blending).

use super::Source::{Published, Specification};
use super::{CallArguments, Expected, ReferenceEntry};
use glam::{DMat3, DQuat, DVec2, DVec3};

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "surface::normal",
    functions: &[
        ("face_normal_area", Published, |a| area(a.vec3(), a.vec3(), a.vec3()).into()),
        ("face_normal", Published, |a| {
            area(a.vec3(), a.vec3(), a.vec3()).try_normalize().unwrap_or(DVec3::Z).into()
        }),
        ("perturb_normal", Published, perturb),
        ("blend_rnm", Published, blend_rnm),
        ("spheremap_encode", Published, |a| spheremap(a.vec3()).into()),
        ("spheremap_decode", Published, |a| from_spheremap(a.vec2()).into()),
        ("blend_udn", Published, |a| slopes(a, |_| 1.0)),
        ("blend_whiteout", Published, |a| slopes(a, |detail| detail.z)),
        ("world_tangent", Specification, world_tangent),
    ],
};

/// (b - a) x (c - a).
fn area(a: DVec3, b: DVec3, c: DVec3) -> DVec3 {
    (b - a).cross(c - a)
}

/// The texel as a vector over tangent, bitangent and normal. The tangent is first made
/// perpendicular to the normal.
fn perturb(a: &mut CallArguments<'_>) -> Expected {
    let (n, tangent, sign, texel) = (a.vec3(), a.vec3(), a.f64(), a.vec3());
    let Some(t) = (tangent - n * n.dot(tangent)).try_normalize() else { return n.into() };
    let bent = 2.0 * texel - 1.0;
    let sum = t * bent.x + n.cross(t) * sign * bent.y + n * bent.z;
    sum.try_normalize().unwrap_or(n).into()
}

/// The detail turned by the rotation that takes z to the base.
fn blend_rnm(a: &mut CallArguments<'_>) -> Expected {
    let (base, detail) = (a.vec3(), a.vec3());
    if base == DVec3::ZERO || base.z + 1.0 <= 1e-6 {
        return base.into();
    }
    let turned = DQuat::from_rotation_arc(DVec3::Z, base.normalize()) * detail;
    turned.try_normalize().unwrap_or(base).into()
}

/// x and y are the sums of both; z is that of the base times a `height` of the detail.
fn slopes(a: &mut CallArguments<'_>, height: fn(DVec3) -> f64) -> Expected {
    let (base, detail) = (a.vec3(), a.vec3());
    let sum = DVec3::new(base.x + detail.x, base.y + detail.y, base.z * height(detail));
    sum.try_normalize().unwrap_or(base).into()
}

/// An equal-area map: the radius is half the sine of half the angle to z.
fn spheremap(n: DVec3) -> DVec2 {
    let half_angle = n.truncate().length().atan2(n.z) / 2.0;
    n.truncate().normalize_or_zero() * half_angle.sin() / 2.0 + 0.5
}

fn from_spheremap(e: DVec2) -> DVec3 {
    let radius = (2.0 * (e - 0.5).length()).min(1.0);
    let angle = 2.0 * radius.asin();
    ((e - 0.5).normalize_or_zero() * angle.sin()).extend(angle.cos())
}

/// The tangent, moved as a difference of two points is. The sign is the one with which the normal and
/// the tangent in the world give the bitangent that is moved so too.
fn world_tangent(a: &mut CallArguments<'_>) -> Expected {
    let (tangent, moved) = (a.vec4(), DMat3::from_mat4(a.mat4()));
    let along = if tangent.truncate() == DVec3::ZERO { DVec3::X } else { tangent.truncate() };
    let normal = along.any_orthogonal_vector();
    let bitangent = moved * normal.cross(along);
    let in_world = (moved.inverse().transpose() * normal).cross(moved * along);
    let side = if in_world.dot(bitangent) < 0.0 { -1.0 } else { 1.0 };
    (moved * tangent.truncate()).extend(side * tangent.w).into()
}
