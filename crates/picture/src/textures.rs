//! The textures and samplers of a pass, from earlier passes, from the scene and from its
//! surroundings. Functions that are drawn by themselves get textures with something to see in them.

use crate::Surroundings;
use crate::values::UniformValues;
use glam::DVec4;
use lamplight_bundle::{Binding, BindingKind};
use lamplight_diagnostic::source::Embedded;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_eval::{half_from, half_to};
use lamplight_execute::fixture::{
    Address, Compare, Fixture, FixtureSampler, FixtureTexture, TextureKind,
};
use lamplight_scene::{CubeMap, FACES, Sky, prefilter};
use lamplight_scenes::sets::{Maps, TextureMap};
use lamplight_scenes::{blank_texel, brick_materials, bricks};
use std::collections::BTreeMap;
use std::sync::Arc;

/// What earlier passes have drawn.
#[derive(Default)]
pub struct Left {
    /// The depths that the light sees: of six faces, or of one. And the texels along an edge.
    pub map: Option<(Vec<Vec<f32>>, u32)>,
    /// Moments of the depths that the light sees.
    pub moments: Option<FixtureTexture>,
    /// The depths that the viewer sees, and the size.
    pub seen: Option<(Vec<f32>, [u32; 2])>,
    /// The colour targets of the last pass that shows things to the viewer.
    pub colors: Vec<FixtureTexture>,
    /// The colours of passes over the screen, by program.
    pub over: BTreeMap<String, FixtureTexture>,
}

/// The names of the samplers that do not filter.
const NEAREST: [&str; 4] = ["depth_sampler", "depths_smp", "surface_sampler", "open_sampler"];

pub fn binding_sampler(binding: &Binding) -> Fixture {
    let compare = (binding.kind == BindingKind::ComparisonSampler).then_some(Compare::LessEqual);
    let address = if binding.name == "map_sampler" { Address::Repeat } else { Address::Clamp };
    let linear = !NEAREST.contains(&binding.name.as_str());
    Fixture::Sampler(FixtureSampler { compare, linear, address })
}

/// A texture by its name and its type in WGSL, for a shader that says nothing about its content:
/// bricks, the surroundings, or depths that cast a shadow. `None` for types that no fixture has.
pub fn plain_texture(name: &str, ty: &str, surroundings: &Surroundings) -> Option<FixtureTexture> {
    match ty {
        "texture_2d<f32>" if name.contains("depth") => Some(fence(TextureKind::Color2d)),
        "texture_2d<f32>" => color_textures(vec![bricks().base]).pop(),
        "texture_cube<f32>" => {
            Some(surroundings.with_sky(|sky| cube_texture(&CubeMap::of(sky, ENVIRONMENT))))
        }
        "texture_depth_2d" => Some(fence(TextureKind::Depth2d)),
        "texture_depth_cube" => Some(columns()),
        _ => None,
    }
}

/// Textures by the name of their binding.
pub struct TextureLibrary<'a> {
    library: Embedded,
    values: &'a UniformValues<'a>,
    left: &'a Left,
    maps: Option<Arc<Maps>>,
}

/// Texels along an edge of the environment's own cube map.
const ENVIRONMENT: usize = 64;
/// The edges of the environment's filtered cube maps, and the rows of the quadratures that fill
/// them.
const DIFFUSE: (usize, usize) = (12, 24);
const SPECULAR: (usize, usize) = (32, 36);
/// The exponent of the cosine lobe with which the specular map is filtered.
const LOBE: f64 = 60.0;
/// Levels of the specular map where it has one for each roughness, in equal steps of perceptual
/// roughness. The first is the environment itself.
pub const LEVELS: usize = 5;
/// The rows of the quadratures for the other levels.
const LEVEL_ROWS: [usize; LEVELS - 1] = [40, 24, 24, 24];

impl<'a> TextureLibrary<'a> {
    pub fn new(library: Embedded, values: &'a UniformValues<'a>, left: &'a Left) -> Self {
        Self { library, values, left, maps: None }
    }

    /// The levels of a texture, the largest first; at least one.
    pub fn texture(&mut self, name: &str) -> Result<Vec<FixtureTexture>, Diagnostics> {
        let surroundings = &self.values.shot.surroundings;
        let sky = |exponent, (size, rows)| {
            surroundings.with_sky(|sky| cube_texture(&prefilter(sky, exponent, size, rows)))
        };
        let found = match name {
            "environment" => Some(vec![
                surroundings.with_sky(|sky| cube_texture(&CubeMap::of(sky, ENVIRONMENT))),
            ]),
            "sky_diffuse" => Some(vec![sky(1.0, DIFFUSE)]),
            "sky_specular" if self.values.lit.needs.levels => Some(self.rough_levels()),
            "sky_specular" => Some(vec![sky(LOBE, SPECULAR)]),
            "base_map" => {
                let map = self.maps().base.clone();
                Some(self.leveled(name, map))
            }
            "normal_map" => {
                let map = self.maps().normal.clone();
                Some(self.leveled(name, map))
            }
            "occlusion_map" => {
                let map = self.maps().occlusion.clone();
                Some(self.leveled(name, map))
            }
            "light_map" => Some(color_textures(vec![self.maps().light.clone()])),
            "profile_map" => {
                let profile = self.values.lit.needs.profile;
                profile.map(|profile| color_textures(vec![profile.map()]))
            }
            "probe_light" | "probe_depths" => {
                self.values.probe_map(name).map(|map| color_textures(vec![map]))
            }
            "ltc_table" => self.library.table(LTC).map(|bytes| vec![table_texture(bytes)]),
            _ => match blank_texel(name) {
                Some(blank) => Some(self.material_map(name, blank)),
                None => self.left.texture(name),
            },
        };
        let missing = || format!("no pass before has drawn what `{name}` reads");
        found.ok_or_else(|| vec![Diagnostic::error(codes::EXECUTOR_FAILED, missing())])
    }

    /// The surroundings, blurred for each roughness.
    fn rough_levels(&self) -> Vec<FixtureTexture> {
        let level = |sky: &Sky<'_>, index: usize| {
            let size = ENVIRONMENT >> index;
            let Some(rows) = index.checked_sub(1).and_then(|rough| LEVEL_ROWS.get(rough)) else {
                return CubeMap::of(sky, size);
            };
            let alpha = (index as f64 / (LEVELS - 1) as f64).powi(2);
            // The lobe around the mirror direction that is as wide as that of the facets.
            prefilter(sky, (0.5 / (alpha * alpha)).max(1.0), size, *rows)
        };
        let surroundings = &self.values.shot.surroundings;
        (0..LEVELS)
            .map(|index| surroundings.with_sky(|sky| cube_texture(&level(sky, index))))
            .collect()
    }

    /// A texture of a material. If there is none, it has the single texel `blank`.
    fn material_map(&mut self, name: &str, blank: DVec4) -> Vec<FixtureTexture> {
        let found = match &self.values.scene.own_maps {
            Some(maps) => maps.material.get(name).cloned(),
            None => brick_materials().remove(name),
        };
        let map = found.unwrap_or_else(|| TextureMap { width: 1, height: 1, texels: vec![blank] });
        self.leveled(name, map)
    }

    /// A texture with its smaller levels, if it has them.
    fn leveled(&self, name: &str, map: TextureMap) -> Vec<FixtureTexture> {
        let maps = self.values.scene.own_maps.as_ref();
        let is_single = maps.is_some_and(|maps| maps.single.contains(name));
        color_textures(if is_single { vec![map] } else { map.levels() })
    }

    fn maps(&mut self) -> &Maps {
        let scene = self.values.scene;
        let make = || scene.own_maps.clone().unwrap_or_else(|| Arc::new((scene.maps)()));
        self.maps.get_or_insert_with(make)
    }
}

impl Left {
    /// The levels of a texture that an earlier pass has drawn.
    fn texture(&self, name: &str) -> Option<Vec<FixtureTexture>> {
        let map = |kind| self.map.as_ref().map(|(faces, size)| flat_texture(kind, faces, *size));
        let color = |index: usize| self.colors.get(index).cloned();
        let one = |texture: Option<FixtureTexture>| texture.map(|texture| vec![texture]);
        match name {
            "shadow_map" => one(map(TextureKind::Depth2d)),
            "shadow_cube" => one(map(TextureKind::DepthCube)),
            "shadow_depth" | "depths" => {
                let face =
                    self.map.as_ref().and_then(|(faces, size)| Some((faces.first()?, *size)));
                one(face.map(|(face, size)| as_color(face, [size; 2])))
            }
            "blurred" => one(self.moments.clone()),
            "shadow_moments" => self.moments.clone().map(with_levels),
            "light" | "surface_color" => one(color(0)),
            "seen_occlusion" => one(self.over.get("gtao").cloned()),
            "seen_contact" => one(self.over.get("contact_shadows").cloned()),
            "surface_normal" => one(color(1)),
            "surface_factors" => one(color(2)),
            "surface_depth" | "depth_buffer" => {
                one(self.seen.as_ref().map(|(depths, size)| as_color(depths, *size)))
            }
            _ => None,
        }
    }
}

fn flat_texture(kind: TextureKind, faces: &[Vec<f32>], size: u32) -> FixtureTexture {
    FixtureTexture {
        kind,
        width: size,
        height: size,
        texels: faces.iter().take(kind.layers() as usize).flatten().copied().collect(),
    }
}

/// Depths in the form of a colour texture, for passes that read them so.
fn as_color(depths: &[f32], [width, height]: [u32; 2]) -> FixtureTexture {
    let texels = depths.iter().flat_map(|depth| [*depth, 0.0, 0.0, 1.0]).collect();
    FixtureTexture { kind: TextureKind::Color2d, width, height, texels }
}

pub(crate) fn cube_texture(map: &CubeMap) -> FixtureTexture {
    let texels = map
        .texels
        .iter()
        .take(FACES.len() * map.size * map.size)
        .flat_map(|texel| texel.extend(1.0).as_vec4().to_array())
        .collect();
    FixtureTexture {
        kind: TextureKind::ColorCube,
        width: map.size as u32,
        height: map.size as u32,
        texels,
    }
}

/// The table of linearly transformed cosines: 64 by 64 texels of four numbers.
const LTC: &str = "tables/ltc.bin";

/// A square table of four channels, rounded to half floats, which every device can filter.
fn table_texture(bytes: &[u8]) -> FixtureTexture {
    let (words, _) = bytes.as_chunks::<4>();
    let number = |word: &[u8; 4]| half_to(half_from(f64::from(f32::from_le_bytes(*word)))) as f32;
    let side = (words.len() / 4).isqrt() as u32;
    let texels = words.iter().map(number).collect();
    FixtureTexture { kind: TextureKind::Color2d, width: side, height: side, texels }
}

pub(crate) fn color_textures(levels: Vec<TextureMap>) -> Vec<FixtureTexture> {
    let color = |map: TextureMap| FixtureTexture {
        kind: TextureKind::Color2d,
        width: map.width as u32,
        height: map.height as u32,
        texels: map.texels.iter().flat_map(|texel| texel.as_vec4().to_array()).collect(),
    };
    levels.into_iter().map(color).collect()
}

/// A texture with all its smaller levels. They are made after the blur, so that they are blurred
/// too.
fn with_levels(texture: FixtureTexture) -> Vec<FixtureTexture> {
    let (pixels, _) = texture.texels.as_chunks::<4>();
    let texels = pixels.iter().map(|pixel| glam::Vec4::from_array(*pixel).as_dvec4()).collect();
    let mut levels = color_textures(
        TextureMap { width: texture.width as usize, height: texture.height as usize, texels }
            .levels(),
    );
    levels[0] = texture;
    levels
}

/// Texels in each direction.
const TEXELS: u32 = 64;

/// The depths of a fence of leaning posts, on a ground at depth 0.6. The lower a part of a post is
/// in the texture, the closer it is to the ground.
pub fn fence(kind: TextureKind) -> FixtureTexture {
    let depth = |index: u32| {
        let [x, y] = [index % TEXELS, index / TEXELS].map(|at| f64::from(at) / f64::from(TEXELS));
        let post = (x * 4.0 + y * 0.5 + 0.2).fract();
        if post < 0.4 && (0.12..0.9).contains(&y) { (0.2 + 0.35 * y) as f32 } else { 0.6 }
    };
    let texels = (0..TEXELS * TEXELS).flat_map(|index| vec![depth(index); kind.channels()]);
    FixtureTexture { kind, width: TEXELS, height: TEXELS, texels: texels.collect() }
}

/// Four columns around a lamp, at a quarter of the depth, on the four faces at its sides.
pub fn columns() -> FixtureTexture {
    let faces = TextureKind::DepthCube.layers();
    let depth = |index: u32| {
        let (face, x) = (index / (TEXELS * TEXELS), index % TEXELS);
        let is_side = face != 2 && face != 3;
        if is_side && (TEXELS * 3 / 8..TEXELS * 5 / 8).contains(&x) { 0.25 } else { 1.0 }
    };
    let texels = (0..faces * TEXELS * TEXELS).map(depth).collect();
    let kind = TextureKind::DepthCube;
    FixtureTexture { kind, width: TEXELS, height: TEXELS, texels }
}

/// Squares of four colours on black.
pub fn image() -> FixtureTexture {
    let color = |index: u32| {
        let [x, y] = [index % TEXELS, index / TEXELS];
        let [column, row] = [x / (TEXELS / 2), y / (TEXELS / 2)];
        let inside = [x, y].iter().all(|at| (8..24).contains(&(at % (TEXELS / 2))));
        let colors = [[0.9, 0.25, 0.1], [0.95, 0.8, 0.2], [0.1, 0.5, 0.9], [0.3, 0.8, 0.35]];
        let [r, g, b] = if inside { colors[(2 * row + column) as usize % 4] } else { [0.0; 3] };
        [r, g, b, 1.0]
    };
    let texels = (0..TEXELS * TEXELS).flat_map(color).collect();
    let kind = TextureKind::Color2d;
    FixtureTexture { kind, width: TEXELS, height: TEXELS, texels }
}
