//! GLSL 4.50 core, for OpenGL 4.5.
//!
//! Uniform blocks, storage blocks and texture units have `layout(binding = 16 * group + binding)`,
//! the same in every stage and permutation, since GL shares its units between stages.
//! Coordinates: see [`crate`].

use naga::valid::Capabilities;
use naga::back::glsl::Version;

use crate::glsl;
use crate::slots::Numbering;
use crate::{EmitSource, Emitted, Overrides, TargetEntry, ValidatorRules, clip};
use lamplight_bundle::Target;

const VERSION: Version = Version::Desktop(450);

/// The target, for the table of all.
pub const TARGET: TargetEntry = TargetEntry {
    target: Target::GLSL450,
    extension: "glsl450.glsl",
    binary: false,
    about: "GLSL 4.50 core, for OpenGL 4.5",
    glsl: Some(VERSION),
    capabilities: Capabilities::FLOAT64
        .union(Capabilities::CLIP_DISTANCES)
        .union(Capabilities::DUAL_SOURCE_BLENDING)
        .union(Capabilities::PRIMITIVE_INDEX)
        .union(Capabilities::STORAGE_TEXTURE_16BIT_NORM_FORMATS),
    header: glsl::HEADER,
    overrides: Overrides::Macros,
    immediates: false,
    validation: ValidatorRules { validator: "glslang", rules: &["own", "vulkan"] },
    clip: &clip::OPENGL,
    write,
};

fn write(source: &EmitSource<'_>) -> Result<Emitted, String> {
    glsl::write_glsl(source, VERSION, Numbering::Explicit)
}
