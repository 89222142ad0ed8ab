//! Textures and samplers that the parameters of a function under test are bound to.

use super::kernel::ResourceClass;
pub use lamplight_eval::{Address, Compare};
use naga::{ImageClass, ImageDimension, ScalarKind};

/// A texture or a sampler.
#[derive(Debug, Clone, PartialEq)]
pub enum Fixture {
    Texture(FixtureTexture),
    Sampler(FixtureSampler),
}

/// The texels of one level, as f32.
#[derive(Debug, Clone, PartialEq)]
pub struct FixtureTexture {
    pub kind: TextureKind,
    pub width: u32,
    pub height: u32,
    /// Row by row from the top, layer by layer (cube faces +x, -x, +y, -y, +z, -z): one value per
    /// texel for depth, four for colour.
    pub texels: Vec<f32>,
}

/// Kinds of texture a fixture may be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TextureKind {
    Depth2d,
    DepthCube,
    Color2d,
    ColorCube,
}

impl TextureKind {
    /// The name in a case file, and the kind.
    pub const NAMES: &'static [(&'static str, Self)] = &[
        ("depth_2d", Self::Depth2d),
        ("depth_cube", Self::DepthCube),
        ("color_2d", Self::Color2d),
        ("color_cube", Self::ColorCube),
    ];

    /// How many values a texel has.
    pub fn channels(self) -> usize {
        if self.is_depth() { 1 } else { 4 }
    }

    /// 1, or 6 for cubes.
    pub fn layers(self) -> u32 {
        if matches!(self, Self::DepthCube | Self::ColorCube) { 6 } else { 1 }
    }

    /// Whether it is sampled as depth.
    pub fn is_depth(self) -> bool {
        matches!(self, Self::Depth2d | Self::DepthCube)
    }
}

/// How a texture is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct FixtureSampler {
    pub compare: Option<Compare>,
    pub linear: bool,
    pub address: Address,
}

impl FixtureSampler {
    /// WebGPU's names of the address mode and of the comparison.
    pub fn web_words(self) -> (&'static str, Option<String>) {
        let address = match self.address {
            Address::Clamp => "clamp-to-edge",
            Address::Repeat => "repeat",
            Address::Mirror => "mirror-repeat",
        };
        let name = |compare| Compare::NAMES.iter().find(|(_, found)| *found == compare);
        (address, self.compare.and_then(name).map(|(name, _)| name.replace('_', "-")))
    }
}

impl Fixture {
    /// The sampler, if it is one.
    pub fn sampler(&self) -> Option<FixtureSampler> {
        match self {
            Self::Sampler(sampler) => Some(*sampler),
            Self::Texture(_) => None,
        }
    }

    /// Whether the shader's declaration can be bound to it.
    pub fn fits(&self, class: ResourceClass) -> bool {
        match (self, class) {
            (Self::Sampler(sampler), ResourceClass::Sampler { comparison }) => {
                comparison == sampler.compare.is_some()
            }
            (Self::Texture(texture), ResourceClass::Texture { dim, arrayed: false, class }) => {
                let depth = match class {
                    ImageClass::Depth { multi: false } => true,
                    ImageClass::Sampled { kind: ScalarKind::Float, multi: false } => false,
                    _ => return false,
                };
                let cube = dim == ImageDimension::Cube;
                (cube || dim == ImageDimension::D2)
                    && cube == (texture.kind.layers() == 6)
                    && depth == texture.kind.is_depth()
            }
            _ => false,
        }
    }

    /// A description for diagnostics.
    pub fn describe(&self) -> String {
        match self {
            Self::Texture(texture) => {
                let name = TextureKind::NAMES
                    .iter()
                    .find(|(_, kind)| *kind == texture.kind)
                    .map_or("texture", |(name, _)| name);
                format!("a {name} of {} x {}", texture.width, texture.height)
            }
            Self::Sampler(FixtureSampler { compare: Some(_), .. }) => {
                "a comparison sampler".to_owned()
            }
            Self::Sampler(_) => "a sampler without comparison".to_owned(),
        }
    }
}

impl FixtureTexture {
    /// One channel of a texel.
    pub fn texel(&self, x: u32, y: u32, layer: u32, channel: usize) -> f64 {
        let index =
            (layer as usize * self.height as usize + y as usize) * self.width as usize + x as usize;
        f64::from(self.texels[index * self.kind.channels() + channel])
    }
}
