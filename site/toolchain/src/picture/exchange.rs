//! What a page asks for, and is given to draw.

use std::collections::BTreeMap;

use lamplight::bundle::{Native, Reflection};
use serde::{Deserialize, Serialize};
use tsify::Tsify;

use crate::diagnostic::Diagnostic;

/// What is drawn, as `lamplight render` takes it.
#[derive(Clone, PartialEq, Deserialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct PictureRequest {
    /// A published example.
    #[serde(default)]
    #[tsify(optional)]
    pub preset: Option<String>,
    /// The program; that of the preset, or `forward`.
    #[serde(default)]
    #[tsify(optional)]
    pub program: Option<String>,
    /// A permutation of it; that of the preset, or the default.
    #[serde(default)]
    #[tsify(optional)]
    pub key: Option<String>,
    /// One of `scenes`.
    #[serde(default)]
    #[tsify(optional)]
    pub scene: Option<String>,
    /// One of `environments`. Without it, the scene chooses.
    #[serde(default)]
    #[tsify(optional)]
    pub environment: Option<String>,
    pub width: u32,
    pub height: u32,
    /// How many places of each pixel are averaged.
    pub samples: u32,
    /// Factor on all light, in powers of two.
    #[serde(default)]
    #[tsify(optional)]
    pub exposure: f64,
    /// Whether the GLSL programs are drawn.
    #[serde(default)]
    #[tsify(optional)]
    pub glsl: bool,
    /// Numbers of uniforms by group and field, such as `light.position`. They replace those of the
    /// preset.
    #[serde(default)]
    #[tsify(optional, type = "Record<string, Record<string, number[]>>")]
    pub numbers: BTreeMap<String, BTreeMap<String, Vec<f64>>>,
    /// Numbers of uniforms by path, as `pictureControls` lists them. They replace all others.
    #[serde(default)]
    #[tsify(optional, type = "Record<string, number[]>")]
    pub uniforms: BTreeMap<String, Vec<f64>>,
    /// Places of lamps in world space, by their index.
    #[serde(default)]
    #[tsify(optional, type = "Record<string, number[]>")]
    pub lamps: BTreeMap<String, Vec<f64>>,
    /// How far the viewer has walked around what is looked at, and up, in radians.
    #[serde(default)]
    #[tsify(optional)]
    pub turn: [f64; 2],
    /// What the page draws with: `wgsl` for WebGPU, `essl300` for WebGL2.
    pub target: String,
}

/// What to do next.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct Step {
    /// Draw this and hand the words to `pictureFrames`.
    pub drawing: Option<Drawing>,
    /// The picture is done.
    pub picture: Option<Pixels>,
    pub diagnostics: Vec<Diagnostic>,
}

/// Colours in sRGB.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct Pixels {
    pub width: u32,
    pub height: u32,
    /// Four bytes a pixel, row by row from the top.
    #[serde(serialize_with = "as_bytes")]
    #[tsify(type = "Uint8Array")]
    pub rgba: Vec<u8>,
}

/// One draw, into a frame for each view. Bytes are little-endian words.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct Drawing {
    pub vertex: Stage,
    /// Without it, only depth is drawn.
    pub fragment: Option<Stage>,
    /// How many locations the fragment stage writes, each with four 32-bit numbers.
    pub targets: u32,
    pub meshes: Vec<Mesh>,
    pub views: Vec<Vec<Buffer>>,
    pub buffers: Vec<Buffer>,
    pub textures: Vec<TextureInfo>,
    pub samplers: Vec<SamplerInfo>,
    pub width: u32,
    pub height: u32,
    pub depth_test: bool,
    pub keep_depth: bool,
    /// `front`, `back` or `none`.
    pub cull: String,
    /// Whether front faces wind clockwise.
    pub mirrored: bool,
    /// Polygon offset: the factor of the slope, and the number of smallest steps.
    pub offset: [f32; 2],
}

/// A stage in the target of the request.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct Stage {
    pub text: String,
    #[tsify(type = "Native")]
    pub native: Native,
    #[tsify(type = "Reflection")]
    pub reflection: Reflection,
}

/// Triangles with buffers of their own.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct Mesh {
    pub attributes: Vec<Attribute>,
    pub stride: u32,
    /// Without attributes, one triangle that the vertex stage makes from the index.
    pub vertices: u32,
    #[serde(serialize_with = "as_bytes")]
    #[tsify(type = "Uint8Array")]
    pub words: Vec<u8>,
    /// Three for each triangle; empty where every three vertices in order are one.
    #[serde(serialize_with = "as_bytes")]
    #[tsify(type = "Uint8Array")]
    pub indices: Vec<u8>,
    pub buffers: Vec<Buffer>,
}

/// An attribute of a vertex.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct Attribute {
    pub location: u32,
    /// WebGPU's name of the format, such as `float32x3`.
    pub format: String,
    pub offset: u32,
}

/// A uniform buffer.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct Buffer {
    pub group: u32,
    pub binding: u32,
    #[serde(serialize_with = "as_bytes")]
    #[tsify(type = "Uint8Array")]
    pub bytes: Vec<u8>,
}

/// A texture in f32, with one number per texel for depth and four for colour.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct TextureInfo {
    pub group: u32,
    pub binding: u32,
    pub depth: bool,
    /// Six layers: +x, -x, +y, -y, +z, -z.
    pub cube: bool,
    /// The largest first.
    pub levels: Vec<Level>,
}

/// A level of a texture.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct Level {
    pub width: u32,
    pub height: u32,
    #[serde(serialize_with = "as_bytes")]
    #[tsify(type = "Uint8Array")]
    pub bytes: Vec<u8>,
}

/// How a texture is read.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct SamplerInfo {
    pub group: u32,
    pub binding: u32,
    /// WebGPU's name of the comparison, such as `less-equal`.
    pub compare: Option<String>,
    pub linear: bool,
    /// WebGPU's name of the address mode, such as `clamp-to-edge`.
    pub address: String,
}

fn as_bytes<S: serde::Serializer>(bytes: &[u8], to: S) -> Result<S::Ok, S::Error> {
    to.serialize_bytes(bytes)
}

/// What there is to choose for pictures.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct Studio {
    pub scenes: Vec<Named>,
    pub environments: Vec<String>,
    pub presets: Vec<PresetInfo>,
}

/// A name with one line about it.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct Named {
    pub name: String,
    pub about: String,
}

/// A published example.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct PresetInfo {
    pub name: String,
    pub doc: String,
    pub source: String,
    pub program: String,
    pub key: String,
    pub scene: String,
    pub deviations: Vec<String>,
}
