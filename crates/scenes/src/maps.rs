//! Textures made by formulas, among them the profiles and cookies of lamps.

use glam::{DVec2, DVec3, DVec4};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::{PI, TAU};

/// Texels, row by row, linear.
#[derive(Debug, Clone, PartialEq)]
pub struct TextureMap {
    /// Texels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Row by row, from the top.
    pub texels: Vec<DVec4>,
}

/// The textures that the axes `base_map`, `normal_map`, `occlusion`, `lightmap` and `material_maps`
/// read.
#[derive(Debug, Clone, PartialEq)]
pub struct Maps {
    /// Colours.
    pub base: TextureMap,
    /// Normals in tangent space, from -1 to 1 written as 0 to 1.
    pub normal: TextureMap,
    /// Ambient occlusion, in red: 1 where nothing occludes.
    pub occlusion: TextureMap,
    /// Light that was computed beforehand.
    pub light: TextureMap,
    /// The textures of `material_maps`, by the names of their bindings. Those that are missing are
    /// blank.
    pub material: BTreeMap<&'static str, TextureMap>,
    /// Those that have no smaller levels, by the names of their bindings.
    pub single: BTreeSet<&'static str>,
}

/// The textures of `material_maps`, and the texel of each that changes nothing.
const BLANK: [(&str, DVec4); 9] = [
    ("anisotropy_map", DVec4::new(1.0, 0.5, 1.0, 1.0)),
    ("clearcoat_map", DVec4::ONE),
    ("diffuse_transmission_map", DVec4::ONE),
    ("emission_map", DVec4::ONE),
    ("iridescence_map", DVec4::ONE),
    ("metallic_roughness_map", DVec4::ONE),
    ("sheen_map", DVec4::ONE),
    ("specular_map", DVec4::ONE),
    ("transmission_map", DVec4::ONE),
];

/// The texel of a texture of `material_maps` that changes nothing; `None` for other names.
pub fn blank_texel(name: &str) -> Option<DVec4> {
    BLANK.iter().find(|(known, _)| *known == name).map(|(_, texel)| *texel)
}

impl TextureMap {
    /// A map of `side` by `side` texels. `at` gives the value at the middle of a texel, in [0,
    /// 1]^2.
    pub fn of(side: usize, at: impl Fn(DVec2) -> DVec4) -> Self {
        let place = |index: usize| {
            (DVec2::new((index % side) as f64, (index / side) as f64) + 0.5) / side as f64
        };
        Self {
            width: side,
            height: side,
            texels: (0..side * side).map(|index| at(place(index))).collect(),
        }
    }

    /// The map at half the size, each texel the mean of four; `None` for a single texel.
    pub fn half(&self) -> Option<Self> {
        if self.width.max(self.height) <= 1 {
            return None;
        }
        let (width, height) = ((self.width / 2).max(1), (self.height / 2).max(1));
        let texel = |x: usize, y: usize| {
            self.texels[y.min(self.height - 1) * self.width + x.min(self.width - 1)]
        };
        let mean = |index: usize| {
            let (x, y) = (2 * (index % width), 2 * (index / width));
            (texel(x, y) + texel(x + 1, y) + texel(x, y + 1) + texel(x + 1, y + 1)) * 0.25
        };
        Some(Self { width, height, texels: (0..width * height).map(mean).collect() })
    }

    pub fn mean(&self) -> DVec4 {
        self.texels.iter().sum::<DVec4>() / self.texels.len().max(1) as f64
    }

    /// The map and all its mip levels.
    pub fn levels(self) -> Vec<Self> {
        std::iter::successors(Some(self), Self::half).collect()
    }
}

/// Linear light from a value that is encoded as sRGB (IEC 61966-2-1).
pub fn linear_from_srgb(encoded: f64) -> f64 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// A wall of bricks in running bond. Its baked light is a soft spot.
pub fn bricks() -> Maps {
    Maps {
        base: TextureMap::of(256, |at| {
            let brick = Brick::at(at);
            let clay = DVec3::new(0.86, 0.8, 0.76)
                * (0.8 + 0.35 * brick.tone)
                * (0.95 + 0.12 * rough_noise(at, 16));
            DVec3::new(0.55, 0.54, 0.52).lerp(clay, brick.height).extend(1.0)
        }),
        normal: TextureMap::of(256, |at| {
            let step = 1.0 / 512.0;
            let slope = |axis: DVec2| {
                (Brick::at(at + axis * step).height - Brick::at(at - axis * step).height)
                    / (2.0 * step)
            };
            let normal =
                DVec3::new(-0.02 * slope(DVec2::X), -0.02 * slope(DVec2::Y), 1.0).normalize();
            (normal * 0.5 + 0.5).extend(1.0)
        }),
        occlusion: TextureMap::of(128, |at| DVec3::splat(open_above(at)).extend(1.0)),
        light: TextureMap::of(32, |at| {
            let glow = (-(at - 0.5).length_squared() * 6.0).exp();
            (DVec3::new(1.0, 0.92, 0.8) * (0.1 + 0.9 * glow)).extend(1.0)
        }),
        material: BTreeMap::new(),
        single: BTreeSet::new(),
    }
}

/// The textures of `material_maps` for [`bricks`]: some bricks are polished metal, some glow, all
/// have a coat, and the joints are rough.
pub fn brick_materials() -> BTreeMap<&'static str, TextureMap> {
    let own =
        |texel: fn(Brick) -> DVec3| TextureMap::of(256, move |at| texel(Brick::at(at)).extend(1.0));
    BTreeMap::from([
        (
            "metallic_roughness_map",
            own(|brick| {
                let metal = if brick.tone > 0.55 { brick.height } else { 0.0 };
                DVec3::new(1.0, 1.0 - brick.height * (0.45 + 0.4 * brick.tone), metal)
            }),
        ),
        (
            "emission_map",
            own(|brick| {
                let glow = if brick.tone < 0.2 { brick.height } else { 0.0 };
                DVec3::splat(glow)
            }),
        ),
        ("clearcoat_map", own(|brick| DVec3::new(brick.height, 1.0, 1.0))),
    ])
}

/// How open the wall is to light at a place: the mean over directions of the cosine-weighted part
/// of the sky above the horizon that the relief has there.
fn open_above(at: DVec2) -> f64 {
    /// Height of a brick above the joint, in widths of the texture. The relief of the occlusion is
    /// deeper than that of the normals, as where mortar is raked out.
    const DEPTH: f64 = 0.03;
    const DIRECTIONS: usize = 8;
    const STEPS: usize = 8;
    let here = Brick::at(at).height;
    let open = |direction: usize| {
        let turn = DVec2::from_angle(TAU * direction as f64 / DIRECTIONS as f64);
        let slope = |step: usize| {
            let far = 0.08 * (step as f64 / STEPS as f64);
            DEPTH * (Brick::at(at + turn * far).height - here) / far
        };
        let steepest = (1..=STEPS).map(slope).fold(0.0, f64::max);
        // The cosine-weighted share above an elevation is the square of its cosine.
        1.0 / (1.0 + steepest * steepest)
    };
    (0..DIRECTIONS).map(open).sum::<f64>() / DIRECTIONS as f64
}

/// Bright grass of many tones. The other maps are those of [`bricks`].
pub fn meadow() -> Maps {
    let base = TextureMap::of(256, |at| {
        let tone = 0.85 + 0.3 * rough_noise(at, 12);
        let dry = 0.5 + 0.5 * value_noise(at + 0.37, 8);
        (DVec3::new(1.0 + 0.12 * dry, 1.0, 1.0 - 0.18 * dry) * tone).extend(1.0)
    });
    Maps { base, ..bricks() }
}

/// The height and the tone of the wall at a place.
struct Brick {
    /// 0 in the joint, 1 on the brick.
    height: f64,
    /// A random number of the brick, [0, 1).
    tone: f64,
}

impl Brick {
    fn at(place: DVec2) -> Self {
        const ROWS: f64 = 6.0;
        const COLUMNS: f64 = 3.0;
        let wrapped = place.rem_euclid(DVec2::ONE);
        let row = (wrapped.y * ROWS).floor();
        let along = wrapped.x * COLUMNS + if row % 2.0 == 0.0 { 0.0 } else { 0.5 };
        let column = along.floor().rem_euclid(COLUMNS);
        // Distance from the joint, in the height of a brick.
        let x = 0.5 - (along.rem_euclid(1.0) - 0.5).abs();
        let y = 0.5 - ((wrapped.y * ROWS).rem_euclid(1.0) - 0.5).abs();
        let distance = (x * ROWS / COLUMNS).min(y);
        Self {
            height: ((distance - 0.04) / 0.06).clamp(0.0, 1.0),
            tone: (0.618 * (7.0 * row + 3.0 * column)).fract(),
        }
    }
}

/// Noise that repeats with the texture, in [-1, 1]: random values at the corners of a grid of `cells`
/// by `cells`, smooth between them (value noise: Ebert et al., "Texturing and Modeling", 3rd edition,
/// 2003, chapter 2).
pub(super) fn value_noise(at: DVec2, cells: u32) -> f64 {
    let place = at.rem_euclid(DVec2::ONE) * f64::from(cells);
    2.0 * grid_noise(place, |x, y| random_at(x % cells, y % cells, cells)) - 1.0
}

/// The numbers at the four corners of the cell around a place, interpolated smoothly.
pub(super) fn grid_noise(place: DVec2, corner: impl Fn(u32, u32) -> f64) -> f64 {
    let cell = place.floor();
    let t = place - cell;
    let t = t * t * (3.0 - 2.0 * t);
    // Cells below 0 wrap, which is as random as any other number.
    let (left, low) = (cell.x as i64 as u32, cell.y as i64 as u32);
    let (right, high) = (left.wrapping_add(1), low.wrapping_add(1));
    let along = |y: u32| corner(left, y) + (corner(right, y) - corner(left, y)) * t.x;
    along(low) + (along(high) - along(low)) * t.y
}

/// A random number of a cell, [0, 1): O'Neill's hash of the PCG family, as `pcg3d` of Jarzynski and
/// Olano, "Hash Functions for GPU Rendering", 2020.
pub(super) fn random_at(x: u32, y: u32, seed: u32) -> f64 {
    let mut v = [x, y, seed].map(|part| part.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    for turn in 0..2 {
        for (to, one, other) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
            v[to] = v[to].wrapping_add(v[one].wrapping_mul(v[other]));
        }
        if turn == 0 {
            v = v.map(|part| part ^ (part >> 16));
        }
    }
    f64::from(v[0]) / 2.0_f64.powi(32)
}

/// Noise of several sizes that repeats with the texture, [-1, 1]. The largest spots are a share
/// `1 / cells` of the texture.
fn rough_noise(at: DVec2, cells: u32) -> f64 {
    let octave = |index: i32| 0.5_f64.powi(index + 1) * value_noise(at, cells << index);
    (0..4).map(octave).sum()
}

/// The intensity of a luminaire over that of its strongest direction: angles to the axis in
/// columns, from 0 to pi, and angles around it in rows, from 0 to 2 pi. Both ends of a range are
/// middles of texels.
pub fn luminaire() -> TextureMap {
    const SIDE: usize = 64;
    TextureMap::of(SIDE, |at| {
        let angle = (at * SIDE as f64 - 0.5) / (SIDE - 1) as f64;
        let (vertical, horizontal) = (angle.x * PI, angle.y * TAU);
        let lobe = |middle: f64, width: f64| (-((vertical - middle) / width).powi(2)).exp();
        // A narrow beam, a ring around it that louvres divide, and a glow to above.
        let rays = 0.55 + 0.45 * (6.0 * horizontal).cos();
        let light = lobe(0.0, 0.3) + 0.6 * rays * lobe(0.75, 0.14) + 0.3 * lobe(PI, 0.4);
        DVec3::splat(light.min(1.0)).extend(1.0)
    })
}

/// A window of twelve coloured panes with dark bars between them.
pub fn window() -> TextureMap {
    const PANES: DVec2 = DVec2::new(3.0, 4.0);
    TextureMap::of(256, |at| {
        let place = at * PANES;
        let pane = place.floor();
        // Distance from the next bar, in heights of a pane.
        let from_edge = DVec2::splat(0.5) - (place.fract() - 0.5).abs();
        let open = ((from_edge.x * PANES.y / PANES.x).min(from_edge.y) - 0.06) / 0.03;
        let turn = TAU * (0.29 * pane.x + 0.17 * pane.y);
        let tint = DVec3::new(turn.cos(), (turn - TAU / 3.0).cos(), (turn + TAU / 3.0).cos());
        ((0.58 + 0.42 * tint) * open.clamp(0.0, 1.0)).extend(1.0)
    })
}

/// The scale (xy) and the offset (zw) from coordinates in [0, 1] to those of a texture, so that
/// both ends are middles of texels.
pub fn between_middles(map: &TextureMap) -> DVec4 {
    let size = DVec2::new(map.width as f64, map.height as f64);
    let (scale, offset) = ((size - 1.0) / size, 0.5 / size);
    DVec4::new(scale.x, scale.y, offset.x, offset.y)
}
