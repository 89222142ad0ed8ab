//! GLSL ES 3.00, for OpenGL ES 3.0 and WebGL 2.
//!
//! The language has no explicit bindings: look up the names of the reflection with
//! `glGetUniformBlockIndex` and `glGetUniformLocation`. Coordinates: see [`crate`].

use naga::valid::Capabilities;
use naga::back::glsl::Version;
use naga::{Handle, ImageDimension, Type, TypeInner};

use crate::glsl;
use crate::slots::Numbering;
use crate::{EmitSource, Emitted, Overrides, TargetEntry, ValidatorRules, clip};
use lamplight_bundle::Target;

const VERSION: Version = Version::new_gles(300);

/// The target, for the table of all.
pub const TARGET: TargetEntry = TargetEntry {
    target: Target::ESSL300,
    extension: "essl300.glsl",
    binary: false,
    about: "GLSL ES 3.00, for OpenGL ES 3.0 and WebGL 2",
    glsl: Some(VERSION),
    capabilities: Capabilities::empty(),
    header: glsl::HEADER,
    overrides: Overrides::Macros,
    immediates: false,
    validation: ValidatorRules { validator: "glslang", rules: &["own", "310 es"] },
    clip: &clip::OPENGL,
    write,
};

fn write(source: &EmitSource<'_>) -> Result<Emitted, String> {
    // naga would write `sampler1D` here, which no driver of this version knows.
    let is_line = |ty: Handle<Type>| {
        matches!(source.module.types[ty].inner, TypeInner::Image { dim: ImageDimension::D1, arrayed: _, class: _ })
    };
    if source.module.global_variables.iter().any(|(_, variable)| is_line(variable.ty)) {
        return Err("the language has no textures of one dimension".to_owned());
    }
    glsl::write_glsl(source, VERSION, Numbering::Named)
}
