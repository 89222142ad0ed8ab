//! Translates modules between shading languages, as text that people read.
//!
//! A *reader* makes a [`tree`] of a text, [`types`] finds the type of each expression, and a
//! *printer* writes the tree in another language. Comments, blank lines and the author's line breaks
//! stay, and so do conditions: `@if` becomes `#if`. There is one reader, of WESL; GLSL is first
//! translated to WGSL. The printer writes GLSL, HLSL and MSL, which differ in words more than in form.
//!
//! What has no form in the other language that means the same is a diagnostic with its place, and
//! then nothing is written. See `print` for what is guarded: WGSL says what happens at a division by
//! zero, a shift by 40 or the conversion of a large float, and GLSL does not.

pub mod condition;
pub mod print;
pub mod tree;
pub mod types;
pub mod wesl;

use lamplight_diagnostic::Diagnostics;
use lamplight_diagnostic::source::SourceId;

use print::{MadeFile, Style};

/// A module as text.
#[derive(Debug, Clone)]
pub struct SourceModule<'a> {
    /// The path of the module: `brdf`, `fresnel`.
    pub path: Vec<String>,
    pub source: SourceId,
    pub text: &'a str,
}

/// Translates modules of WESL that belong together to the language of a style.
///
/// `enums` names all axes that have named values. Either side of a comparison may be the axis then;
/// a comparison of two other names is refused. If it is empty, the axis must be on the left.
pub fn translate_wesl(
    sources: &[SourceModule<'_>],
    enums: &[String],
    style: &Style<'_>,
) -> Result<Vec<MadeFile>, Diagnostics> {
    let mut modules = Vec::new();
    let mut errors = Vec::new();
    for SourceModule { path, source, text } in sources {
        match wesl::read_module(path, *source, text, enums) {
            Ok(module) => modules.push(module),
            Err(found) => errors.extend(found),
        }
    }
    if !errors.is_empty() {
        return Err(errors);
    }
    let globals = types::check_modules(&mut modules)?;
    print::print_modules(&modules, &globals, style)
}
