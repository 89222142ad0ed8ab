//! Looks up texels of fixtures, in f64, for references that read textures.
//!
//! The rules are those of the Vulkan specification, "Texel Input Operations", for one level.

use glam::{DVec2, DVec3};

use super::fixture::{FixtureSampler, FixtureTexture};

/// The comparison's result, filtered as the sampler says: the weighted share of the texels that
/// pass.
pub fn compare_depth(map: &FixtureTexture, sampler: FixtureSampler, uv: DVec2, depth: f64) -> f64 {
    filter_texels(map, sampler, uv, 0, |stored| passes_comparison(sampler, depth, stored), 0)
}

/// The same for a direction into a cube map.
pub fn compare_cube(
    map: &FixtureTexture,
    sampler: FixtureSampler,
    direction: DVec3,
    depth: f64,
) -> f64 {
    let (face, uv) = cube_face(direction);
    filter_texels(map, sampler, uv, face, |stored| passes_comparison(sampler, depth, stored), 0)
}

/// One channel of a colour texture, filtered as the sampler says.
pub fn read_channel(
    map: &FixtureTexture,
    sampler: FixtureSampler,
    uv: DVec2,
    channel: usize,
) -> f64 {
    filter_texels(map, sampler, uv, 0, |stored| stored, channel)
}

fn passes_comparison(sampler: FixtureSampler, depth: f64, stored: f64) -> f64 {
    f64::from(u8::from(sampler.compare.is_some_and(|compare| compare.passes(depth, stored))))
}

fn filter_texels(
    map: &FixtureTexture,
    sampler: FixtureSampler,
    uv: DVec2,
    layer: u32,
    value: impl Fn(f64) -> f64,
    channel: usize,
) -> f64 {
    let at = uv * DVec2::new(f64::from(map.width), f64::from(map.height));
    let texel = |x: f64, y: f64| {
        let (x, y) =
            (sampler.address.wrap(x as i64, map.width), sampler.address.wrap(y as i64, map.height));
        value(map.texel(x, y, layer, channel))
    };
    if !sampler.linear {
        return texel(at.x.floor(), at.y.floor());
    }
    let (corner, part) = ((at - 0.5).floor(), (at - 0.5).fract_gl());
    let row = |y: f64| texel(corner.x, y) * (1.0 - part.x) + texel(corner.x + 1.0, y) * part.x;
    row(corner.y) * (1.0 - part.y) + row(corner.y + 1.0) * part.y
}

/// The face a direction hits (+x, -x, +y, -y, +z, -z) and the place on it, by the table of the
/// Vulkan specification, "Cube Map Face Selection".
fn cube_face(d: DVec3) -> (u32, DVec2) {
    let size = d.abs();
    let (face, s, t, major) = if size.z >= size.x && size.z >= size.y {
        if d.z >= 0.0 { (4, d.x, -d.y, size.z) } else { (5, -d.x, -d.y, size.z) }
    } else if size.y >= size.x {
        if d.y >= 0.0 { (2, d.x, d.z, size.y) } else { (3, d.x, -d.z, size.y) }
    } else if d.x >= 0.0 {
        (0, -d.z, -d.y, size.x)
    } else {
        (1, d.z, -d.y, size.x)
    };
    (face, DVec2::new(s, t) / major * 0.5 + 0.5)
}
