//! Writes requests to the runtime of compiled shaders, as words. `shim/runtime.cpp` reads them.

use std::collections::BTreeMap;

use lamplight_bundle::{Binding, Native, Reflection};
use lamplight_eval::{
    Address, Compare, Filter, MipLevel, Resources, Sampler, Texture, TextureDimension,
};

pub type RequestWords = Vec<u32>;

/// The resources, by the slots of Metal's argument tables.
#[derive(Debug, Clone, Default)]
pub struct MetalResources {
    pub buffers: BTreeMap<u32, Vec<u8>>,
    pub textures: BTreeMap<u32, MetalImage>,
    pub samplers: BTreeMap<u32, Sampler>,
}

/// A texture as words: four for each texel, row by row, layer by layer.
#[derive(Debug, Clone)]
pub struct MetalImage {
    pub shape: TextureDimension,
    pub format: TexelFormat,
    /// The largest level first.
    pub levels: Vec<ImageLevel>,
}

/// What the words of a texture are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TexelFormat {
    Float,
    Signed,
    Unsigned,
}

#[derive(Debug, Clone)]
pub struct ImageLevel {
    pub width: u32,
    pub height: u32,
    pub layers: u32,
    pub words: RequestWords,
}

#[derive(Debug, Clone, Default)]
pub struct VertexInput {
    pub index: u32,
    pub instance: u32,
    /// Four words for each attribute.
    pub locations: Vec<[u32; 4]>,
}

/// The results of the vertex stage.
#[derive(Debug, Clone, PartialEq)]
pub struct Transformed {
    pub position: [f32; 4],
    pub locations: Vec<[u32; 4]>,
}

#[derive(Debug, Clone, Default)]
pub struct FragmentInput {
    /// x, y, depth, 1/w.
    pub position: [f32; 4],
    pub front: bool,
    pub locations: Vec<[u32; 4]>,
}

/// The results of the fragment stage.
#[derive(Debug, Clone, PartialEq)]
pub struct ShadedFragment {
    pub depth: f32,
    pub is_discarded: bool,
    /// Four words for each target.
    pub targets: Vec<[u32; 4]>,
}

impl MetalResources {
    /// Assigns the resources to Metal's slots, by the table of slots in `native`.
    pub fn new(resources: &Resources, native: &Native, reflection: &Reflection) -> Self {
        let mut bound = Self::default();
        for slot in &native.slots {
            let (Some(index), place) = (slot.index, (slot.group, slot.binding)) else { continue };
            if let Some(bytes) = resources.buffers.get(&place) {
                bound.buffers.insert(index, bytes.clone());
            } else if let Some(sampler) = resources.samplers.get(&place) {
                bound.samplers.insert(index, *sampler);
            } else if let Some(texture) = resources.textures.get(&place) {
                let is_it = |binding: &&Binding| (binding.group, binding.binding) == place;
                let binding = reflection.bindings.iter().find(is_it);
                let format =
                    binding.map_or(TexelFormat::Float, |binding| TexelFormat::of(&binding.ty));
                bound.textures.insert(index, MetalImage::new(texture, format));
            }
        }
        bound
    }
}

impl TexelFormat {
    /// The format of a texture, from its type in WGSL.
    fn of(ty: &str) -> Self {
        match ty {
            _ if ty.contains("<u32") => Self::Unsigned,
            _ if ty.contains("<i32") => Self::Signed,
            _ => Self::Float,
        }
    }

    fn word(self, value: f64) -> u32 {
        match self {
            Self::Float => (value as f32).to_bits(),
            Self::Signed => value as i32 as u32,
            Self::Unsigned => value as u32,
        }
    }
}

impl MetalImage {
    /// A texture of the evaluator, as words.
    pub fn new(texture: &Texture, format: TexelFormat) -> Self {
        let level = |level: &MipLevel| ImageLevel {
            width: level.width,
            height: level.height,
            layers: level.layers,
            words: level.texels.iter().flatten().map(|value| format.word(value)).collect(),
        };
        let levels = texture.levels.iter().map(level).collect();
        Self { shape: texture.shape, format, levels }
    }
}

impl Transformed {
    pub(super) fn from_words(words: &[u32]) -> Self {
        let (four, _) = words.as_chunks::<4>();
        let position = four.first().map_or([0.0; 4], |words| words.map(f32::from_bits));
        Self { position, locations: four.get(1..).unwrap_or_default().to_vec() }
    }
}

impl ShadedFragment {
    pub(super) fn from_words(words: &[u32]) -> Self {
        let (four, _) = words.as_chunks::<4>();
        let [depth, discarded, ..] = four.first().copied().unwrap_or_default();
        Self {
            depth: f32::from_bits(depth),
            is_discarded: discarded != 0,
            targets: four.get(1..).unwrap_or_default().to_vec(),
        }
    }
}

/// Writes parts of requests.
pub mod words {
    use super::{
        Address, Compare, Filter, MetalImage, MetalResources, RequestWords, Sampler, TexelFormat,
        TextureDimension,
    };

    /// Writes `count` locations. Those that are not given are 0.
    pub fn locations(to: &mut RequestWords, locations: &[[u32; 4]], count: u32) {
        let given = locations.iter().copied().chain(std::iter::repeat([0; 4]));
        to.extend(given.take(count as usize).flatten());
    }

    /// Buffers, textures, samplers.
    pub fn bound(to: &mut RequestWords, bound: &MetalResources) {
        to.push(bound.buffers.len() as u32);
        for (slot, bytes) in &bound.buffers {
            to.extend([*slot, bytes.len() as u32]);
            let (whole, rest) = bytes.as_chunks::<4>();
            to.extend(whole.iter().map(|bytes| u32::from_ne_bytes(*bytes)));
            if !rest.is_empty() {
                let mut last = [0; 4];
                last[..rest.len()].copy_from_slice(rest);
                to.push(u32::from_ne_bytes(last));
            }
        }
        to.push(bound.textures.len() as u32);
        bound.textures.iter().for_each(|(slot, image)| texture(to, *slot, image));
        to.push(bound.samplers.len() as u32);
        bound.samplers.iter().for_each(|(slot, settings)| sampler(to, *slot, settings));
    }

    fn texture(to: &mut RequestWords, slot: u32, image: &MetalImage) {
        let shape = match image.shape {
            TextureDimension::D1 => 1,
            TextureDimension::D2 => 2,
            TextureDimension::D3 => 3,
            TextureDimension::Cube => 6,
        };
        let format = match image.format {
            TexelFormat::Float => 0,
            TexelFormat::Signed => 1,
            TexelFormat::Unsigned => 2,
        };
        to.extend([slot, shape, format, image.levels.len() as u32]);
        for level in &image.levels {
            to.extend([level.width, level.height, level.layers]);
            to.extend(&level.words);
        }
    }

    fn sampler(to: &mut RequestWords, slot: u32, sampler: &Sampler) {
        to.push(slot);
        to.extend(sampler.address.map(|address| match address {
            Address::Clamp => 0,
            Address::Repeat => 1,
            Address::Mirror => 2,
        }));
        to.extend([sampler.mag, sampler.min, sampler.mipmap].map(|filter| match filter {
            Filter::Nearest => 0,
            Filter::Linear => 1,
        }));
        to.extend([sampler.levels.0, sampler.levels.1].map(|level| (level as f32).to_bits()));
        to.push(match sampler.compare {
            None => 0,
            Some(Compare::Less) => 2,
            Some(Compare::LessEqual) => 3,
            Some(Compare::Greater) => 4,
            Some(Compare::GreaterEqual) => 5,
            Some(Compare::Equal) => 6,
            Some(Compare::NotEqual) => 7,
        });
    }
}
