//! Source: OpenGL Programming Guide, "Hemisphere Lighting" and example 7.12.

use super::Source::Published;
use super::{CallArguments, Expected, ReferenceEntry};
use glam::DVec3;

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "ambient::hemisphere",
    functions: &[
        ("hemisphere_weight", Published, |a| weight(a.vec3(), a.vec3()).into()),
        ("hemisphere_weight_sine", Published, weight_sine),
        ("hemisphere", Published, |a| hemisphere(a.vec3(), a.vec3(), a.vec3(), a.vec3()).into()),
        ("hemisphere_oglpg", Published, hemisphere_oglpg),
    ],
};

fn weight(n: DVec3, up: DVec3) -> f64 {
    0.5 + 0.5 * n.dot(up)
}

/// 1 - sin(t)/2 for angles t between the two directions up to 90 degrees, sin(t)/2 beyond.
fn weight_sine(a: &mut CallArguments<'_>) -> Expected {
    let (n, up) = (a.vec3(), a.vec3());
    let half = 0.5 * n.cross(up).length();
    if n.dot(up) >= 0.0 { (1.0 - half).into() } else { half.into() }
}

fn hemisphere(n: DVec3, up: DVec3, sky: DVec3, ground: DVec3) -> DVec3 {
    ground.lerp(sky, weight(n, up))
}

fn hemisphere_oglpg(a: &mut CallArguments<'_>) -> Expected {
    let (n, p, light, sky, ground) = (a.vec3(), a.vec3(), a.vec3(), a.vec3(), a.vec3());
    hemisphere(n, (light - p).normalize(), sky, ground).into()
}
