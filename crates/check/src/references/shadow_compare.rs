//! Sources: OpenGL Programming Guide, example 7.21 (one comparison, linear filter); OpenGL: Build
//! High Performance Graphics, recipe 6 (3x3 and 5x5 taps two texels apart, 16 random taps);
//! Castaño, 2013 (the 1-2-1 and 1-3-4-3-1 bells); Vogel, 1979 (the disk); Fernando, 2005 (blockers
//! and penumbra); Gerasimov, GPU Gems, chapter 12 (the cube).

use super::Source::Published;
use super::math_noise::{hash, pixel_seed, random_hpg, unit, vogel_disk};
use super::{CallArguments, Expected, ReferenceEntry};
use glam::{DVec2, DVec4};
use lamplight_execute::fixture::{FixtureSampler, FixtureTexture};
use lamplight_execute::sampling;

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "shadow::compare",
    functions: &[
        ("compare_tap", Published, compare_tap),
        ("hard", Published, |a| averaged(a, |_, _| vec![(1.0, DVec2::ZERO)])),
        ("pcf_grid", Published, |a| averaged(a, |a, _| bell(&vec![1.0; 2 * a.f64() as usize + 1], 2.0))),
        ("pcf_3x3", Published, |a| averaged(a, |_, _| bell(&[1.0; 3], 2.0))),
        ("pcf_5x5", Published, |a| averaged(a, |_, _| bell(&[1.0; 5], 2.0))),
        ("pcf_castano_3", Published, |a| averaged(a, |_, _| bell(&[1.0, 2.0, 1.0], 1.0))),
        ("castano_row", Published, castano_row),
        ("pcf_castano_5", Published, |a| averaged(a, |_, _| bell(&[1.0, 3.0, 4.0, 3.0, 1.0], 1.0))),
        ("pcf_random16", Published, |a| shrunk(a, random16)),
        ("pcf_random16_hpg", Published, random16_hpg),
        ("pcf_vogel", Published, |a| shrunk(a, vogel)),
        ("mean_blocker", Published, mean_blocker),
        ("pcss", Published, pcss),
        ("cube_compare", Published, cube_compare),
    ],
};

/// Weight and offset in texels.
type Taps = Vec<(f64, DVec2)>;

/// The shadow coordinates of a point.
#[derive(Clone, Copy)]
struct At {
    uv: DVec2,
    depth: f64,
    inside: bool,
}

impl At {
    fn read(a: &mut CallArguments<'_>) -> Self {
        Self { uv: a.vec2(), depth: a.f64(), inside: a.bool() }
    }
}

fn size(map: &FixtureTexture) -> DVec2 {
    DVec2::new(f64::from(map.width), f64::from(map.height))
}

/// The share of the texels around a place that pass; places off the map are lit.
fn compare(map: &FixtureTexture, sampler: FixtureSampler, uv: DVec2, depth: f64) -> f64 {
    let is_on_map = uv.min_element() >= 0.0 && uv.max_element() <= 1.0;
    if is_on_map { sampling::compare_depth(map, sampler, uv, depth) } else { 1.0 }
}

fn compare_tap(a: &mut CallArguments<'_>) -> Expected {
    let (Some(map), Some(sampler)) = (a.texture(), a.sampler()) else { return f64::NAN.into() };
    compare(map, sampler, a.vec2(), a.f64()).into()
}

/// The weighted mean of the comparisons at all taps; 1, lit, for a point outside the map.
fn averaged(a: &mut CallArguments<'_>, taps: fn(&mut CallArguments<'_>, &At) -> Taps) -> Expected {
    let (Some(map), Some(sampler)) = (a.texture(), a.sampler()) else { return f64::NAN.into() };
    let at = At::read(a);
    let taps = taps(a, &at);
    if at.inside { mean(map, sampler, at, &taps).into() } else { 1.0.into() }
}

fn mean(map: &FixtureTexture, sampler: FixtureSampler, at: At, taps: &Taps) -> f64 {
    let tap = |(weight, offset): &(f64, DVec2)| {
        weight * compare(map, sampler, at.uv + *offset / size(map), at.depth)
    };
    taps.iter().map(tap).sum::<f64>() / taps.iter().map(|(weight, _)| weight).sum::<f64>()
}

/// Taps in a square grid, `step` texels apart. The weight of each is the product of those of its
/// column and its row.
fn bell(weights: &[f64], step: f64) -> Taps {
    let place = |index: usize| (index as f64 - (weights.len() / 2) as f64) * step;
    let row = |y: usize| {
        weights
            .iter()
            .enumerate()
            .map(move |(x, weight)| (weight * weights[y], DVec2::new(place(x), place(y))))
    };
    (0..weights.len()).flat_map(row).collect()
}

/// Sixteen random offsets in the square of half side `radius`, by a chain of hashes that starts
/// with the seed of the pixel.
fn random16(a: &mut CallArguments<'_>) -> (f64, Taps) {
    let (radius, pixel) = (a.f64(), a.vec2());
    let mut state = pixel_seed(pixel);
    let mut next = || {
        state = hash(state);
        2.0 * unit(state) - 1.0
    };
    (radius, (0..16).map(|_| (1.0, radius * DVec2::new(next(), next()))).collect())
}

fn vogel(a: &mut CallArguments<'_>) -> (f64, Taps) {
    let (count, radius, phi) = (a.f64(), a.f64(), a.f64());
    (radius, disk(count, radius, phi))
}

/// The mean over taps that reach up to a radius in each direction, or to the nearer edge of the map.
fn shrunk(a: &mut CallArguments<'_>, taps: fn(&mut CallArguments<'_>) -> (f64, Taps)) -> Expected {
    let (Some(map), Some(sampler)) = (a.texture(), a.sampler()) else { return f64::NAN.into() };
    let at = At::read(a);
    let (radius, taps) = taps(a);
    if at.inside { shrunk_mean(map, sampler, at, radius, taps).into() } else { 1.0.into() }
}

fn shrunk_mean(
    map: &FixtureTexture,
    sampler: FixtureSampler,
    at: At,
    radius: f64,
    taps: Taps,
) -> f64 {
    let room = at.uv.min(1.0 - at.uv) * size(map);
    let share = (room / radius.abs().max(1e-30)).min(DVec2::ONE);
    let taps = taps.into_iter().map(|(weight, offset)| (weight, offset * share)).collect();
    mean(map, sampler, at, &taps)
}

/// The mean of sixteen comparisons at random places to the right and below, up to a quarter of the
/// map over `w` away. Sines of the pixel give the places.
fn random16_hpg(a: &mut CallArguments<'_>) -> Expected {
    let (Some(map), Some(sampler)) = (a.texture(), a.sampler()) else { return f64::NAN.into() };
    let (sc, least, pixel) = (a.vec4(), a.f64(), a.vec2());
    let ndc = sc.truncate() / sc.w;
    let uv = DVec2::new(0.5 + 0.5 * ndc.x, 0.5 - 0.5 * ndc.y);
    let is_inside = sc.w > least.max(0.0)
        && ndc.x.abs() <= 1.0
        && ndc.y.abs() <= 1.0
        && (0.0..=1.0).contains(&ndc.z);
    let place = |i: u32| {
        let sines = [(pixel.x, pixel.y), (pixel.y, pixel.x)]
            .map(|(x, y)| random_hpg(DVec4::new(x, y, x, f64::from(i))));
        uv + 0.25 * DVec2::from_array(sines) / sc.w
    };
    let mean = || (0..16).map(|i| compare(map, sampler, place(i), ndc.z)).sum::<f64>() / 16.0;
    if is_inside { mean().into() } else { 1.0.into() }
}

/// `count` offsets in the disk, at least one.
fn disk(count: f64, radius: f64, phi: f64) -> Taps {
    (0..count.max(1.0) as u32)
        .map(|i| (1.0, radius * vogel_disk(f64::from(i), count, phi)))
        .collect()
}

fn castano_row(a: &mut CallArguments<'_>) -> Expected {
    let (Some(map), Some(sampler)) = (a.texture(), a.sampler()) else { return f64::NAN.into() };
    let (columns, v, weights, depth) = (a.vec3(), a.f64(), a.vec3(), a.f64());
    let is_off = |i: usize| (i == 0 && columns.x < 0.0) || (i == 2 && columns.z > 1.0);
    let visible = |i: usize| match is_off(i) {
        true => 1.0,
        false => sampling::compare_depth(map, sampler, DVec2::new(columns[i], v), depth),
    };
    (0..3).map(|i| weights[i] * visible(i)).sum::<f64>().into()
}

/// The distinct depths that a sample may read if its place is off by up to so many texels.
fn depths_around(map: &FixtureTexture, sampler: FixtureSampler, uv: DVec2, off: f64) -> Vec<f64> {
    let sides = [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)];
    let mut depths: Vec<f64> = sides
        .map(|(x, y)| {
            sampling::read_channel(map, sampler, uv + off * DVec2::new(x, y) / size(map), 0)
        })
        .into();
    depths.sort_by(f64::total_cmp);
    depths.dedup();
    depths
}

/// The means that are accepted, each of the samples that are nearer than the point; the point's own
/// depth if none is. A device's sine and cosine may be off by 2^-11, and places by a ten-thousandth
/// of a texel. Where such an error changes which texel is read, either texel is right.
fn blockers(
    map: &FixtureTexture,
    sampler: FixtureSampler,
    at: At,
    radius: f64,
    phi: f64,
) -> Vec<f64> {
    let off = radius * (-11f64).exp2() + 1e-4;
    let mut sums = vec![(0u32, 0.0)];
    for (_, offset) in disk(16.0, radius, phi) {
        let depths = depths_around(map, sampler, at.uv + offset / size(map), off);
        let add = |(count, sum): &(u32, f64), depth: f64| {
            if depth < at.depth { (count + 1, sum + depth) } else { (*count, *sum) }
        };
        sums = sums.iter().flat_map(|sum| depths.iter().map(|depth| add(sum, *depth))).collect();
        sums.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        sums.dedup_by(|a, b| a.0 == b.0 && (a.1 - b.1).abs() < 1e-12);
    }
    sums.into_iter()
        .map(|(count, sum)| if count == 0 { at.depth } else { sum / f64::from(count) })
        .collect()
}

/// Accepts any of the values.
fn one_of(values: impl IntoIterator<Item = f64>) -> Expected {
    let mut values = values.into_iter();
    let first = values.next().unwrap_or(f64::NAN);
    values.fold(first.into(), Expected::or)
}

fn mean_blocker(a: &mut CallArguments<'_>) -> Expected {
    let (Some(map), Some(sampler)) = (a.texture(), a.sampler()) else { return f64::NAN.into() };
    let (at, radius, phi) = (At::read(a), a.f64(), a.f64());
    one_of(blockers(map, sampler, at, radius, phi))
}

/// penumbra = (receiver - blocker)*light/blocker, between one texel and the light's size.
fn pcss(a: &mut CallArguments<'_>) -> Expected {
    let (Some(map), Some(sampler)) = (a.texture(), a.sampler()) else { return f64::NAN.into() };
    let (Some(depths), Some(plain)) = (a.texture(), a.sampler()) else { return f64::NAN.into() };
    let (at, light, phi) = (At::read(a), a.f64().max(1.0), a.f64());
    if !at.inside {
        return 1.0.into();
    }
    let visible = |blocker: f64| {
        if blocker >= at.depth {
            return 1.0;
        }
        let penumbra = (at.depth - blocker) * light / blocker.max(0.001);
        let radius = penumbra.clamp(1.0, light);
        shrunk_mean(map, sampler, at, radius, disk(16.0, radius, phi))
    };
    one_of(blockers(depths, plain, at, light, phi).into_iter().map(visible))
}

fn cube_compare(a: &mut CallArguments<'_>) -> Expected {
    let (Some(map), Some(sampler)) = (a.texture(), a.sampler()) else { return f64::NAN.into() };
    let (offset, depth) = (a.vec3(), a.f64());
    if !(0.0..=1.0).contains(&depth) {
        return 1.0.into();
    }
    sampling::compare_cube(map, sampler, offset, depth).into()
}
