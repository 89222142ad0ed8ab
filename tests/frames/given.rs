//! What the uniforms, textures and samplers of a frame hold.

use glam::DMat4;
use lamplight::bundle::BindingKind;
use lamplight::execute::fixture::{
    Address, Compare, Fixture, FixtureSampler, FixtureTexture, TextureKind,
};
use lamplight::scene::{Clip, Depth, perspective};

/// Values for any uniform. Some are chosen, so that the picture shows something; the others vary
/// with the name.
pub fn number(path: &str) -> Vec<f64> {
    let (_, name) = path.rsplit_once('.').unwrap_or(("", path));
    let index =
        path.split(['[', ']']).nth(1).and_then(|index| index.parse::<f64>().ok()).unwrap_or(0.0);
    let vary = |low: f64, high: f64, count: usize| -> Vec<f64> {
        let step = |i: usize| {
            ((i as f64 + 1.0) * 0.618 + index * 0.271 + path.len() as f64 * 0.137).fract()
        };
        (0..count).map(|i| low + (high - low) * step(i)).collect()
    };
    if let Some(chosen) = special(path, name, index as usize) {
        return chosen;
    }
    match name {
        "count" => vec![3.0],
        "kind" => vec![index + 1.0],
        "light" => vec![0.0],
        "range" | "far" => vec![12.0],
        "near" => vec![0.1],
        "position" => vec![0.7 - index, 0.5, 1.5 + 0.3 * index],
        "axis" => [vec![-0.36, -0.48, -0.8], vec![0.0, -0.28, -0.96], vec![0.6, 0.0, -0.8]]
            [index as usize % 3]
            .clone(),
        "exponent" => vec![4.0 + index],
        "shininess" => vec![16.0],
        "cutoff" => vec![0.5],
        "inner" => vec![0.9],
        "outer" => vec![0.45],
        "attenuation" => vec![1.0, 0.1, 0.05],
        "roughness" => vec![0.45],
        "ior" | "iridescence_ior" => vec![1.4],
        "iridescence_thickness" => vec![380.0],
        "anisotropy_direction" => vec![0.8, 0.6],
        "sky_levels" => vec![1.0],
        "up" => vec![0.0, 1.0, 0.0],
        "min_w" | "min_variance" | "texel" => vec![0.01],
        "bias" => vec![0.003],
        "start" => vec![1.0],
        "end" => vec![6.0],
        "exponents" => vec![5.0, 5.0],
        "radius" if path.starts_with("areas") => vec![0.3 + 0.1 * index],
        "right" => vec![-0.6, 0.0, 0.2],
        "radius" => vec![2.0],
        "window" => vec![4.0],
        "steps" => vec![255.0],
        "frame" => vec![5.0],
        "level" => vec![0.0],
        _ => vary(0.1, 0.9, 4),
    }
}

/// Chosen values for the uniforms that need them. `None` where any values will do.
fn special(path: &str, name: &str, index: usize) -> Option<Vec<f64>> {
    let found = matrix(path, name).or_else(|| room(name));
    found
        .or_else(|| profile(path, name, index))
        .or_else(|| cluster(name, index))
        .or_else(|| cascade(path, name))
        .or_else(|| probes(path, name))
        .or_else(|| tint(path, name))
}

/// How a lamp reads its light profile: from which direction angles around its axis count, and the
/// part of the texture, which does not reach its border.
fn profile(path: &str, name: &str, index: usize) -> Option<Vec<f64>> {
    const RIGHT: [[f64; 3]; 3] = [[0.8, -0.6, 0.0], [1.0, 0.0, 0.0], [0.8, 0.0, 0.6]];
    match name {
        _ if !path.starts_with("profiles") => None,
        "right" => Some(RIGHT[index % RIGHT.len()].to_vec()),
        "scale" => Some(vec![0.875, 0.875]),
        "offset" => Some(vec![0.0625, 0.0625]),
        _ => None,
    }
}

/// The clusters of lamps: the counts of cells, and the list of one to three lamps of each cell.
fn cluster(name: &str, index: usize) -> Option<Vec<f64>> {
    match name {
        "counts" => Some(vec![4.0, 3.0, 24.0]),
        "cells" => Some(words(index, |cell| (cell % 3) | ((1 + cell % 3) << 16))),
        "indices" => {
            let bytes =
                |word: usize| (4 * word..4 * word + 4).map(|at| (at % 3) << (8 * (at % 4))).sum();
            Some(words(index, bytes))
        }
        _ => None,
    }
}

/// The colour of an object. Some alphas are below one half after the vertices' and the texture's, and
/// some above.
fn tint(path: &str, name: &str) -> Option<Vec<f64>> {
    (path.starts_with("object") && name == "color").then(|| vec![0.4, 0.7, 0.6, 1.6])
}

/// Shadow cascades whose split distances cross the sheet.
fn cascade(path: &str, name: &str) -> Option<Vec<f64>> {
    match name {
        _ if path.starts_with("cascades.clip_from_world") => matrix("", "clip_from_world"),
        "splits" => Some(vec![2.8, 2.95, 3.1, 3.25]),
        "texels" => Some(vec![0.005, 0.01, 0.02, 0.04]),
        "overlap" => Some(vec![0.06]),
        _ => None,
    }
}

/// A grid of light probes around the sheet.
fn probes(path: &str, name: &str) -> Option<Vec<f64>> {
    match name {
        _ if !path.starts_with("probes") => None,
        "origin" => Some(vec![-1.3, -1.2, -0.9]),
        "spacing" => Some(vec![0.95, 0.85, 0.7]),
        "counts" => Some(vec![4.0, 4.0, 4.0]),
        "light_side" => Some(vec![6.0]),
        "depth_side" => Some(vec![14.0]),
        "bias" => Some(vec![0.1]),
        _ => None,
    }
}

/// The four components of the vector at an index. `word` gives each by its number in the array.
fn words(index: usize, word: impl Fn(usize) -> usize) -> Vec<f64> {
    (4 * index..4 * index + 4).map(|number| word(number) as f64).collect()
}

/// A box around the sheet, by the names of its corners and of its centre.
fn room(name: &str) -> Option<Vec<f64>> {
    match name {
        "low" => Some(vec![-4.0, -3.0, -5.0]),
        "high" => Some(vec![4.0, 3.5, 4.5]),
        "centre" => Some(vec![0.2, 0.1, 0.3]),
        _ => None,
    }
}

/// The columns of a matrix, by its name.
fn matrix(path: &str, name: &str) -> Option<Vec<f64>> {
    Some(match name {
        "world_from_view" => vec![1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0.2, 0.3, 3., 1.],
        "clip_from_world" if path.starts_with("camera") => {
            vec![0.9, 0., 0., 0., 0., 0.9, 0., 0., 0., 0., 0.2, 0.1, 0., 0., 0.5, 1.]
        }
        "clip_from_world" => {
            vec![0.5, 0., 0., 0., 0., 0.5, 0., 0.05, 0.1, 0., -0.3, 0., 0.03, 0.02, 0.5, 1.]
        }
        // One side of the sheet lies outside of the texture.
        "uv_from_world" => {
            vec![0.56, 0., 0., 0., 0., 0.45, 0., 0.05, 0.02, 0., 0.3, 0.1, 0.5, 0.48, 0.2, 1.]
        }
        "world_from_clip" | "view_from_world" => DMat4::IDENTITY.to_cols_array().to_vec(),
        "clip_from_view" => view_projection().to_cols_array().to_vec(),
        "view_from_clip" => view_projection().inverse().to_cols_array().to_vec(),
        "world_from_object" => {
            vec![1.05, 0., 0., 0., 0., 1.05, 0., 0., 0., 0., 1.05, 0., 0., 0., 0., 1.]
        }
        "normal_from_object" => {
            vec![1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.]
        }
        _ => return None,
    })
}

/// The viewer's projection, for programs that convert between view space and the screen.
fn view_projection() -> DMat4 {
    perspective(1.2, 1.0, 0.1, 12.0, Clip::Wgpu, Depth::Normal)
}

/// Samplers of textures that are not filtered.
const NEAREST: [&str; 2] = ["depth_sampler", "open_sampler"];

/// A texture or a sampler for a binding of a permutation. Colours vary smoothly, and depths have an
/// edge.
pub fn fixture(kind: BindingKind, name: &str, ty: &str, key: &str) -> Fixture {
    let sampler = |linear, compare| {
        Fixture::Sampler(FixtureSampler { compare, linear, address: Address::Clamp })
    };
    match kind {
        BindingKind::ComparisonSampler => sampler(true, Some(Compare::LessEqual)),
        BindingKind::Sampler => sampler(!NEAREST.contains(&name), None),
        _ => {
            let kind = match (ty.contains("depth"), ty.contains("cube")) {
                (true, true) => TextureKind::DepthCube,
                (true, false) => TextureKind::Depth2d,
                (false, true) => TextureKind::ColorCube,
                (false, false) => TextureKind::Color2d,
            };
            // `shadow_depth` is the depth map too, read as a colour texture.
            let is_depth = kind.is_depth() || name == "shadow_depth";
            // One texel for each pixel of any frame.
            let (width, height) = if name == "seen_occlusion" { (256, 64) } else { (8, 8) };
            let value = |index: usize| {
                let (x, y) = ((index % 8) as f32, (index / width as usize % 8) as f32);
                if is_depth {
                    if x < 4.0 { 0.25 } else { 0.875 }
                } else {
                    (20.0 + 3.0 * x + 2.0 * y) / 64.0
                }
            };
            let texels = (width * height * kind.layers()) as usize;
            let given = Given::new(name, key);
            let own = move |index: usize, channel: usize| given.color(value, index, channel);
            let channel =
                |index: usize| (0..kind.channels()).map(move |channel| own(index, channel));
            Fixture::Texture(FixtureTexture {
                kind,
                width,
                height,
                texels: (0..texels).flat_map(channel).collect(),
            })
        }
    }
}

/// What the texels of a colour texture mean.
#[derive(Clone, Copy)]
enum Given {
    Colors,
    /// Four moments of the depth. They vary little, since solving for four moments loses precision.
    FourMoments,
    /// Normals near that of the surface, so that errors change their directions little.
    Normals,
    /// Normals that vary a sixteenth as much as [`Self::Normals`], since the formulas of area
    /// lights, of anisotropic reflections and of light probes amplify errors of directions.
    NearNormals,
    /// Normals that vary as little as [`Self::NearNormals`], in octahedral encoding.
    NearOctahedral,
    /// Matrices of linearly transformed cosines, of wide lobes and with a positive determinant.
    Lobes,
    /// Directions whose vectors are not near zero, so that normalising them is accurate.
    Directions,
    /// Roughnesses, so large that errors stay small.
    Roughnesses,
}

impl Given {
    fn new(name: &str, key: &str) -> Self {
        let is_sensitive =
            ["area=", "anisotropy", "ambient=ddgi"].iter().any(|axis| key.contains(axis));
        match name {
            "shadow_moments" if key.contains("shadow=msm") => Self::FourMoments,
            "normal_map" if is_sensitive => Self::NearNormals,
            "normal_map" => Self::Normals,
            "surface_normal" if is_sensitive => Self::NearOctahedral,
            "ltc_table" => Self::Lobes,
            "anisotropy_map" => Self::Directions,
            "metallic_roughness_map" | "surface_factors" | "clearcoat_map" => Self::Roughnesses,
            _ => Self::Colors,
        }
    }

    /// A channel of a texel; `value` varies smoothly with the index.
    fn color(self, value: impl Fn(usize) -> f32, index: usize, channel: usize) -> f32 {
        let turned = value(index + 5 * channel);
        match (self, channel) {
            // The moments of three depths, which `factor` gives as multiples of powers of one
            // depth.
            (Self::FourMoments, _) => {
                let factor = [1.0, 1.42667, 2.28, 3.83307][channel];
                factor * (0.49 + 0.02 * value(index)).powi(channel as i32 + 1)
            }
            (Self::Normals, 0 | 1) => 0.25 + 0.5 * turned,
            (Self::NearNormals, 0 | 1) => 0.484375 + 0.03125 * turned,
            (Self::Normals | Self::NearNormals, _) => 0.96875,
            (Self::NearOctahedral, 0 | 1) => 0.5 + 0.03125 * turned,
            (Self::Lobes, 1 | 2) => 0.25 * value(index) - 0.1875,
            (Self::Directions, 0) | (Self::Roughnesses, 1) => 0.75 + 0.25 * value(index),
            _ => value(index) + channel as f32 / 16.0,
        }
    }
}
