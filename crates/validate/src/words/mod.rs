//! Explains naga's errors in the terms of people who write shaders: a sentence for each kind of
//! mistake, with the author's names and types.
//!
//! Every enum of naga is matched without a wildcard. So a version of naga with a new kind of error
//! does not compile until the kind has a sentence here.

mod entry;
mod expression;
mod function;
mod global;
mod stages;
mod types;

use naga::common::wgsl::TypeContext;
use naga::valid::{Capabilities, ValidationError};
use naga::{Handle, Module, Type, TypeInner};

use super::advice::Wrong;
use lamplight_diagnostic::{Code, codes};

/// A sentence, with the code for kinds that have one of their own.
#[derive(Debug)]
pub struct Sentence {
    pub code: Option<&'static Code>,
    pub message: String,
    pub notes: Vec<String>,
    /// A second place, besides that of naga's error, with its label.
    pub beside: Option<(naga::Span, String)>,
    /// The statement that is wrong, where naga names only a value in it, which may be declared
    /// elsewhere.
    pub statement: Option<naga::Span>,
    /// The types that are wrong, from which the help is made.
    pub wrong: Option<Wrong>,
}

impl Sentence {
    fn plain(message: impl Into<String>) -> Self {
        Self {
            code: None,
            message: message.into(),
            notes: Vec::new(),
            beside: None,
            statement: None,
            wrong: None,
        }
    }

    fn coded(code: &'static Code, message: impl Into<String>) -> Self {
        Self { code: Some(code), ..Self::plain(message) }
    }

    fn about(mut self, wrong: Wrong) -> Self {
        self.wrong = Some(wrong);
        self
    }

    fn note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }
}

/// The message for an error of naga's validator.
pub fn validation_words(module: &Module, error: &ValidationError) -> Sentence {
    match error {
        ValidationError::InvalidHandle(_) | ValidationError::Corrupted => Sentence::plain(
            "internal error in naga: its parser made a module that its validator refuses; please report it",
        ),
        ValidationError::Layouter(_) => {
            Sentence::plain("a type has no layout in memory: its size is not known, or too large")
        }
        ValidationError::Type { name, source, .. } => types::type_of(module, name, source),
        ValidationError::ConstExpression { source, .. } => types::constant_words(module, source),
        ValidationError::ArraySizeError { .. } => {
            Sentence::plain("the size of an array must be above 0")
        }
        ValidationError::Constant { name, source, .. } => {
            Sentence::plain(types::of_constant(name, source))
        }
        ValidationError::Override { name, source, .. } => types::of_override(module, name, source),
        ValidationError::GlobalVariable { name, source, .. } => {
            global::variable_words(module, name, source)
        }
        ValidationError::Function { handle, name, source } => {
            let sentence = function::function_words(module, &module.functions[*handle], source);
            sentence.note(format!("in function `{name}`"))
        }
        ValidationError::EntryPoint { stage, name, source } => {
            let point = module.entry_points.iter().find(|point| point.name == *name);
            let sentence = entry::entry_words(module, point, source);
            sentence.note(format!("in entry point `{name}` ({})", stage_name(*stage)))
        }
    }
}

/// A type as WGSL spells it.
fn type_text(module: &Module, handle: Handle<Type>) -> String {
    let mut text = String::new();
    match module.to_ctx().write_type(handle, &mut text) {
        Ok(()) if !text.is_empty() => format!("`{text}`"),
        _ => "a type without a name".to_owned(),
    }
}

/// A type as WGSL spells it, without backticks.
fn bare_type(module: &Module, inner: &TypeInner) -> String {
    inner_type_text(module, inner).replace('`', "")
}

fn inner_type_text(module: &Module, inner: &TypeInner) -> String {
    let mut text = String::new();
    match module.to_ctx().write_type_inner(inner, &mut text) {
        Ok(()) if !text.is_empty() => format!("`{text}`"),
        _ => "a type without a name".to_owned(),
    }
}

/// How the messages begin about what only some targets have.
pub const NOT_EVERY: &str = "not every target has";

/// The message for something that needs capabilities which not every target has.
fn lacking_words(capabilities: Capabilities) -> Sentence {
    let names: Vec<String> =
        capabilities.iter_names().map(|(name, _)| name.to_lowercase().replace('_', " ")).collect();
    Sentence::coded(
        codes::NOT_PORTABLE,
        format!("{NOT_EVERY} what this needs: {}", names.join(", ")),
    )
}

fn stage_name(stage: naga::ShaderStage) -> &'static str {
    match stage {
        naga::ShaderStage::Vertex => "vertex",
        naga::ShaderStage::Fragment => "fragment",
        naga::ShaderStage::Compute => "compute",
        naga::ShaderStage::Task
        | naga::ShaderStage::Mesh
        | naga::ShaderStage::RayGeneration
        | naga::ShaderStage::Miss
        | naga::ShaderStage::AnyHit
        | naga::ShaderStage::ClosestHit => "a stage that no target has",
    }
}

/// The message for something that belongs to stages or devices which no target has.
fn foreign_words(what: &str) -> Sentence {
    Sentence::coded(codes::NOT_PORTABLE, format!("no target has {what}"))
}

/// A name from naga's enums, such as `SampleCount`, as words: `sample count`.
fn spaced_name(debug: &str) -> String {
    let mut text = String::with_capacity(debug.len() + 4);
    for (index, letter) in debug.chars().enumerate() {
        if letter.is_uppercase() && index > 0 && !text.ends_with(' ') {
            text.push(' ');
        }
        text.extend(letter.to_lowercase());
    }
    text
}
