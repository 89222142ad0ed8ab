//! What is chosen for an output besides its target: the clip space, the checks of indices, and the
//! form of SPIR-V.

/// A choice that an author makes by name, in a manifest or on the command line.
pub trait Convention: Copy + PartialEq + 'static {
    /// All choices by their names. The first is the default.
    const ALL: &'static [(&'static str, Self)];

    /// The one of that name.
    fn find(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|(known, _)| *known == name).map(|(_, choice)| *choice)
    }

    /// Its name.
    fn name(self) -> &'static str {
        Self::ALL.iter().find(|(_, choice)| *choice == self).map_or("", |(name, _)| name)
    }

    /// All names.
    fn names() -> impl Iterator<Item = &'static str> {
        Self::ALL.iter().map(|(name, _)| *name)
    }
}

/// Clip space as an author may ask for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub enum ClipConvention {
    /// WebGPU's, in every target. Where an API has another one, the output converts positions.
    #[default]
    Wgpu,
    /// The API's own. Outputs do not convert the author's positions.
    Native,
}

impl Convention for ClipConvention {
    const ALL: &'static [(&'static str, Self)] = &[("wgpu", Self::Wgpu), ("native", Self::Native)];
}

/// What an output does about indices beyond the end of an array, coordinates of `textureLoad` that
/// are outside the texture, and loops that do not end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub enum BoundsChecks {
    /// Nothing beyond what the author wrote.
    #[default]
    Unchecked,
    /// Indices and coordinates are clamped to the last element, as far as naga's writer of the
    /// target has such checks. In SPIR-V, MSL and HLSL, loops that are not proved to end by
    /// themselves end after 2^64 iterations.
    Restrict,
}

impl Convention for BoundsChecks {
    const ALL: &'static [(&'static str, Self)] =
        &[("unchecked", Self::Unchecked), ("restrict", Self::Restrict)];
}

/// The clip space that the positions of a vertex shader in GLSL are in. Outputs have positions of
/// [`ClipConvention::Wgpu`], so those of another clip space are converted. WGSL has one clip space.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub enum SourceClip {
    /// OpenGL's for a shader of a version below 4.50 without anything that only GLSL for Vulkan has,
    /// else WebGPU's.
    #[default]
    Auto,
    /// Depths go from -1 to 1.
    OpenGl,
    /// The y axis points down.
    Vulkan,
    /// Positions are taken as they are written.
    WebGpu,
}

impl Convention for SourceClip {
    const ALL: &'static [(&'static str, Self)] = &[
        ("auto", Self::Auto),
        ("opengl", Self::OpenGl),
        ("vulkan", Self::Vulkan),
        ("webgpu", Self::WebGpu),
    ];
}

/// What is kept of an output in SPIR-V. Each form computes the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub enum SpirvForm {
    /// With the author's names, for debuggers.
    #[default]
    Names,
    /// Without names and other instructions for debuggers.
    Stripped,
    /// Stripped, and optimised by `spirv-opt`.
    Optimised,
}

impl Convention for SpirvForm {
    const ALL: &'static [(&'static str, Self)] =
        &[("names", Self::Names), ("stripped", Self::Stripped), ("optimised", Self::Optimised)];
}

/// What is chosen for an output besides its target.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub struct Conventions {
    /// The clip space of vertex stages.
    pub clip: ClipConvention,
    /// The clip space of vertex shaders in GLSL. It means nothing where outputs have the API's own.
    pub source_clip: SourceClip,
    /// Checks of indices and loops.
    pub bounds: BoundsChecks,
    /// The form of SPIR-V. It means nothing for other targets.
    pub spirv: SpirvForm,
}

/// Requested conventions, such as those of the command line. They override those of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub struct RequestedConventions {
    /// The clip space of vertex stages.
    pub clip: Option<ClipConvention>,
    /// The clip space of vertex shaders in GLSL.
    pub source_clip: Option<SourceClip>,
    /// Checks of indices and loops.
    pub bounds: Option<BoundsChecks>,
    /// The form of SPIR-V.
    pub spirv: Option<SpirvForm>,
}

impl RequestedConventions {
    /// The requested convention; where there is none, the program's own.
    pub fn or(self, own: Conventions) -> Conventions {
        Conventions {
            clip: self.clip.unwrap_or(own.clip),
            source_clip: self.source_clip.unwrap_or(own.source_clip),
            bounds: self.bounds.unwrap_or(own.bounds),
            spirv: self.spirv.unwrap_or(own.spirv),
        }
    }
}
