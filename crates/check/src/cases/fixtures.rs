//! Reads `[fixture.NAME]` tables: samplers, and textures made from a pattern.

use super::reader::CaseNode;
use lamplight_diagnostic::{Diagnostic, Diagnostics};
use lamplight_execute::fixture::{
    Address, Compare, Fixture, FixtureSampler, FixtureTexture, TextureKind,
};

const TEXTURE_KEYS: &[&str] =
    &["kind", "size", "pattern", "low", "high", "cells", "edge", "texels"];
const SAMPLER_KEYS: &[&str] = &["kind", "compare", "filter", "address"];

/// A pattern: gives the weight of `high`, from the settings, the place in [0, 1)^2 and the layer.
type Pattern = fn(&FixtureSettings, f64, f64, u32) -> f64;

const PATTERNS: &[(&str, Pattern)] = &[
    ("constant", |_, _, _, _| 0.0),
    ("gradient", |_, x, y, layer| (x + y + f64::from(layer) / 6.0) / 3.0),
    ("checker", |settings, x, y, layer| {
        f64::from(((x * settings.cells) as u32 + (y * settings.cells) as u32 + layer) % 2)
    }),
    ("half_plane", |settings, x, _, _| if x < settings.edge { 0.0 } else { 1.0 }),
    (
        "box",
        |settings, x, y, _| {
            if x.min(y).min(1.0 - x).min(1.0 - y) > settings.edge { 0.0 } else { 1.0 }
        },
    ),
];

struct FixtureSettings {
    low: Vec<f64>,
    high: Vec<f64>,
    cells: f64,
    edge: f64,
}

pub fn read_fixture(node: &CaseNode) -> Result<Fixture, Diagnostics> {
    let kind = node.required("kind").map_err(one_error)?;
    if kind.text().map_err(one_error)? == "sampler" {
        node.only(SAMPLER_KEYS)?;
        return read_sampler(node).map(Fixture::Sampler).map_err(one_error);
    }
    node.only(TEXTURE_KEYS)?;
    read_texture(node, kind.choice(TextureKind::NAMES).map_err(one_error)?)
        .map(Fixture::Texture)
        .map_err(one_error)
}

fn one_error(error: Diagnostic) -> Diagnostics {
    vec![error]
}

fn read_sampler(node: &CaseNode) -> Result<FixtureSampler, Diagnostic> {
    let compare = node.get("compare").map(|node| node.choice(Compare::NAMES)).transpose()?;
    let linear = node
        .get("filter")
        .map_or(Ok(false), |node| node.choice(&[("linear", true), ("nearest", false)]))?;
    let address =
        node.get("address").map_or(Ok(Address::Clamp), |node| node.choice(Address::NAMES))?;
    Ok(FixtureSampler { compare, linear, address })
}

fn read_texture(node: &CaseNode, kind: TextureKind) -> Result<FixtureTexture, Diagnostic> {
    let size = node.required("size")?;
    let (width, height) = match size.elements()? {
        [width, height] => (width.count(1, 1024)?, height.count(1, 1024)?),
        _ => return Err(size.error("expected `[width, height]`")),
    };
    if kind.layers() == 6 && width != height {
        return Err(size.error("faces of a cube are square"));
    }
    let wanted = width as usize * height as usize * kind.layers() as usize * kind.channels();
    let texels = match node.get("texels") {
        Some(texels) => explicit_texels(texels, wanted)?,
        None => patterned_texels(node, kind, width, height)?,
    };
    if kind.is_depth() && texels.iter().any(|depth| !(0.0..=1.0).contains(depth)) {
        return Err(node.error("depths lie in [0, 1]"));
    }
    Ok(FixtureTexture { kind, width, height, texels })
}

fn explicit_texels(node: &CaseNode, wanted: usize) -> Result<Vec<f32>, Diagnostic> {
    let texels: Vec<f32> = node.numbers()?.into_iter().map(|value| value as f32).collect();
    if texels.len() != wanted {
        return Err(node.error(format!("expected {wanted} values, found {}", texels.len())));
    }
    Ok(texels)
}

fn patterned_texels(
    node: &CaseNode,
    kind: TextureKind,
    width: u32,
    height: u32,
) -> Result<Vec<f32>, Diagnostic> {
    let pattern = node.required("pattern")?.choice(PATTERNS)?;
    let numbers =
        |name: &str, default: f64| node.get(name).map_or(Ok(vec![default]), CaseNode::numbers);
    let number = |name: &str, default: f64| node.get(name).map_or(Ok(default), CaseNode::number);
    let settings = FixtureSettings {
        low: numbers("low", 0.0)?,
        high: numbers("high", 1.0)?,
        cells: number("cells", 4.0)?,
        edge: number("edge", 0.5)?,
    };
    let channel =
        |values: &[f64], index: usize| values.get(index).or(values.last()).copied().unwrap_or(0.0);
    let mut texels = Vec::new();
    for (layer, y) in (0..kind.layers()).flat_map(|layer| (0..height).map(move |y| (layer, y))) {
        for x in 0..width {
            let weight = pattern(
                &settings,
                (f64::from(x) + 0.5) / f64::from(width),
                (f64::from(y) + 0.5) / f64::from(height),
                layer,
            );
            let mix = |index| {
                channel(&settings.low, index) * (1.0 - weight)
                    + channel(&settings.high, index) * weight
            };
            texels.extend((0..kind.channels()).map(|index| mix(index) as f32));
        }
    }
    Ok(texels)
}
