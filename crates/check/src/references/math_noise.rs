//! Sources: Jimenez, 2014 (interleaved gradient noise); Jarzynski and Olano, "Hash Functions for
//! GPU Rendering", 2020 (one step of PCG); OpenGL: Build High Performance Graphics, recipe 6 (the
//! sine); Vogel, 1979 (the golden angle); Roberts, 2018 (the sequence R2).

use super::Source::Published;
use super::{Expected, ReferenceEntry};
use glam::{DVec2, DVec4};
use std::f64::consts::{PI, TAU};

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "math::noise",
    functions: &[
        ("interleaved_gradient_noise", Published, |a| gradient_noise(a.vec2())),
        ("ign_time", Published, |a| gradient_noise(a.vec2() + 5.588238 * (a.f64() % 64.0))),
        ("hash_pcg", Published, |a| f64::from(hash(a.f64() as u32)).into()),
        ("pixel_seed", Published, |a| f64::from(pixel_seed(a.vec2())).into()),
        ("unit_float", Published, |a| unit(a.f64() as u32).into()),
        ("r2_sequence", Published, |a| r2(a.f64()).into()),
        ("random_hpg", Published, |a| random_hpg(a.vec4()).into()),
        ("vogel_disk", Published, |a| vogel_disk(a.f64(), a.f64(), a.f64()).into()),
    ],
};

/// fract(52.9829189*fract(dot(pixel, (0.06711056, 0.00583715)))). Rounding may move a value across
/// a whole number, so the values at both ends are accepted there.
fn gradient_noise(pixel: DVec2) -> Expected {
    let inner = pixel.dot(DVec2::new(0.06711056, 0.00583715));
    let noise = |inner: f64| (52.9829189 * inner).rem_euclid(1.0);
    let (value, part) = (noise(inner.rem_euclid(1.0)), inner.rem_euclid(1.0));
    let expected = Expected::from(value).or(value - 1.0).or(value + 1.0);
    if part.min(1.0 - part) < 1e-4 { expected.or(noise(1.0)).or(noise(0.0)) } else { expected }
}

/// A congruential step, then the permutation "random xorshift, multiply, xorshift".
pub fn hash(seed: u32) -> u32 {
    let state = seed.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = (state >> ((state >> 28) + 4) ^ state).wrapping_mul(277_803_737);
    word >> 22 ^ word
}

/// Nested: the hash of x plus the hash of y, whole pixels from 0.
pub fn pixel_seed(pixel: DVec2) -> u32 {
    hash((pixel.x as u32).wrapping_add(hash(pixel.y as u32)))
}

/// The upper 24 bits as a fraction.
pub fn unit(bits: u32) -> f64 {
    f64::from(bits >> 8) / f64::from(1 << 24)
}

/// fract(sin(dot(seed, (12.9898, 78.233, 45.164, 94.673)))*43758.5453). The constants are first
/// rounded to f32, since rounding them changes the result completely.
pub fn random_hpg(seed: DVec4) -> f64 {
    let sine =
        seed.dot(DVec4::from_array([12.9898f32, 78.233, 45.164, 94.673].map(f64::from))).sin();
    (sine * f64::from(43758.547f32)).rem_euclid(1.0)
}

/// A point at the radius sqrt((i + 1/2)/count) and the angle i*pi*(3 - sqrt(5)) + phi.
pub fn vogel_disk(i: f64, count: f64, phi: f64) -> DVec2 {
    let angle = (i * PI * (3.0 - 5f64.sqrt()) + phi).rem_euclid(TAU);
    ((i + 0.5) / count.max(1.0)).sqrt() * DVec2::from_angle(angle)
}

/// Point `i` of Roberts's sequence R2, in fixed point. Each coordinate is the fractional part of
/// 1/2 + i*a, with a = 1/p or 1/p^2 and p^3 = p + 1. `a` is rounded to 32 bits, and the result is
/// truncated to 24 bits.
fn r2(i: f64) -> DVec2 {
    let whole = 1u64 << 32;
    let part = |a: u64| ((whole / 2 + i as u64 * a) % whole / 256) as f64 / 16777216.0;
    DVec2::new(part(3242174889), part(2447445414))
}
