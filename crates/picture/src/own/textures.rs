//! Textures that nobody gave: their names say what they hold.

use glam::{DVec2, DVec3, DVec4};

use lamplight_bundle::{Binding, BindingKind};
use lamplight_eval::{half_from, half_to};
use lamplight_execute::fixture::{
    Address, Compare, Fixture, FixtureSampler, FixtureTexture, TextureKind,
};
use lamplight_scene::CubeMap;
use lamplight_scenes::sets::TextureMap;
use lamplight_scenes::{bricks, environment};

use super::words::{has_word, name_words};
use crate::Surroundings;
use crate::textures::color_textures;

/// Texels along an edge of a texture that was made.
pub const SIDE: u32 = 256;
/// Texels along an edge of a face of a cube.
const FACE: usize = 64;

/// Textures that have names, with what they are.
pub const NAMED: &[(&str, &str)] = &[
    ("checker", "squares of two greys, eight in a row"),
    ("noise", "four channels of smooth noise"),
    ("bricks", "a wall of bricks"),
    ("uv", "red and green grow with u and v"),
    ("gradient", "black to white with u"),
    ("white", "1 everywhere"),
    ("grey", "0.5 everywhere"),
    ("black", "0 everywhere, alpha 1"),
    ("flat", "a normal map without relief"),
];

/// The texture of a name in [`NAMED`].
pub fn named_texture(name: &str) -> Option<TextureMap> {
    let filled = |color: DVec3| Some(TextureMap::of(1, |_| color.extend(1.0)));
    let made = |at: fn(DVec2) -> DVec4| Some(TextureMap::of(SIDE as usize, at));
    match name {
        "checker" => made(|at| {
            let [x, y] = [at.x, at.y].map(|part| (part * 8.0).floor() as i64);
            DVec3::splat(if (x + y) % 2 == 0 { 0.75 } else { 0.25 }).extend(1.0)
        }),
        "noise" => made(|at| DVec4::from_array([0, 1, 2, 3].map(|seed| smooth_noise(at, seed)))),
        "bricks" => {
            let map = bricks().base;
            let texels = map.texels.iter().map(|texel| texel.clamp(DVec4::ZERO, DVec4::ONE));
            Some(TextureMap { texels: texels.collect(), ..map })
        }
        "uv" => made(|at| DVec4::new(at.x, at.y, 0.0, 1.0)),
        "gradient" => made(|at| DVec3::splat(at.x).extend(1.0)),
        "white" => filled(DVec3::ONE),
        "grey" => filled(DVec3::splat(0.5)),
        "black" => filled(DVec3::ZERO),
        "flat" => filled(DVec3::new(0.5, 0.5, 1.0)),
        _ => None,
    }
}

/// The name in [`NAMED`] of what a texture with this name probably holds.
pub fn default_texture(name: &str) -> (&'static str, bool) {
    const RULES: &[(&[&str], &str)] = &[
        (&["normal", "normals", "bump"], "flat"),
        (&["noise", "random", "rand"], "noise"),
        (&["rough", "roughness"], "grey"),
        (&["metallic", "metalness", "metal", "emission", "emissive"], "black"),
        (&["occlusion", "ao", "mask", "alpha", "opacity"], "white"),
        (&["ramp", "gradient", "lut", "palette"], "gradient"),
        (&["brick", "bricks", "wall"], "bricks"),
    ];
    let words = name_words(name);
    match RULES.iter().find(|(known, _)| has_word(&words, known)) {
        Some((_, texture)) => (texture, true),
        None => ("checker", false),
    }
}

/// Whether a texture holds numbers and not colours, so that an image is not decoded for it.
pub fn holds_numbers(name: &str) -> bool {
    const NUMBERS: &[&str] = &[
        "normal",
        "normals",
        "bump",
        "height",
        "displacement",
        "roughness",
        "rough",
        "metallic",
        "metalness",
        "metal",
        "occlusion",
        "ao",
        "mask",
        "noise",
        "depth",
        "lut",
        "data",
    ];
    has_word(&name_words(name), NUMBERS)
}

/// Smooth noise in [0, 1] that repeats: value noise of three octaves.
fn smooth_noise(at: DVec2, seed: u32) -> f64 {
    let octave = |cells: u32| {
        let scaled = at * f64::from(cells);
        let (cell, part) = (scaled.floor(), scaled - scaled.floor());
        let smooth = part * part * (3.0 - 2.0 * part);
        let corner = |x: f64, y: f64| {
            let wrapped = |number: f64| (number as i64).rem_euclid(i64::from(cells)) as u32;
            hashed(wrapped(cell.x + x), wrapped(cell.y + y), 31 * seed + cells)
        };
        let row = |y: f64| corner(0.0, y) * (1.0 - smooth.x) + corner(1.0, y) * smooth.x;
        row(0.0) * (1.0 - smooth.y) + row(1.0) * smooth.y
    };
    (4.0 * octave(8) + 2.0 * octave(16) + octave(32)) / 7.0
}

/// A number in [0, 1] of three others, mixed in one after another. The multipliers are those of xxHash
/// and MurmurHash3.
fn hashed(x: u32, y: u32, seed: u32) -> f64 {
    let mix = |state: u32, word: u32| {
        let mut state = (state ^ word).wrapping_mul(0x9e37_79b1);
        state ^= state >> 15;
        state.wrapping_mul(0x85eb_ca6b) ^ (state >> 13)
    };
    f64::from(mix(mix(mix(seed, x), y), 0x27d4_eb2f)) / f64::from(u32::MAX)
}

/// The levels of a texture of the type, from what it shall hold, the largest first. `None` for types
/// that nothing can be bound to.
pub fn texture_levels(
    ty: &str,
    map: TextureMap,
    sky: &Surroundings,
) -> Option<Vec<FixtureTexture>> {
    match ty {
        "texture_2d<f32>" => {
            let texels = map.texels.into_iter().map(half_texel).collect();
            Some(color_textures(TextureMap { texels, ..map }.levels()))
        }
        "texture_cube<f32>" => {
            let cube = sky.with_sky(|sky| CubeMap::of(sky, FACE));
            Some(vec![crate::textures::cube_texture(&cube)])
        }
        "texture_depth_2d" => Some(vec![far_depths(TextureKind::Depth2d)]),
        "texture_depth_cube" => Some(vec![far_depths(TextureKind::DepthCube)]),
        _ => None,
    }
}

/// Every device filters textures of 16 bits, so texels are numbers that those have.
fn half_texel(texel: DVec4) -> DVec4 {
    DVec4::from_array(texel.to_array().map(|part| half_to(half_from(part))))
}

/// A shadow map with nothing in it.
fn far_depths(kind: TextureKind) -> FixtureTexture {
    FixtureTexture { kind, width: 1, height: 1, texels: vec![1.0; kind.layers() as usize] }
}

/// Filters linearly and repeats. Comparisons are those of a shadow map: what is nearer is lit.
pub fn plain_sampler(binding: &Binding) -> Fixture {
    let is_comparison = binding.kind == BindingKind::ComparisonSampler;
    Fixture::Sampler(FixtureSampler {
        compare: is_comparison.then_some(Compare::LessEqual),
        linear: true,
        address: if is_comparison { Address::Clamp } else { Address::Repeat },
    })
}

/// What a texture of the type holds by default, in words.
pub fn default_content(name: &str, ty: &str) -> (&'static str, bool) {
    match ty {
        "texture_cube<f32>" => ("the environment", true),
        "texture_depth_2d" | "texture_depth_cube" => ("depth 1: nothing casts a shadow", true),
        _ => default_texture(name),
    }
}

/// The environment of a name, for a cube.
pub fn named_sky(name: &str) -> Option<Surroundings> {
    environment(name).map(Surroundings::Formula)
}

#[cfg(test)]
mod tests {
    use super::{NAMED, default_texture, named_texture};

    #[test]
    fn textures_of_names() {
        for (name, expected) in [
            ("normalMap", "flat"),
            ("u_noise", "noise"),
            ("metallic_roughness", "grey"),
            ("albedo", "checker"),
            ("iChannel0", "checker"),
        ] {
            assert_eq!(default_texture(name).0, expected, "{name}");
        }
        for (name, _) in NAMED {
            let texels = named_texture(name).map(|map| map.texels).unwrap_or_default();
            let is_shown =
                |texel: &glam::DVec4| texel.min_element() >= 0.0 && texel.max_element() <= 1.0;
            assert!(!texels.is_empty() && texels.iter().all(is_shown), "{name}");
        }
        assert_eq!(named_texture("chekcer"), None);
    }
}
