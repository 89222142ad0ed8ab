//! `lamplight translate FILE --to wgsl`: a shader in another language, to read and to keep.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::failure::{DiagnosticForm, Failure};
use super::input::InputArguments;
use super::terminal::write_data;
use crate::bundle::{Language, Stage};
use crate::compose::Composed;
use crate::diagnostic::{Diagnostics, Label, codes};
use crate::glsl::tree::Stage as GlslStage;
use crate::glsl::wgsl::{Clip, Fact, Facts, Options, Written};
use crate::source::{SourceId, SourceSet};

/// Print a GLSL shader as readable WGSL: its names and comments are kept.
#[derive(Args)]
pub struct Arguments {
    /// Path to the shader; `-` is standard input.
    file: PathBuf,
    /// The language to translate to.
    #[arg(long, value_enum)]
    to: TargetLanguage,
    /// The clip space of the shader's `gl_Position`, which is converted to WebGPU's.
    #[arg(long, value_enum, default_value_t)]
    source_clip: SourceClip,
    #[command(flatten)]
    input: InputArguments,
}

#[derive(Clone, Copy, ValueEnum)]
enum TargetLanguage {
    /// For WebGPU.
    Wgsl,
}

#[derive(Clone, Copy, Default, ValueEnum)]
enum SourceClip {
    /// Vulkan's for shaders that use features of Vulkan, else OpenGL's.
    #[default]
    Auto,
    /// Depths from -1 to 1.
    Opengl,
    /// The second coordinate points down.
    Vulkan,
    /// As WebGPU has it: nothing is converted.
    Webgpu,
}

pub fn run_translate(arguments: Arguments, form: DiagnosticForm) -> Result<(), Failure> {
    let TargetLanguage::Wgsl = arguments.to;
    let ready = arguments.input.compose(&arguments.file, SourceSet::default(), form)?;
    let (Language::Glsl, Some(stage)) = (ready.composed.language, ready.composed.stage) else {
        return Err(Failure::usage("only GLSL is translated to WGSL"));
    };
    let clip = match arguments.source_clip {
        SourceClip::Auto => Clip::Source,
        SourceClip::Opengl => Clip::OpenGl,
        SourceClip::Vulkan => Clip::Vulkan,
        SourceClip::Webgpu => Clip::Kept,
    };
    let stage = match stage {
        Stage::Vertex => GlslStage::Vertex,
        Stage::Fragment => GlslStage::Fragment,
        Stage::Compute => GlslStage::Compute,
    };
    let text = &ready.composed.text;
    let translated = crate::glsl::translate(text, stage, COMPOSED, Options { clip });
    match translated {
        Ok(written) => {
            check_written(&written.text)?;
            Ok(write_data(with_notes(&written).as_bytes())?)
        }
        Err(problems) => {
            let problems = in_authors_text(problems, &ready.composed.map);
            Err(Failure::Input(ready.sources, problems))
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

/// Stands for the composed text, which is no source of the author's.
const COMPOSED: SourceId = SourceId(u32::MAX);

/// Places in the composed text as places in the author's.
fn in_authors_text(mut problems: Diagnostics, map: &crate::compose::SourceMap) -> Diagnostics {
    for problem in &mut problems {
        let labels = std::mem::take(&mut problem.labels);
        let moved = labels.into_iter().filter_map(|label| {
            let span = map.lookup(label.span.range())?;
            Some(Label { span, message: label.message })
        });
        problem.labels = moved.collect();
    }
    problems
}

/// The text, with a comment for each thing that WGSL has no word for.
fn with_notes(written: &Written) -> String {
    let mut text = written.text.clone();
    let notes: Vec<String> = notes_of(&written.facts);
    if !notes.is_empty() {
        text.push_str("\n// What WGSL has no word for:\n");
    }
    for note in notes {
        let _ = writeln!(text, "// - {note}");
    }
    text
}

fn notes_of(facts: &Facts) -> Vec<String> {
    let note = |fact: &Fact| match fact {
        Fact::Dropped(name) => format!("`{name}` is computed, and has no effect"),
        Fact::Initial(name, numbers) => {
            let list: Vec<String> = numbers.iter().map(f64::to_string).collect();
            format!("the host sets the uniform `{name}`, which begins with {}", list.join(", "))
        }
        Fact::PushConstant(name) => format!("`{name}` was a push constant"),
        Fact::Attachment(name, index) => {
            format!("`{name}` was the input attachment {index}: the host binds it as a texture")
        }
        Fact::DepthMode(mode) => format!("`gl_FragDepth` was declared as `{mode}`"),
        Fact::Location(name, location) => {
            format!("`{name}` had no location, and has {location} here")
        }
        Fact::Binding(name, wanted, found) => {
            format!("`{name}` had the binding {wanted}, and has {found} here")
        }
    };
    facts.list.iter().map(note).collect()
}
