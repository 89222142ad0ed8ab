//! Sources: OpenGL Programming Guide, example 7.18 (the slope of polygon offset); OpenGL: Build
//! High Performance Graphics, recipe 7 (a constant); Holbert, 2011 (normal offset); Isidoro, 2006
//! (receiver plane).

use super::Source::Published;
use super::{CallArguments, Expected, ReferenceEntry};
use glam::{DMat2, DVec2};

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "shadow::bias",
    functions: &[
        ("constant_bias", Published, |a| (a.f64() - a.f64()).into()),
        ("slope_bias", Published, |a| slope(a.f64(), a.f64(), a.f64()).into()),
        ("normal_offset", Published, normal_offset),
        ("receiver_plane", Published, receiver_plane),
        ("cube_texel", Published, |a| cube_texel(a.f64(), a.f64()).into()),
        ("cube_bias", Published, cube_bias),
    ],
};

/// min(b*tan(angle), limit); `limit` where the light is at or below the horizon.
fn slope(cosine: f64, b: f64, limit: f64) -> f64 {
    if cosine > 0.0 { (b * cosine.min(1.0).acos().tan()).min(limit) } else { limit }
}

/// The point moved along the normal of the side that the light is on, by the sine of its angle to the
/// light.
fn normal_offset(a: &mut CallArguments<'_>) -> Expected {
    let (p, n, l, texel, scale) = (a.vec3(), a.vec3(), a.vec3(), a.f64(), a.f64());
    let side = if n.dot(l) < 0.0 { -n } else { n };
    (p + side * (scale * texel * n.cross(l).length())).into()
}

/// The gradient g with dot(g, duv_dx) = dz.x and dot(g, duv_dy) = dz.y.
fn receiver_plane(a: &mut CallArguments<'_>) -> Expected {
    let (dx, dy, dz) = (a.vec2(), a.vec2(), a.vec2());
    let rows = DMat2::from_cols(dx, dy).transpose();
    if rows.determinant().abs() < 1e-30 { DVec2::ZERO.into() } else { (rows.inverse() * dz).into() }
}

/// The width of a texel: a face of the cube at distance d is 2*d wide.
fn cube_texel(d: f64, size: f64) -> f64 {
    2.0 * d / size.max(1.0)
}

fn cube_bias(a: &mut CallArguments<'_>) -> Expected {
    let texel = cube_texel(a.f64().max(0.0), a.f64());
    slope(a.f64(), texel, 8.0 * texel).into()
}
