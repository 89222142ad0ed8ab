//! Sources: IEC 61966-2-1:1999; Reinhard et al., 2002, equation 3; Narkowicz, 2016; OpenGL 2.1
//! specification, section 3.10 (fog).

use super::{Entry, Expected};
use glam::DVec3;

pub const REFERENCES: Entry = Entry {
    module: "color::transfer",
    functions: &[
        ("srgb_from_linear_channel", |a| encode(a.f64())),
        ("linear_from_srgb_channel", |a| decode(a.f64())),
        ("srgb_from_linear", |a| each(a.vec3(), encode)),
        ("linear_from_srgb", |a| each(a.vec3(), decode)),
        ("tonemap_reinhard", |a| each(a.vec3(), |x| (x.max(0.0) / (1.0 + x.max(0.0))).into())),
        ("tonemap_aces", |a| each(a.vec3(), aces)),
        ("fog_linear", |a| fog_linear(a.f64(), a.f64(), a.f64()).into()),
        ("fog_exp", |a| (-(a.f64() * a.f64()).max(0.0)).exp().into()),
        ("fog_exp2", |a| (-(a.f64() * a.f64()).powi(2)).exp().into()),
    ],
};

fn each(c: DVec3, f: fn(f64) -> Expected) -> Expected {
    Expected::words(c.to_array().into_iter().flat_map(|x| f(x).value))
}

fn encode(x: f64) -> Expected {
    let value = if x <= 0.0031308 { 12.92 * x.max(0.0) } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
    value.into()
}

fn decode(x: f64) -> Expected {
    let value = if x <= 0.04045 { x.max(0.0) / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) };
    value.into()
}

/// The fit, whose inputs end where it has reached 1.
fn aces(x: f64) -> Expected {
    let x = x.clamp(0.0, 65504.0);
    ((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14)).clamp(0.0, 1.0).into()
}

/// A hard edge at `end` where the fog has no depth.
fn fog_linear(d: f64, start: f64, end: f64) -> f64 {
    match end > start {
        true => ((end - d) / (end - start)).clamp(0.0, 1.0),
        false => f64::from(u8::from(d <= end)),
    }
}
