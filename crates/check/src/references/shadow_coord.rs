//! Sources: OpenGL Programming Guide, examples 7.16, 7.19 and 7.20; OpenGL: Build High Performance
//! Graphics, recipe 5 (the guard on w); Igalia, part II (the depth view); Gerasimov, GPU Gems,
//! chapter 12 (the largest component is the distance along the face's axis).

use super::Source::Published;
use super::{CallArguments, Expected, ReferenceEntry};
use glam::DVec4;

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "shadow::coord",
    functions: &[
        ("is_on_map", Published, |a| {
            [a.f64(), a.f64()].iter().all(|value| (0.0..=1.0).contains(value)).into()
        }),
        ("shadow_coord", Published, shadow_coord),
        ("project", Published, |a| project(a.vec4(), a.f64())),
        ("project_gl", Published, project_gl),
        ("linearize_depth", Published, linearize_depth),
        ("depth_view_igl", Published, |a| (1.0 - (1.0 - a.f64()) * 100.0).into()),
        ("cube_depth", Published, cube_depth),
        ("paraboloid_uv", Published, paraboloid_uv),
    ],
};

fn shadow_coord(a: &mut CallArguments<'_>) -> Expected {
    let (matrix, p) = (a.mat4(), a.vec3());
    Expected::words((matrix * p.extend(1.0)).to_array())
}

/// u = x/2 + 1/2, v = 1/2 - y/2, depth = z, after division by w; rows of the map from the top.
fn project(clip: DVec4, min_w: f64) -> Expected {
    if clip.w <= min_w.max(0.0) {
        return Expected::words([0.0; 4]);
    }
    let ndc = clip / clip.w;
    let (u, v) = (0.5 * ndc.x + 0.5, 0.5 - 0.5 * ndc.y);
    let inside = [u, v, ndc.z].iter().all(|value| (0.0..=1.0).contains(value));
    Expected::words([u, v, ndc.z, f64::from(u8::from(inside))])
}

/// OpenGL's bias matrix: everything scaled and moved by one half.
fn project_gl(a: &mut CallArguments<'_>) -> Expected {
    let (clip, min_w) = (a.vec4(), a.f64());
    if clip.w <= min_w.max(0.0) {
        return Expected::words([0.0; 4]);
    }
    let at = clip / clip.w * 0.5 + DVec4::splat(0.5);
    let inside = [at.x, at.y, at.z].iter().all(|value| (0.0..=1.0).contains(value));
    Expected::words([at.x, at.y, at.z, f64::from(u8::from(inside))])
}

/// n*f/(f - d*(f - n)).
fn linearize_depth(a: &mut CallArguments<'_>) -> Expected {
    let (d, near, far) = (a.f64(), a.f64(), a.f64());
    (near * far / (far - d * (far - near))).into()
}

/// f/(f - n)*(z - n)/z, the perspective depth at z = max(|x|, |y|, |z|), at least n.
fn cube_depth(a: &mut CallArguments<'_>) -> Expected {
    let (offset, near, far) = (a.vec3(), a.f64(), a.f64());
    let z = offset.abs().max_element().max(near);
    (far / (far - near) * (z - near) / z).into()
}

/// The tangent of half the angle to the axis, in the direction of the point.
fn paraboloid_uv(a: &mut CallArguments<'_>) -> Expected {
    let p = a.vec3();
    let across = p.truncate();
    let at = across.normalize_or_zero() * (across.length().atan2(p.z) / 2.0).tan();
    Expected::words([0.5 + 0.5 * at.x, 0.5 - 0.5 * at.y, p.length()])
}
