//! The resources that a module's bindings are bound to.

use super::code::Compare;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The resources, by group and binding.
#[derive(Debug, Clone, Default)]
pub struct Resources {
    /// Uniform and storage buffers as bytes, laid out as the shader declares.
    pub buffers: BTreeMap<(u32, u32), Vec<u8>>,
    /// Textures by group and binding.
    pub textures: BTreeMap<(u32, u32), Texture>,
    /// Samplers by group and binding.
    pub samplers: BTreeMap<(u32, u32), Sampler>,
}

/// Complete textures, and samplers, by the index of the variable that they are bound to.
#[derive(Debug, Clone, Default)]
pub(super) struct BoundTextures {
    pub textures: Vec<Option<Texture>>,
    pub samplers: Vec<Option<Sampler>>,
}

impl BoundTextures {
    /// What is bound to variables, from the group and binding of each.
    pub fn of(
        resources: &Resources,
        places: impl Iterator<Item = Option<(u32, u32)>> + Clone,
    ) -> Self {
        let texture = |place: Option<(u32, u32)>| {
            resources.textures.get(&place?).filter(|texture| texture.is_complete()).cloned()
        };
        let sampler = |place: Option<(u32, u32)>| resources.samplers.get(&place?).copied();
        Self {
            textures: places.clone().map(texture).collect(),
            samplers: places.map(sampler).collect(),
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TextureDimension {
    /// A row.
    D1,
    /// A rectangle.
    D2,
    /// A box.
    D3,
    /// Six layers make one cube: +x, -x, +y, -y, +z, -z.
    Cube,
}

/// A texture. Depth is in the first component.
#[derive(Debug, Clone, PartialEq)]
pub struct Texture {
    /// How its texels are arranged.
    pub shape: TextureDimension,
    /// The largest level first.
    pub levels: Vec<MipLevel>,
}

/// One level of a texture: texels row by row, layer by layer (or slice by slice).
#[derive(Debug, Clone, PartialEq)]
pub struct MipLevel {
    /// Texels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Layers of an array, faces of cubes, slices of a 3D texture.
    pub layers: u32,
    /// Row by row, layer by layer. They are shared, so that every thread can have the texture.
    pub texels: Arc<Texels>,
}

/// The texels of a level.
#[derive(Debug, Clone, PartialEq)]
pub enum Texels {
    /// Four components each.
    Whole(Vec<[f64; 4]>),
    /// `count` components each, interleaved. The missing ones are 0.
    Channels {
        /// How many components a texel has, 1 to 4.
        count: usize,
        /// The components of all texels.
        values: Vec<f32>,
    },
}

impl Texels {
    /// How many there are.
    pub fn count(&self) -> usize {
        match self {
            Self::Whole(texels) => texels.len(),
            Self::Channels { count, values } => values.len().checked_div(*count).unwrap_or(0),
        }
    }

    /// A texel by its index.
    #[inline(always)]
    pub fn get(&self, index: usize) -> Option<[f64; 4]> {
        match self {
            Self::Whole(texels) => texels.get(index).copied(),
            Self::Channels { count: 4, values } => values
                .get(4 * index..4 * index + 4)
                .map(|texel| [0, 1, 2, 3].map(|i| f64::from(texel[i]))),
            Self::Channels { count: 1, values } => {
                values.get(index).map(|value| [f64::from(*value), 0.0, 0.0, 0.0])
            }
            Self::Channels { count, values } => {
                let texel = values.get(count * index..count * (index + 1))?;
                Some([0, 1, 2, 3].map(|i| texel.get(i).map_or(0.0, |value| f64::from(*value))))
            }
        }
    }

    /// All of them in order.
    pub fn iter(&self) -> impl Iterator<Item = [f64; 4]> + '_ {
        (0..self.count()).filter_map(|index| self.get(index))
    }
}

/// What a sampler returns for coordinates outside of a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub enum Address {
    /// The texel at the edge.
    #[default]
    Clamp,
    /// The image again.
    Repeat,
    /// The image again, mirrored each second time.
    Mirror,
}

impl Address {
    /// The name in a case file, and the mode.
    pub const NAMES: &'static [(&'static str, Self)] =
        &[("clamp", Self::Clamp), ("repeat", Self::Repeat), ("mirror", Self::Mirror)];

    /// The index of the texel that is read for `index`, on an axis of `size` texels.
    pub fn wrap(self, index: i64, size: u32) -> u32 {
        let size = i64::from(size);
        (match self {
            Self::Clamp => index.clamp(0, size - 1),
            Self::Repeat => index.rem_euclid(size),
            Self::Mirror => {
                let folded = index.rem_euclid(2 * size);
                folded.min(2 * size - 1 - folded)
            }
        }) as u32
    }
}

/// How texels and levels are combined.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Filter {
    /// The one texel that is nearest.
    #[default]
    Nearest,
    /// A weighted mean of the nearest texels.
    Linear,
}

/// A sampler; with a comparison it is a `sampler_comparison`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sampler {
    /// For u, v and w.
    pub address: [Address; 3],
    /// Where a texel covers more than a fragment.
    pub mag: Filter,
    /// Where a fragment covers more than a texel.
    pub min: Filter,
    /// Between two levels.
    pub mipmap: Filter,
    /// Least and greatest level of detail; with `(0, 0)` only the first level is used.
    pub levels: (f64, f64),
    /// How a reference is compared with what is stored, in a sampler that compares.
    pub compare: Option<Compare>,
}

impl Texture {
    /// A texture of one level, its texels row by row.
    pub fn flat(
        shape: TextureDimension,
        width: u32,
        height: u32,
        layers: u32,
        texels: Vec<[f64; 4]>,
    ) -> Self {
        Self::of(shape, width, height, layers, Texels::Whole(texels))
    }

    /// As [`Self::flat`], with texels of fewer components.
    pub fn of(
        shape: TextureDimension,
        width: u32,
        height: u32,
        layers: u32,
        texels: Texels,
    ) -> Self {
        let texels = Arc::new(texels);
        Self { shape, levels: vec![MipLevel { width, height, layers, texels }] }
    }

    /// Whether every level has as many texels as its size says, and a cube has whole cubes.
    pub(super) fn is_complete(&self) -> bool {
        let filled = |level: &MipLevel| {
            let size = u64::from(level.width) * u64::from(level.height) * u64::from(level.layers);
            size > 0
                && size == level.texels.count() as u64
                && (self.shape != TextureDimension::Cube || level.layers.is_multiple_of(6))
        };
        !self.levels.is_empty() && self.levels.iter().all(filled)
    }
}

impl MipLevel {
    /// The texel at column, row and layer.
    pub(super) fn texel(&self, [x, y, z]: [i64; 3]) -> Option<[f64; 4]> {
        let within = |at: i64, size: u32| usize::try_from(at).ok().filter(|at| *at < size as usize);
        let (x, y, z) = (within(x, self.width)?, within(y, self.height)?, within(z, self.layers)?);
        self.texels.get((z * self.height as usize + y) * self.width as usize + x)
    }
}
