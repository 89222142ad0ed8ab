//! `lamplight translate FILE --to wgsl|glsl|hlsl|msl`: a shader in another language, to read and to
//! keep.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use lamplight_translate::print::{Dialect, Style};
use lamplight_translate::{SourceModule, translate_wesl};

use super::compile::parse_convention;
use super::failure::{DiagnosticForm, Failure, print_warnings};
use super::input::InputArguments;
use super::terminal::write_data;
use crate::bundle::{Language, SourceClip};
use crate::compose::Composed;
use crate::diagnostic::{Diagnostics, codes};
use crate::generate::add_numbers;
use crate::glsl::wgsl::{Clip, Options, Written};
use crate::source::{SourceId, SourceSet};
use crate::validate::{glsl_as_wgsl, on_large_stack, positions_of, translate_glsl};

/// Print a shader in another language, as readable source: its names and comments are kept. GLSL is
/// translated to WGSL, and both to GLSL for Vulkan, HLSL and MSL, of which the last two are given
/// functions alone.
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
    /// Version 4.50, for Vulkan.
    Glsl,
    /// Functions for Direct3D, Unity and Unreal Engine.
    Hlsl,
    /// Functions for Metal.
    Msl,
}

pub fn run_translate(arguments: Arguments, form: DiagnosticForm) -> Result<(), Failure> {
    let Arguments { file, to, source_clip, input } = arguments;
    let mut ready = input.compose(&file, SourceSet::default(), form)?;
    add_numbers(&mut ready.composed, &ready.context.numbers);
    let clip = positions_of(&ready.composed, source_clip);
    let name = file.file_stem().map_or("shader".into(), |stem| stem.to_string_lossy());
    let name = name.split('.').next().unwrap_or_default();
    let translated = match to {
        TargetLanguage::Wgsl => {
            return match as_wgsl(&ready.composed, clip)? {
                Ok(text) => Ok(write_data(text.as_bytes())?),
                Err(problems) => Err(Failure::Input(ready.sources, problems)),
            };
        }
        TargetLanguage::Glsl => printed(&ready.composed, clip, Dialect::Glsl, name),
        TargetLanguage::Hlsl => printed(&ready.composed, clip, Dialect::Hlsl, name),
        TargetLanguage::Msl => printed(&ready.composed, clip, Dialect::Msl, name),
    };
    match translated {
        Ok((texts, warnings)) => {
            print_warnings(&ready.sources, &warnings, form);
            match texts.as_slice() {
                [text] => Ok(write_data(text.as_bytes())?),
                _ => Err(Failure::usage(
                    "the file has several stages, and GLSL has a file for each: translate files \
                     with one entry point",
                )),
            }
        }
        Err(problems) => Err(Failure::Input(ready.sources, problems)),
    }
}

/// A shader in GLSL as WGSL.
fn as_wgsl(composed: &Composed, clip: Clip) -> Result<Result<String, Diagnostics>, Failure> {
    let (Language::Glsl, Some(stage)) = (composed.language, composed.stage) else {
        return Err(Failure::usage(
            "only GLSL is translated to WGSL; `lamplight compose` prints WESL as WGSL",
        ));
    };
    match translate_glsl(composed, stage, Options { clip, keeps_rule: false }) {
        Ok(written) => {
            check_written(&written.text)?;
            Ok(Ok(with_notes(&written)))
        }
        Err(problems) => Ok(Err(problems)),
    }
}

/// Stands for the composed text, which is no source of the author's.
const COMPOSED: SourceId = SourceId(u32::MAX);

/// The texts of a composed shader in a language like C, and what has no word there.
fn printed(
    composed: &Composed,
    clip: Clip,
    dialect: Dialect,
    name: &str,
) -> Result<(Vec<String>, Diagnostics), Diagnostics> {
    let (translated, warnings);
    let wgsl = match composed.language {
        Language::Glsl => {
            let mut found = glsl_as_wgsl(composed, clip)?;
            warnings = std::mem::take(&mut found.warnings);
            translated = found;
            &translated
        }
        Language::Wesl => {
            warnings = Vec::new();
            composed
        }
    };
    let style = Style { dialect, command: None, guard: "", sampling: None, prefix: None };
    let module = SourceModule { path: vec![name.to_owned()], source: COMPOSED, text: &wgsl.text };
    match on_large_stack(|| translate_wesl(&[module], &[], &style)) {
        Ok(files) => Ok((files.into_iter().map(|file| file.text).collect(), warnings)),
        Err(mut problems) => {
            problems.iter_mut().for_each(|problem| wgsl.map.move_labels(problem));
            Err(problems)
        }
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
