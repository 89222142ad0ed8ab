//! What a module's bindings are bound to.

use super::code::Compare;
use std::collections::BTreeMap;

/// Values of bindings, by group and binding.
#[derive(Debug, Clone, Default)]
pub struct Resources {
    /// Uniform and storage buffers as bytes, laid out as the shader declares.
    pub buffers: BTreeMap<(u32, u32), Vec<u8>>,
    pub textures: BTreeMap<(u32, u32), Texture>,
    pub samplers: BTreeMap<(u32, u32), Sampler>,
}

/// How a texture is addressed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    D1,
    D2,
    D3,
    /// Six layers make one cube: +x, -x, +y, -y, +z, -z.
    Cube,
}

/// A texture. Depth is in the first component.
#[derive(Debug, Clone, PartialEq)]
pub struct Texture {
    pub shape: Shape,
    /// The largest level first.
    pub levels: Vec<Level>,
}

/// One level of a texture: texels row by row, layer by layer (or slice by slice).
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    pub width: u32,
    pub height: u32,
    /// Layers of an array, faces of cubes, slices of a 3D texture.
    pub layers: u32,
    pub texels: Vec<[f64; 4]>,
}

/// How coordinates outside of a texture are answered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Address {
    #[default]
    Clamp,
    Repeat,
    Mirror,
}

/// Between texels and between levels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Filter {
    #[default]
    Nearest,
    Linear,
}

/// A sampler; with a comparison it is a `sampler_comparison`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sampler {
    /// For u, v and w.
    pub address: [Address; 3],
    pub mag: Filter,
    pub min: Filter,
    pub mipmap: Filter,
    /// Least and greatest level; `(0, 0)` keeps the first.
    pub levels: (f64, f64),
    pub compare: Option<Compare>,
}
