//! Sources: IEC 61966-2-1:1999; Reinhard et al., 2002, equation 3; Narkowicz, 2016; OpenGL 2.1
//! specification, section 3.10 (fog); SMPTE ST 2084:2014; ITU-R BT.2100-2; Roberts, 1962.

use super::Source::{Published, Specification};
use super::{Expected, ReferenceEntry};
use glam::{DMat3, DVec3};

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "color::transfer",
    functions: &[
        ("srgb_from_linear_channel", Specification, |a| encode(a.f64())),
        ("linear_from_srgb_channel", Specification, |a| decode(a.f64())),
        ("srgb_from_linear", Specification, |a| each(a.vec3(), encode)),
        ("linear_from_srgb", Specification, |a| each(a.vec3(), decode)),
        ("tonemap_reinhard", Published, |a| each(a.vec3(), |x| (x.max(0.0) / (1.0 + x.max(0.0))).into())),
        ("tonemap_aces", Published, |a| each(a.vec3(), aces)),
        ("pq_from_nits", Specification, |a| pq(a.f64()).into()),
        ("nits_from_pq", Specification, |a| nits(a.f64()).into()),
        ("hlg_from_linear", Specification, |a| hlg(a.f64()).into()),
        ("linear_from_hlg", Specification, |a| from_hlg(a.f64()).into()),
        ("ictcp_from_nits", Specification, |a| ictcp(a.vec3()).into()),
        ("nits_from_ictcp", Specification, |a| from_ictcp(a.vec3()).into()),
        ("dither", Published, |a| dither(a.vec3(), a.f64(), a.f64()).into()),
        ("fog_linear", Specification, |a| fog_linear(a.f64(), a.f64(), a.f64()).into()),
        ("fog_exp", Specification, |a| (-(a.f64() * a.f64()).max(0.0)).exp().into()),
        ("fog_exp2", Specification, |a| (-(a.f64() * a.f64()).powi(2)).exp().into()),
        ("fog_scale_offset", Published, |a| (a.f64() * a.f64() + a.f64()).clamp(0.0, 1.0).into()),
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

/// The fit. Inputs are clamped to 65504, where its value has long reached 1.
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

/// Exponents m1, m2 and coefficients c1, c2, c3 of the perceptual quantiser.
const PQ: [f64; 5] = [
    2610.0 / 16384.0,
    2523.0 / 4096.0 * 128.0,
    3424.0 / 4096.0,
    2413.0 / 4096.0 * 32.0,
    2392.0 / 4096.0 * 32.0,
];

/// Encodes: ((c1 + c2*Y^m1)/(1 + c3*Y^m1))^m2 with Y = nits/10000.
fn pq(nits: f64) -> f64 {
    let [m1, m2, c1, c2, c3] = PQ;
    let y = (nits / 10000.0).clamp(0.0, 1.0).powf(m1);
    ((c1 + c2 * y) / (1.0 + c3 * y)).powf(m2)
}

/// Decodes: (max(N^(1/m2) - c1, 0)/(c2 - c3*N^(1/m2)))^(1/m1), times 10000.
fn nits(code: f64) -> f64 {
    let [m1, m2, c1, c2, c3] = PQ;
    let x = code.clamp(0.0, 1.0).powf(1.0 / m2);
    10000.0 * ((x - c1).max(0.0) / (c2 - c3 * x)).powf(1.0 / m1)
}

/// The constants of the hybrid log-gamma curve: a, b = 1 - 4*a and c = 1/2 - a*ln(4*a).
fn log_gamma() -> [f64; 3] {
    let a = 0.17883277;
    [a, 1.0 - 4.0 * a, 0.5 - a * (4.0 * a).ln()]
}

fn hlg(e: f64) -> f64 {
    let ([a, b, c], e) = (log_gamma(), e.clamp(0.0, 1.0));
    if e <= 1.0 / 12.0 { (3.0 * e).sqrt() } else { a * (12.0 * e - b).ln() + c }
}

fn from_hlg(code: f64) -> f64 {
    let ([a, b, c], x) = (log_gamma(), code.clamp(0.0, 1.0));
    if x <= 0.5 { x * x / 3.0 } else { (((x - c) / a).exp() + b) / 12.0 }
}

/// The colour with noise of one quantisation step added, centred on 0.
fn dither(c: DVec3, noise: f64, steps: f64) -> DVec3 {
    let step = 1.0 / steps.max(1.0);
    (c + DVec3::splat(step * noise - step / 2.0)).clamp(DVec3::ZERO, DVec3::ONE)
}

/// The matrices from linear Rec. 2020 to LMS, and from LMS encoded with PQ to ICtCp. They are
/// written row by row, in units of 1/4096.
fn ictcp_matrices() -> [DMat3; 2] {
    let responses = [1688.0, 2146.0, 262.0, 683.0, 2951.0, 462.0, 99.0, 309.0, 3688.0];
    let parts = [2048.0, 2048.0, 0.0, 6610.0, -13613.0, 7003.0, 17933.0, -17390.0, -543.0];
    [responses, parts].map(|rows| DMat3::from_cols_array(&rows).transpose() * (1.0 / 4096.0))
}

pub fn ictcp(c: DVec3) -> DVec3 {
    let [responses, parts] = ictcp_matrices();
    parts * (responses * c).map(pq)
}

pub fn from_ictcp(c: DVec3) -> DVec3 {
    let [responses, parts] = ictcp_matrices();
    (responses.inverse() * (parts.inverse() * c).map(nits)).max(DVec3::ZERO)
}
