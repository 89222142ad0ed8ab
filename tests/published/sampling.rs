//! Textures as OpenGL and Vulkan read them, in f64.

use glam::{DVec2, DVec3, DVec4};
use lamplight::execute::fixture::FixtureTexture;

/// A texel of a layer, beyond the edges the nearest one.
fn texel(texture: &FixtureTexture, layer: usize, x: i64, y: i64) -> DVec4 {
    let [width, height] = [texture.width, texture.height].map(i64::from);
    let (x, y) = (x.clamp(0, width - 1), y.clamp(0, height - 1));
    let channels = texture.kind.channels();
    let index = (layer as i64 * width * height + y * width + x) as usize * channels;
    let part = |k: usize| {
        if k < channels {
            texture.texels.get(index + k).map_or(0.0, |one| f64::from(*one))
        } else {
            0.0
        }
    };
    DVec4::new(part(0), part(1), part(2), part(3))
}

/// The four texels around a place, with their weights.
fn footprint(size: [u32; 2], uv: DVec2) -> [(i64, i64, f64); 4] {
    let at = uv * DVec2::new(f64::from(size[0]), f64::from(size[1])) - 0.5;
    let (base, f) = (at.floor(), at - at.floor());
    let (x, y) = (base.x as i64, base.y as i64);
    [
        (x, y, (1.0 - f.x) * (1.0 - f.y)),
        (x + 1, y, f.x * (1.0 - f.y)),
        (x, y + 1, (1.0 - f.x) * f.y),
        (x + 1, y + 1, f.x * f.y),
    ]
}

/// A linear filter over a flat texture. `of` makes a number of a texel's column, row and value.
pub fn filtered(
    texture: &FixtureTexture,
    uv: DVec2,
    of: impl Fn(i64, i64, DVec4) -> DVec4,
) -> DVec4 {
    let parts = footprint([texture.width, texture.height], uv);
    parts.iter().map(|(x, y, weight)| of(*x, *y, texel(texture, 0, *x, *y)) * *weight).sum()
}

/// A linear filter over a flat texture that repeats.
pub fn repeated(texture: &FixtureTexture, uv: DVec2) -> DVec4 {
    let [width, height] = [texture.width, texture.height].map(i64::from);
    let parts = footprint([texture.width, texture.height], uv);
    let one = |(x, y, weight): &(i64, i64, f64)| {
        texel(texture, 0, x.rem_euclid(width), y.rem_euclid(height)) * *weight
    };
    parts.iter().map(one).sum()
}

/// Whether a texel is on the texture.
pub fn is_inside(texture: &FixtureTexture, x: i64, y: i64) -> bool {
    (0..i64::from(texture.width)).contains(&x) && (0..i64::from(texture.height)).contains(&y)
}

/// One comparison, reference at most the texel.
pub fn compared(reference: f64, texel: DVec4) -> DVec4 {
    DVec4::splat(if reference <= texel.x { 1.0 } else { 0.0 })
}

/// The face of a cube in a direction, and the place on it: table 19 of the specification of OpenGL.
fn face_place(d: DVec3) -> (usize, DVec2) {
    let a = d.abs();
    let (face, s, t, m) = if a.x >= a.y && a.x >= a.z {
        if d.x > 0.0 { (0, -d.z, -d.y, a.x) } else { (1, d.z, -d.y, a.x) }
    } else if a.y >= a.z {
        if d.y > 0.0 { (2, d.x, d.z, a.y) } else { (3, d.x, -d.z, a.y) }
    } else if d.z > 0.0 {
        (4, d.x, -d.y, a.z)
    } else {
        (5, -d.x, -d.y, a.z)
    };
    (face, DVec2::new(0.5 * (s / m + 1.0), 0.5 * (t / m + 1.0)))
}

/// The direction of a place on a face, which may lie beyond its edges.
fn face_direction(face: usize, uv: DVec2) -> DVec3 {
    let (s, t) = (2.0 * uv.x - 1.0, 2.0 * uv.y - 1.0);
    match face {
        0 => DVec3::new(1.0, -t, -s),
        1 => DVec3::new(-1.0, -t, s),
        2 => DVec3::new(s, 1.0, t),
        3 => DVec3::new(s, -1.0, -t),
        4 => DVec3::new(s, -t, 1.0),
        _ => DVec3::new(-s, -t, -1.0),
    }
}

/// A linear filter over a cube, across its edges. `of` makes a number of a texel.
pub fn around(cube: &FixtureTexture, direction: DVec3, of: impl Fn(DVec4) -> DVec4) -> DVec4 {
    let size = [cube.width, cube.height];
    let (face, uv) = face_place(direction);
    let side = f64::from(cube.width);
    let one = |(x, y, weight): &(i64, i64, f64)| {
        let (face, x, y) = if is_inside(cube, *x, *y) {
            (face, *x, *y)
        } else {
            let beyond = DVec2::new(*x as f64 + 0.5, *y as f64 + 0.5) / side;
            let (next, place) = face_place(face_direction(face, beyond));
            (next, (place.x * side).floor() as i64, (place.y * side).floor() as i64)
        };
        of(texel(cube, face, x, y)) * *weight
    };
    footprint(size, uv).iter().map(one).sum()
}
