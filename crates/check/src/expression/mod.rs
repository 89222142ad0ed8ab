//! Evaluates expressions over the library's functions on any executor.
//!
//! An expression is WGSL: `lighting::spot::cone_exponent(0.9, 0.8, 4.0)`. It becomes the body of a
//! function of a root module; naga finds its type. For GLSL the same expression is translated
//! token by token, and calls the GLSL modules.

mod complete;
mod rewrite;

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Mutex;

use naga::proc::TypeResolution;
use naga::{Expression, Handle, ScalarKind, Statement};

use super::library::{Library, lock_sources};
use lamplight_bundle::Language;
use lamplight_compose::Composed;
use lamplight_compose::project::LIBRARY;
use lamplight_diagnostic::source::{SourceId, SourceSet, Span};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_execute::Session;
use lamplight_execute::kernel::{self, Kernel, word_value};
use lamplight_validate::Validated;
use rewrite::Rewritten;

/// Name of the function around the expression.
const FUNCTION: &str = "lamplight_eval";

/// The components of a value as words: structs and arrays are flattened, matrices go column by
/// column.
#[derive(Debug, Clone, PartialEq)]
pub struct ExpressionValue {
    pub words: Vec<u32>,
    pub kinds: Vec<ScalarKind>,
}

impl fmt::Display for ExpressionValue {
    /// Separated by spaces; f32 as the shortest decimal that reads back the same.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let texts: Vec<String> = self
            .words
            .iter()
            .zip(&self.kinds)
            .map(|(word, kind)| component_text(*word, *kind))
            .collect();
        f.write_str(&texts.join(" "))
    }
}

fn component_text(word: u32, kind: ScalarKind) -> String {
    match kind {
        ScalarKind::Float => {
            let value = f32::from_bits(word);
            let plain = value == 0.0 || !value.is_finite() || (1e-5..1e9).contains(&value.abs());
            if plain { value.to_string() } else { format!("{value:e}") }
        }
        ScalarKind::Bool => (word != 0).to_string(),
        _ => word_value(word, kind).to_string(),
    }
}

/// The value of an expression. Errors point into it, as a source named `<expression>`.
pub fn evaluate_expression(
    library: &Library,
    sources: &Mutex<SourceSet>,
    text: &str,
    language: Language,
    session: &mut dyn Session,
) -> Result<ExpressionValue, Diagnostics> {
    CompiledExpression::new(library, sources, text, language)?.value(session)
}

/// An error that calls a user's package as expressions do, `package`, whatever its name among others is.
fn with_package(mut error: Diagnostic, library: &Library) -> Diagnostic {
    if library.name() == LIBRARY {
        return error;
    }
    let name = format!("`{}::", library.name());
    let labels = error.labels.iter_mut().map(|label| &mut label.message);
    for text in std::iter::once(&mut error.message).chain(labels).chain(&mut error.notes) {
        *text = text.replace(&name, "`package::");
    }
    error
}

/// An expression as a kernel, which any number of executors can run.
pub struct CompiledExpression {
    pub kernel: Kernel,
    /// Where the whole expression is.
    span: Span,
}

impl CompiledExpression {
    /// Reads an expression. Errors point into it, as a source named `<expression>`.
    pub fn new(
        library: &Library,
        sources: &Mutex<SourceSet>,
        text: &str,
        language: Language,
    ) -> Result<Self, Diagnostics> {
        let id = lock_sources(sources).add("<expression>", text);
        complete::check_complete(text, id).map_err(|error| vec![error])?;
        let module =
            expression_module(library, sources, text, language).map_err(|(errors, wrapper)| {
                errors
                    .into_iter()
                    .map(|error| relocate_labels(error, &lock_sources(sources), &wrapper, id))
                    .map(|error| with_package(error, library))
                    .collect::<Vec<_>>()
            })?;
        let span = Span::new(id, 0..text.len());
        let kernel = kernel::build_kernel(&module, FUNCTION, &BTreeMap::new())
            .map_err(|error| vec![placed(error, span)])?;
        Ok(Self { kernel, span })
    }

    /// Its value on an executor.
    pub fn value(&self, session: &mut dyn Session) -> Result<ExpressionValue, Diagnostics> {
        let words =
            session.run(&self.kernel, &[]).map_err(|error| vec![placed(error, self.span)])?;
        Ok(ExpressionValue { words, kinds: self.kernel.result_kinds() })
    }
}

/// An expression in WGSL as the text of a function without parameters, which returns its value.
pub struct ExpressionText {
    /// The text with everything that the expression needs.
    pub composed: Composed,
    /// Its module.
    pub validated: Validated,
    /// The name of the function.
    pub function: &'static str,
}

/// Composes an expression. Errors point into it, as a source named `<expression>`.
pub fn compose_expression(
    library: &Library,
    sources: &Mutex<SourceSet>,
    text: &str,
) -> Result<ExpressionText, Diagnostics> {
    let id = lock_sources(sources).add("<expression>", text);
    complete::check_complete(text, id).map_err(|error| vec![error])?;
    let wesl = rewrite::rewrite_wesl(text, library);
    let root = ("expression.wesl", wesl.text.as_str());
    let read = library.importing_text(sources, root, Language::Wesl, FUNCTION);
    let (mut composed, validated) = read.map_err(|errors| -> Diagnostics {
        let errors = errors.into_iter();
        errors.map(|error| relocate_labels(error, &lock_sources(sources), &wesl, id)).collect()
    })?;
    let span = Span::new(id, 0..text.len());
    let is_wrapper = |span: &Span| *lock_sources(sources).get(span.source).text == *wesl.text;
    composed.map.replace(&|found| if is_wrapper(&found) { span } else { found });
    Ok(ExpressionText { composed, validated, function: FUNCTION })
}

/// The error with the place of the whole expression, unless it has one.
fn placed(error: Diagnostic, whole: Span) -> Diagnostic {
    if error.labels.is_empty() { error.at(whole, "in this expression") } else { error }
}

type Failed = (Diagnostics, Rewritten);

fn expression_module(
    library: &Library,
    sources: &Mutex<SourceSet>,
    text: &str,
    language: Language,
) -> Result<naga::Module, Failed> {
    let wesl = rewrite::rewrite_wesl(text, library);
    let typed = library
        .importing(sources, ("expression.wesl", &wesl.text), Language::Wesl, FUNCTION)
        .and_then(|validated| with_result(validated).map_err(|error| vec![error]));
    let (module, ty) = match typed {
        Ok(typed) => typed,
        Err(errors) => return Err((errors, wesl)),
    };
    if language == Language::Wesl {
        return Ok(module);
    }
    let glsl = rewrite::rewrite_glsl(text, library, &module, ty);
    match library.importing(sources, ("expression.frag.glsl", &glsl.text), Language::Glsl, FUNCTION)
    {
        Ok(validated) => Ok(validated.module),
        Err(errors) => Err((errors, glsl)),
    }
}

/// Makes the function return the last value that it binds to a name. Returns the module and the
/// type of the value.
fn with_result(validated: Validated) -> Result<(naga::Module, Handle<naga::Type>), Diagnostic> {
    let Validated { mut module, info, .. } = validated;
    let nothing = || Diagnostic::error(codes::UNTESTABLE_FUNCTION, "the expression has no value");
    let handle = module
        .functions
        .iter()
        .find(|(_, function)| function.name.as_deref() == Some(FUNCTION))
        .map(|(handle, _)| handle);
    let handle = handle.ok_or_else(nothing)?;
    let value: Handle<Expression> = module.functions[handle]
        .named_expressions
        .iter()
        .last()
        .map(|(value, _)| *value)
        .ok_or_else(nothing)?;
    let ty = match &info[handle][value].ty {
        TypeResolution::Handle(ty) => *ty,
        TypeResolution::Value(inner) => module
            .types
            .insert(naga::Type { name: None, inner: inner.clone() }, naga::Span::UNDEFINED),
    };
    let function = &mut module.functions[handle];
    function.result = Some(naga::FunctionResult { ty, binding: None });
    if matches!(function.body.last(), Some(Statement::Return { .. })) {
        let end = function.body.len();
        function.body.cull(end - 1..end);
    }
    function.body.push(Statement::Return { value: Some(value) }, naga::Span::UNDEFINED);
    Ok((module, ty))
}

/// Moves the labels of a diagnostic from the wrapper to the expression.
fn relocate_labels(
    mut error: Diagnostic,
    sources: &SourceSet,
    wrapper: &Rewritten,
    id: SourceId,
) -> Diagnostic {
    for label in &mut error.labels {
        if *sources.get(label.span.source).text == *wrapper.text {
            label.span = Span::new(id, wrapper.original(label.span.range()));
        }
    }
    // In one line, labels that overlap say the same as the first one.
    let first = error.labels.first().map(|label| label.span);
    let mut at = 0;
    error.labels.retain(|label| {
        at += 1;
        at == 1 || first.is_none_or(|first| !overlaps(first, label.span))
    });
    error.notes.retain(|note| !note.contains(FUNCTION));
    error
}

fn overlaps(first: Span, second: Span) -> bool {
    let (first_range, second_range) = (first.range(), second.range());
    first.source == second.source
        && first_range.start < second_range.end
        && second_range.start < first_range.end
}
