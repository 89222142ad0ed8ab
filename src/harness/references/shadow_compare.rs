//! Sources: OpenGL Programming Guide, example 7.21 (one comparison, linear filter); OpenGL: Build
//! High Performance Graphics, recipe 6 (3x3 and 5x5 taps, two texels apart).

use super::{Arguments, Entry, Expected};
use crate::harness::fixture::{Sampler, Texture};
use glam::DVec2;

pub const REFERENCES: Entry =
    Entry { module: "shadow::compare", functions: &[("hard", |a| grid(a, 0)), ("pcf_3x3", |a| grid(a, 1)), ("pcf_5x5", |a| grid(a, 2))] };

/// The mean of comparisons two texels apart; outside the map is lit.
fn grid(a: &mut Arguments<'_>, reach: i32) -> Expected {
    let (Some(map), Some(sampler)) = (a.texture(), a.sampler()) else { return f64::NAN.into() };
    let (uv, depth, inside) = (a.vec2(), a.f64(), a.bool());
    if !inside {
        return 1.0.into();
    }
    let step = 2.0 / DVec2::new(f64::from(map.width), f64::from(map.height));
    let taps = (-reach..=reach).flat_map(|y| (-reach..=reach).map(move |x| DVec2::new(f64::from(x), f64::from(y))));
    let sum: f64 = taps.map(|tap| compare(map, sampler, uv + tap * step, depth)).sum();
    (sum / f64::from((2 * reach + 1).pow(2))).into()
}

/// The share of the texels around a place that pass; places off the map are lit.
fn compare(map: &Texture, sampler: Sampler, uv: DVec2, depth: f64) -> f64 {
    if uv.min_element() < 0.0 || uv.max_element() > 1.0 {
        return 1.0;
    }
    let at = uv * DVec2::new(f64::from(map.width), f64::from(map.height));
    let passes = |x: f64, y: f64| {
        let (x, y) = (sampler.address.wrap(x as i64, map.width), sampler.address.wrap(y as i64, map.height));
        f64::from(u8::from(sampler.compare.is_some_and(|compare| compare.passes(depth, map.texel(x, y, 0, 0)))))
    };
    if !sampler.linear {
        return passes(at.x.floor(), at.y.floor());
    }
    let (corner, part) = ((at - 0.5).floor(), (at - 0.5).fract_gl());
    let row = |y: f64| passes(corner.x, y) * (1.0 - part.x) + passes(corner.x + 1.0, y) * part.x;
    row(corner.y) * (1.0 - part.y) + row(corner.y + 1.0) * part.y
}
