//! What an engine needs to know about a shader to use it.

use serde::{Deserialize, Serialize};

use super::names::Stage;

/// One entry point. This is the same for every target. Types are spelt as in WGSL; sizes, offsets
/// and strides are in bytes.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Reflection {
    /// Stage of the entry point.
    pub stage: Stage,
    /// The size of a workgroup, for compute shaders.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub workgroup_size: Option<[u32; 3]>,
    /// What enters the entry point: vertex attributes, or outputs of the vertex stage.
    pub inputs: Vec<Varying>,
    /// What leaves it: to the fragment stage, or to the attachments.
    pub outputs: Vec<Varying>,
    /// Resources that are used, by group and binding.
    pub bindings: Vec<Binding>,
    /// Which textures are sampled with which samplers, sorted.
    pub pairs: Vec<Pair>,
    /// Constants that the host may choose when it creates a pipeline.
    pub overrides: Vec<Override>,
}

impl Reflection {
    /// The reflection of an entry point that uses nothing.
    pub fn of(stage: Stage) -> Self {
        Self {
            stage,
            workgroup_size: None,
            inputs: Vec::new(),
            outputs: Vec::new(),
            bindings: Vec::new(),
            pairs: Vec::new(),
            overrides: Vec::new(),
        }
    }
}

/// A value that enters or leaves the stage.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Varying {
    /// The author's name of the argument or the member.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Its `@location`, unless it is a built-in.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub location: Option<u32>,
    /// Its `@builtin`, by the name in WGSL.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub builtin: Option<String>,
    /// Type in WGSL.
    #[serde(rename = "type")]
    pub ty: String,
    /// The type as numbers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shape: Option<Shape>,
    /// `perspective`, `linear` or `flat`, between stages.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interpolation: Option<String>,
    /// `center`, `centroid` or `sample`, between stages.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sampling: Option<String>,
    /// Which source for blending an output is, with two sources: 0 or 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub blend_src: Option<u32>,
}

/// What a binding holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", rename = "Kind")]
pub enum BindingKind {
    /// A buffer of constants.
    Uniform,
    /// A storage buffer.
    Storage,
    /// A texture that is sampled or loaded from.
    Texture,
    /// A texture that is written to.
    StorageTexture,
    /// A sampler that filters.
    Sampler,
    /// A sampler that compares with a reference depth.
    ComparisonSampler,
    /// Constants that are set with the commands: `var<immediate>` in WGSL, push constants in Vulkan.
    /// Targets without them have a uniform buffer in the group and binding of the reflection.
    Immediate,
}

impl BindingKind {
    /// Whether it is memory with a layout.
    pub fn is_buffer(self) -> bool {
        matches!(self, Self::Uniform | Self::Storage | Self::Immediate)
    }
}

/// A resource.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Binding {
    /// Group in WGSL, descriptor set in Vulkan.
    pub group: u32,
    /// Number within the group.
    pub binding: u32,
    /// As the author calls it.
    pub name: String,
    /// What is bound there.
    pub kind: BindingKind,
    /// Type in WGSL.
    #[serde(rename = "type")]
    pub ty: String,
    /// How many bindings an array of them has; 0 if the host decides it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub count: Option<u32>,
    /// The size of a buffer. A runtime-sized array at its end counts as one element, as in WebGPU's
    /// smallest size of a binding.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size: Option<u32>,
    /// Whether the shader writes to it, or declares it as a buffer or a texture that may be written.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub writable: bool,
    /// The type of a buffer that is no struct, as numbers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shape: Option<Shape>,
    /// The type of a texture, as fields.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub texture: Option<TextureShape>,
    /// Members of a buffer that is a struct.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub members: Vec<Member>,
}

/// A member of a struct in a buffer.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Member {
    /// As the author calls it.
    pub name: String,
    /// Type in WGSL.
    #[serde(rename = "type")]
    pub ty: String,
    /// Offset from the start of the struct that it is in.
    pub offset: u32,
    /// Bytes of the member.
    pub size: u32,
    /// The stride of an array.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stride: Option<u32>,
    /// The type as numbers, except of a struct.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shape: Option<Shape>,
    /// Members of a struct, or of each element of an array of structs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub members: Vec<Member>,
}

/// A type of numbers, so that no reader has to parse the type's name.
#[derive(Debug, Clone, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Shape {
    /// `f32`, `i32`, `u32`, `f16`, or another scalar type of WGSL. `None` for an array whose
    /// elements are structs or arrays.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scalar: Option<String>,
    /// Components of a vector, or of each column of a matrix. A scalar has none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rows: Option<u32>,
    /// Columns of a matrix.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub columns: Option<u32>,
    /// Bytes from one column of a matrix to the next.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub matrix_stride: Option<u32>,
    /// Elements of an array, of which the other fields describe one; 0 if the buffer decides it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub count: Option<u32>,
}

/// What a layout of WebGPU or Vulkan has to know of a texture.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct TextureShape {
    /// `1d`, `2d`, `2d_array`, `3d`, `cube` or `cube_array`.
    pub dimension: String,
    /// Whether a texel has several samples.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub multisampled: bool,
    /// What is sampled. `None` for a storage texture.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sample_type: Option<SampleType>,
    /// The format of a storage texture, as in WGSL.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub format: Option<String>,
    /// How a storage texture is used.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub access: Option<Access>,
}

/// What the texels of a sampled texture are, in the words of WebGPU.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SampleType {
    /// Floating-point numbers that a sampler may filter.
    Float,
    /// Floating-point numbers that no sampler reads, so that formats without filtering are bound too.
    UnfilterableFloat,
    /// Depths.
    Depth,
    /// Signed integers.
    Sint,
    /// Unsigned integers.
    Uint,
}

/// How a shader uses a storage texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Access {
    /// Only read.
    Read,
    /// Only written.
    Write,
    /// Both.
    ReadWrite,
}

/// A group and a binding.
pub type Place = [u32; 2];

/// A texture and the sampler it is sampled with.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Pair {
    /// Where the texture is bound.
    pub texture: Place,
    /// Where the sampler is bound.
    pub sampler: Place,
}

/// A constant that is chosen when the pipeline is made: [`Native::choices`] says how.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Override {
    /// As the author calls it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// The number that the author gave it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub id: Option<u16>,
    /// Type in WGSL.
    #[serde(rename = "type")]
    pub ty: String,
    /// As a WGSL literal, where it is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub default: Option<String>,
}

/// How one target names and numbers things.
#[derive(Debug, Clone, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Native {
    /// Name of the entry point in the output.
    pub entry_name: String,
    /// Where each binding of the reflection ended up.
    pub slots: Vec<BindingSlot>,
    /// Combined samplers, in targets that do not have separate textures and samplers.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub combined: Vec<Combined>,
    /// How this target takes the values of overrides. An override that is not listed has its
    /// default.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub choices: Vec<OverrideChoice>,
    /// Semantics of a vertex stage's inputs, in targets that match attributes by them (HLSL).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub semantics: Vec<Semantic>,
    /// Where samplers are, in targets that take them from an array of all samplers (HLSL). Such
    /// samplers have no slot of their own.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sampler_heaps: Vec<SamplerHeap>,
    /// The argument with the lengths of buffers, where the entry point has one (MSL).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub buffer_sizes: Option<BufferSizes>,
    /// The name of a uniform of type `uint` that must be set to the first instance of a draw. It is
    /// there if the shader uses the instance index and the target's own index does not include the
    /// first instance (GLSL).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first_instance: Option<String>,
    /// The clip space of a vertex stage's positions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clip: Option<ClipSpace>,
    /// The program that optimised the output, with its version, if one did (SPIR-V).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub optimiser: Option<String>,
}

/// The clip space in which an output expects the author's positions, and what the host has to do
/// for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct ClipSpace {
    /// Where the author's y axis points in the picture.
    pub y: YAxis,
    /// Depth of the near plane, in the author's normalised coordinates.
    pub near: i8,
    /// Depth of the far plane, in the author's normalised coordinates.
    pub far: i8,
    /// Whether the output converts positions before the API sees them.
    pub is_converted: bool,
    /// The height that the host has to give its viewport.
    pub viewport: Viewport,
    /// Which row of a texture or framebuffer comes first in memory.
    pub rows: RowOrder,
    /// How a triangle winds for the API if it winds counter-clockwise in the picture.
    pub front_face: FrontFace,
}

/// Direction of an axis in the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum YAxis {
    /// Upwards.
    Up,
    /// Downwards.
    Down,
}

/// Sign of a viewport's height.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Viewport {
    /// A positive height, as usual.
    Positive,
    /// A negative height: the viewport starts at the bottom, so the picture is flipped.
    Negative,
}

/// Order of rows in memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", rename = "Rows")]
pub enum RowOrder {
    /// The top row.
    TopFirst,
    /// The bottom row.
    BottomFirst,
}

/// The winding that the API sees for a triangle that is counter-clockwise in the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FrontFace {
    /// Counter-clockwise.
    Same,
    /// Clockwise.
    Reversed,
}

/// How a target takes the value of an override.
///
/// - WGSL: as the pipeline constant of its `@id`; or `symbol`, where it was given another name; or
///   else its name.
/// - SPIR-V: as the specialisation constant `id`.
/// - MSL: as the function constant `id`.
/// - Others: as the macro `symbol`, defined before the text (in GLSL after `#version`).
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename = "Choice")]
pub struct OverrideChoice {
    /// As in the reflection.
    pub name: String,
    /// Number of the specialisation or function constant.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub id: Option<u32>,
    /// Name of the macro that chooses the value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub symbol: Option<String>,
}

/// The place of one binding in a target.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename = "Slot")]
pub struct BindingSlot {
    /// Group in WGSL, descriptor set in Vulkan.
    pub group: u32,
    /// Number within the group.
    pub binding: u32,
    /// Register space or descriptor set, where the target has them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub space: Option<u32>,
    /// Register, binding, table index or texture unit; `None` where only names exist, and for
    /// immediates in targets that have them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub index: Option<u32>,
    /// The class of the register, where the target has classes: `b`, `t`, `u` (HLSL).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub register: Option<String>,
    /// The identifier in the output, where the API looks it up by name.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
}

/// The semantic of a vertex attribute: `LOC` and 3 for `LOC3`.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Semantic {
    /// As in the reflection.
    pub location: u32,
    /// Name of the semantic, such as `LOC`.
    pub name: String,
    /// Its number.
    pub index: u32,
}

/// An array of samplers that the host binds once. A shader finds each of its samplers there by an
/// index that the host wrote into a buffer.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct SamplerHeap {
    /// The identifier in the output.
    pub name: String,
    /// Sampler register of its first element.
    pub register: u32,
    /// Space of the heap's registers.
    pub space: u32,
    /// Elements that the output declares.
    pub size: u32,
    /// Whether these are comparison samplers.
    pub comparison: bool,
    /// The samplers of the reflection that are found in it.
    pub samplers: Vec<HeapSampler>,
}

/// A sampler in a heap. Its index in the heap is in element `element` of a structured buffer of
/// 32-bit numbers.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct HeapSampler {
    /// Group of the sampler in WGSL.
    pub group: u32,
    /// Binding of the sampler in WGSL.
    pub binding: u32,
    /// Shader resource register (`t`) of the buffer of indices.
    pub buffer_register: u32,
    /// Register space of that buffer.
    pub buffer_space: u32,
    /// The element of the buffer that holds the index.
    pub element: u32,
}

/// An argument with the sizes of buffers whose last member is a runtime-sized array.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct BufferSizes {
    /// Its place in the table of buffers.
    pub index: u32,
    /// Group and binding of each buffer, in the order of their sizes. A size is a 32-bit number of
    /// bytes.
    pub buffers: Vec<Place>,
}

/// A texture and its sampler as one object.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Combined {
    /// Where the texture is bound.
    pub texture: Place,
    /// `None` for a texture that is only loaded from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sampler: Option<Place>,
    /// Name of the one object that the target has for both.
    pub name: String,
}
