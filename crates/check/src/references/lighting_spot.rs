//! Sources: OpenGL Programming Guide, example 7.5 (inclusive, exponent); OpenGL: Build High
//! Performance Graphics, recipe 4, and Igalia, part I (exclusive); glTF extension
//! KHR_lights_punctual (scale and offset).

use super::Source::{Published, Specification};
use super::ReferenceEntry;
use super::math_safe::safe_pow;

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "lighting::spot",
    functions: &[
        ("cone_hard", Published, |a| (a.f64() >= a.f64()).into()),
        ("cone_hard_exclusive", Published, |a| (a.f64() > a.f64()).into()),
        ("cone_exponent", Published, |a| cone_exponent(a.f64(), a.f64(), a.f64()).into()),
        ("cone_smooth", Published, |a| cone_smooth(a.f64(), a.f64(), a.f64()).into()),
        ("cone_scale_offset", Specification, |a| (a.f64() * a.f64() + a.f64()).clamp(0.0, 1.0).powi(2).into()),
    ],
};

/// c^e inside the cone, its edge included; a negative cosine counts as 0.
pub fn cone_exponent(c: f64, cutoff: f64, e: f64) -> f64 {
    if c < cutoff { 0.0 } else { safe_pow(c, e) }
}

/// Smoothstep from `outer` to `inner`; a hard cone where they do not differ.
fn cone_smooth(c: f64, inner: f64, outer: f64) -> f64 {
    if inner <= outer {
        return if c >= outer { 1.0 } else { 0.0 };
    }
    let t = ((c - outer) / (inner - outer)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
