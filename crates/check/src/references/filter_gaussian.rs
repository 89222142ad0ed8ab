//! Source: OpenGL: Build High Performance Graphics, recipe 7: exp(-i*i/16) over its sum, 21 taps.

use super::Source::Published;
use super::{CallArguments, Expected, ReferenceEntry};
use glam::DVec2;
use lamplight_execute::sampling;

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "filter::gaussian",
    functions: &[("gaussian21", Published, |a| weight(a.f64() as i32).into()), ("blur21", Published, blur)],
};

fn weight(i: i32) -> f64 {
    let bell = |i: i32| (-f64::from(i * i) / 16.0).exp();
    if i.abs() <= 10 { bell(i) / (-10..=10).map(bell).sum::<f64>() } else { 0.0 }
}

fn blur(a: &mut CallArguments<'_>) -> Expected {
    let (Some(map), Some(sampler)) = (a.texture(), a.sampler()) else { return f64::NAN.into() };
    let (uv, direction) = (a.vec2(), a.vec2());
    let step = direction / DVec2::new(f64::from(map.width), f64::from(map.height));
    let tap = |i: i32, channel| {
        weight(i) * sampling::read_channel(map, sampler, uv + f64::from(i) * step, channel)
    };
    Expected::words((0..4).map(|channel| (-10..=10).map(|i| tap(i, channel)).sum()))
}
