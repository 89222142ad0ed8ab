//! Sources: Crow, 1984; Lauritzen, GPU Gems 3, 2007, chapter 8. The map is found again from its table,
//! and every texel is weighed by how much of it lies in the rectangle.

use super::Source::Integral;
use super::{CallArguments, Expected, ReferenceEntry};
use glam::DVec2;
use lamplight_execute::fixture::FixtureTexture;

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "shadow::summed",
    functions: &[
        ("summed_corner", Integral, corner),
        ("summed_moments", Integral, |a| match read_square(a) {
            Some(moments) => moments.into(),
            None => f64::NAN.into(),
        }),
        ("savsm", Integral, savsm),
    ],
};

/// What was summed at a texel: the sum up to it, less the sums up to its neighbours before it.
fn texel(table: &FixtureTexture, x: u32, y: u32) -> DVec2 {
    let sum = |x: Option<u32>, y: Option<u32>| match (x, y) {
        (Some(x), Some(y)) => DVec2::new(table.texel(x, y, 0, 0), table.texel(x, y, 0, 1)),
        _ => DVec2::ZERO,
    };
    let (left, above) = (x.checked_sub(1), y.checked_sub(1));
    sum(Some(x), Some(y)) - sum(left, Some(y)) - sum(Some(x), above) + sum(left, above)
}

/// The sum of all texels, each by the area of it that lies in the rectangle.
fn summed(table: &FixtureTexture, low: DVec2, high: DVec2) -> DVec2 {
    let places = (0..table.height).flat_map(|y| (0..table.width).map(move |x| (x, y)));
    let part = |(x, y): (u32, u32)| {
        let first = DVec2::new(f64::from(x), f64::from(y));
        let sides = (high.min(first + 1.0) - low.max(first)).max(DVec2::ZERO);
        texel(table, x, y) * (sides.x * sides.y)
    };
    places.map(part).sum()
}

fn size(table: &FixtureTexture) -> DVec2 {
    DVec2::new(f64::from(table.width), f64::from(table.height))
}

fn corner(a: &mut CallArguments<'_>) -> Expected {
    let (Some(table), Some(_)) = (a.texture(), a.sampler()) else { return f64::NAN.into() };
    summed(table, DVec2::ZERO, a.vec2()).into()
}

/// The mean over the part of the square that is on the map.
fn square(table: &FixtureTexture, uv: DVec2, width: f64, mean: DVec2) -> DVec2 {
    let middle = uv.clamp(DVec2::ZERO, DVec2::ONE) * size(table);
    let half = width.max(1.0) / 2.0;
    let (low, high) = ((middle - half).max(DVec2::ZERO), (middle + half).min(size(table)));
    summed(table, low, high) / ((high.x - low.x) * (high.y - low.y)) + mean
}

fn read_square(a: &mut CallArguments<'_>) -> Option<DVec2> {
    let (table, _) = (a.texture()?, a.sampler()?);
    Some(square(table, a.vec2(), a.f64(), a.vec2()))
}

/// Chebyshev's bound for the mean moments: beyond the mean, `var/(var + (t - m1)^2)`.
fn savsm(a: &mut CallArguments<'_>) -> Expected {
    let (Some(table), Some(_)) = (a.texture(), a.sampler()) else { return f64::NAN.into() };
    let (uv, depth, inside) = (a.vec2(), a.f64(), a.bool());
    let (width, mean, min_variance, bleed) = (a.f64(), a.vec2(), a.f64(), a.f64());
    let m = square(table, uv, width, mean);
    let beyond = depth - m.x;
    if !inside || beyond <= 0.0 {
        return 1.0.into();
    }
    let variance = (m.y - m.x * m.x).max(min_variance).max(f64::from(f32::MIN_POSITIVE));
    let bound = variance / (variance + beyond * beyond);
    if bleed >= 1.0 { 0.0.into() } else { ((bound - bleed) / (1.0 - bleed)).clamp(0.0, 1.0).into() }
}
