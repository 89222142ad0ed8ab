//! GLSL 3.30 core, for OpenGL 3.3.
//!
//! The language has no explicit bindings: look up the names of the reflection with
//! `glGetUniformBlockIndex` and `glGetUniformLocation`. Coordinates: see [`crate::emit`].

use naga::back::glsl::Version;

use crate::bundle::Target;
use crate::emit::glsl;
use crate::emit::slots::Numbering;
use crate::emit::{EmitSource, Emitted, JudgeRules, Overrides, TargetEntry, clip};

const VERSION: Version = Version::Desktop(330);

/// The target, for the table of all.
pub const TARGET: TargetEntry = TargetEntry {
    target: Target::GLSL330,
    extension: "glsl330.glsl",
    binary: false,
    about: "GLSL 3.30 core, for OpenGL 3.3",
    glsl: Some(VERSION),
    header: glsl::HEADER,
    overrides: Overrides::Macros,
    judged: JudgeRules { judge: "glslang", rules: &["own"] },
    clip: &clip::OPENGL,
    write,
};

fn write(source: &EmitSource<'_>) -> Result<Emitted, String> {
    glsl::write_glsl(source, VERSION, Numbering::Named)
}
