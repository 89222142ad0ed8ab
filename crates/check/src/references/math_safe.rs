//! Sources: IEEE 754-2019, section 3.4; OpenGL Programming Guide, example 7.2.

use super::Source::Published;
use super::{CallArguments, Expected, ReferenceEntry};
use glam::DVec3;

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "math::safe",
    functions: &[
        ("safe_normalize", Published, safe_normalize),
        ("normalize_or_zero", Published, |a| a.vec3().normalize_or_zero().into()),
        ("cosine_power", Published, |a| safe_pow(a.f64(), a.f64()).into()),
        ("safe_pow", Published, |a| safe_pow(a.f64(), a.f64()).into()),
        ("saturate_color", Published, |a| a.vec3().clamp(DVec3::ZERO, DVec3::ONE).into()),
    ],
};

/// The normalised vector. A device may flush subnormal components to zero first, so that result is
/// accepted too. If every component is zero or subnormal, the result is the fallback.
fn safe_normalize(a: &mut CallArguments<'_>) -> Expected {
    let (v, fallback) = (a.vec3(), a.vec3());
    let smallest = f64::from(f32::MIN_POSITIVE);
    let flushed = v.map(|x| if x.abs() < smallest { 0.0 } else { x });
    match flushed.abs().max_element() {
        0.0 => fallback.into(),
        _ => Expected::from(v.normalize()).or(flushed.normalize()),
    }
}

/// `max(x, 0)^e`, with 0^0 = 1.
pub fn safe_pow(x: f64, e: f64) -> f64 {
    if e == 0.0 { 1.0 } else { x.max(0.0).powf(e) }
}
