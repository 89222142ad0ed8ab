//! GLSL: read, checked, and translated to readable WGSL.
//!
//! `text -> tokens -> declarations -> typed tree -> WGSL + source map + side table`
//!
//! The text must be preprocessed: `#version` and `#extension` are read, every other directive is
//! passed over. [`parse`] goes on after an error; [`check`] reports in the words of GLSL.

pub mod ast;
pub mod builtin;
pub mod check;
mod dialect;
pub mod lexer;
pub mod parse;
mod program;
pub mod tree;
pub mod types;
pub mod wgsl;

pub use dialect::is_for_vulkan;
pub use program::{is_numbered, number_program};

use lamplight_diagnostic::Diagnostics;
use lamplight_diagnostic::source::SourceId;

/// Translates a preprocessed text to WGSL. The spans of diagnostics are in `source`.
///
/// # Errors
/// Mistakes of the text, and what has no counterpart in WGSL.
pub fn translate(
    text: &str,
    stage: tree::Stage,
    source: SourceId,
    options: wgsl::Options,
) -> Result<wgsl::Written, Diagnostics> {
    let parsed = parse::parse(text);
    let shader = check::check(text, &parsed, stage, source)?;
    let comments = &parsed.lexed.comments;
    wgsl::write(&shader, text, comments, source, options)
}
