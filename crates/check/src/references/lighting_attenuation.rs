//! Sources: OpenGL Programming Guide, example 7.4; Newcastle University, tutorial 11; Lagarde and
//! de Rousiers, "Moving Frostbite to Physically Based Rendering", 2014; Karis, "Real Shading in
//! Unreal Engine 4", 2013; glTF extension KHR_lights_punctual; three.js.

use super::Source::{Published, Specification};
use super::ReferenceEntry;
use super::math_safe::safe_pow;
use glam::DVec3;

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "lighting::attenuation",
    functions: &[
        ("polynomial", Published, |a| polynomial(a.f64(), a.vec3()).into()),
        ("linear_radius", Published, |a| linear_radius(a.f64(), a.f64()).into()),
        ("inverse_square", Published, |a| (1.0 / a.f64().max(a.f64())).into()),
        ("window", Published, |a| window((a.f64() * a.f64()).powi(2)).into()),
        ("range_gltf", Specification, |a| range_gltf(a.f64(), a.f64()).into()),
        ("decay_cutoff", Published, |a| decay_cutoff(a.f64(), a.f64(), a.f64()).into()),
    ],
};

/// 1/(kc + kl*d + kq*d^2); no coefficients mean no attenuation.
pub fn polynomial(d: f64, k: DVec3) -> f64 {
    let sum = k.dot(DVec3::new(1.0, d, d * d));
    if sum == 0.0 { 1.0 } else { 1.0 / sum }
}

/// 1 - clamp(d/r, 0, 1); 0 for a radius of 0 or less.
fn linear_radius(d: f64, radius: f64) -> f64 {
    if radius <= 0.0 { 0.0 } else { 1.0 - (d / radius).clamp(0.0, 1.0) }
}

/// saturate(1 - x)^2 with x = (d/r)^4.
fn window(x: f64) -> f64 {
    (1.0 - x).clamp(0.0, 1.0).powi(2)
}

/// The window before it is squared; 1 without a range.
fn range_gltf(d: f64, range: f64) -> f64 {
    if range <= 0.0 { 1.0 } else { (1.0 - (d / range).powi(4)).clamp(0.0, 1.0) }
}

/// 1/max(d^decay, 0.01), times the window of the cutoff, if there is one.
fn decay_cutoff(d: f64, cutoff: f64, decay: f64) -> f64 {
    let falloff = 1.0 / safe_pow(d, decay).max(0.01);
    if cutoff <= 0.0 { falloff } else { falloff * window((d / cutoff).powi(4)) }
}
