//! GLSL 3.30 core, for OpenGL 3.3.
//!
//! The language has no explicit bindings: look up the names of the reflection with
//! `glGetUniformBlockIndex` and `glGetUniformLocation`. Coordinates: see [`crate`].

use naga::valid::Capabilities;
use naga::back::glsl::Version;

use crate::glsl;
use crate::slots::Numbering;
use crate::{EmitSource, Emitted, Overrides, TargetEntry, ValidatorRules, clip};
use lamplight_bundle::Target;

const VERSION: Version = Version::Desktop(330);

/// The target, for the table of all.
pub const TARGET: TargetEntry = TargetEntry {
    target: Target::GLSL330,
    extension: "glsl330.glsl",
    binary: false,
    about: "GLSL 3.30 core, for OpenGL 3.3",
    glsl: Some(VERSION),
    capabilities: Capabilities::CLIP_DISTANCES.union(Capabilities::DUAL_SOURCE_BLENDING)
        .union(Capabilities::PRIMITIVE_INDEX),
    header: glsl::HEADER,
    overrides: Overrides::Macros,
    immediates: false,
    validation: ValidatorRules { validator: "glslang", rules: &["own"] },
    clip: &clip::OPENGL,
    write,
};

fn write(source: &EmitSource<'_>) -> Result<Emitted, String> {
    glsl::write_glsl(source, VERSION, Numbering::Named)
}
