//! `lamplight translate FILE --to wgsl`: a shader in another language, to read and to keep.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::compile::parse_convention;
use super::failure::{DiagnosticForm, Failure};
use super::input::InputArguments;
use super::terminal::write_data;
use crate::bundle::{Language, SourceClip};
use crate::compose::Composed;
use crate::diagnostic::codes;
use crate::generate::add_numbers;
use crate::glsl::wgsl::Written;
use crate::source::SourceSet;
use crate::validate::{positions_of, translate_glsl};

/// Print a GLSL shader as readable WGSL: its names and comments are kept.
#[derive(Args)]
pub struct Arguments {
    /// Path to the shader; `-` is standard input.
    file: PathBuf,
    /// The language to translate to.
    #[arg(long, value_enum)]
    to: TargetLanguage,
    /// The clip space of the shader's `gl_Position`, which is converted to WebGPU's: `opengl`,
    /// `vulkan`, `webgpu`, or `auto`, which is `opengl` for versions below 4.50 without features of
    /// Vulkan, else `webgpu`.
    #[arg(long, value_name = "SPACE", default_value = "auto")]
    #[arg(value_parser = parse_convention::<SourceClip>)]
    source_clip: SourceClip,
    #[command(flatten)]
    input: InputArguments,
}

#[derive(Clone, Copy, ValueEnum)]
enum TargetLanguage {
    /// For WebGPU.
    Wgsl,
}

pub fn run_translate(arguments: Arguments, form: DiagnosticForm) -> Result<(), Failure> {
    let TargetLanguage::Wgsl = arguments.to;
    let mut ready = arguments.input.compose(&arguments.file, SourceSet::default(), form)?;
    add_numbers(&mut ready.composed, &ready.context.numbers);
    let (Language::Glsl, Some(stage)) = (ready.composed.language, ready.composed.stage) else {
        return Err(Failure::usage("only GLSL is translated to WGSL"));
    };
    let clip = positions_of(&ready.composed, arguments.source_clip);
    let translated = translate_glsl(&ready.composed, stage, clip);
    match translated {
        Ok(written) => {
            check_written(&written.text)?;
            Ok(write_data(with_notes(&written).as_bytes())?)
        }
        Err(problems) => Err(Failure::Input(ready.sources, problems)),
    }
}

/// What is written is valid, or the translator is wrong. Features that only some targets have, such
/// as clip distances, are WGSL.
fn check_written(text: &str) -> Result<(), Failure> {
    let composed = Composed::of_text(Language::Wesl, None, text.to_owned());
    let Err(problems) = crate::validate::validate(&composed) else { return Ok(()) };
    match problems.first() {
        Some(problem) if problem.code == codes::NOT_PORTABLE => Ok(()),
        Some(problem) if problem.code == codes::LIMIT_EXCEEDED => {
            Err(Failure::input(format!("the shader has {}", problem.message)))
        }
        first => {
            let message = first.map_or("", |problem| problem.message.as_str());
            Err(Failure::input(format!(
                "internal error: the WGSL that the translator wrote is not valid ({message}); \
                 please report it with the shader"
            )))
        }
    }
}

/// The text, with a comment for each thing that WGSL has no word for.
fn with_notes(written: &Written) -> String {
    let mut text = written.text.clone();
    if !written.facts.list.is_empty() {
        text.push_str("\n// What WGSL has no word for:\n");
    }
    for (fact, _) in &written.facts.list {
        let _ = writeln!(text, "// - {fact}");
    }
    text
}
