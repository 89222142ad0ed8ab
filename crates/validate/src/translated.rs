//! GLSL as WGSL: every text in GLSL is translated, and read by naga as WGSL.

use std::ops::Range;

use lamplight_bundle::{Language, SourceClip, Stage};
use lamplight_compose::{Composed, Segment, SourceMap, parts_of_wgsl};
use lamplight_diagnostic::source::{SourceId, Span};
use lamplight_diagnostic::{Diagnostic, Diagnostics, Label, Severity, codes};
use lamplight_glsl::is_for_vulkan;
use lamplight_glsl::tree::Stage as GlslStage;
use lamplight_glsl::wgsl::{AuthorNames, Clip, Fact, Options, Written};

use super::advice::{self, Mistake};
use super::browsers::lint_translation;
use super::{CAPABILITIES, hints, lacking, limits, on_large_stack, validate_for_some};

/// How a location is found that fits the other stage.
const OTHER_STAGE: &str =
    "help: it is counted in this file alone; `--with FILE` names the other stage of the program";

/// Stands for the composed text, which is no source of the author's.
const COMPOSED: SourceId = SourceId(u32::MAX);

/// The clip space that the positions of a text are converted from, to WebGPU's.
pub fn positions_of(composed: &Composed, source: SourceClip) -> Clip {
    let is_vertex = composed.language == Language::Glsl && composed.stage == Some(Stage::Vertex);
    match source {
        _ if !is_vertex => Clip::Kept,
        SourceClip::OpenGl => Clip::OpenGl,
        SourceClip::Vulkan => Clip::Vulkan,
        SourceClip::Auto if !is_for_vulkan(&composed.text) => Clip::OpenGl,
        SourceClip::Auto | SourceClip::WebGpu => Clip::Kept,
    }
}

/// Translates a composed text in GLSL to WGSL.
///
/// # Errors
/// `limit-exceeded` for a text that is too large; mistakes of the text, and what has no counterpart
/// in WGSL, in the author's places.
pub fn translate_glsl(
    composed: &Composed,
    stage: Stage,
    options: Options,
) -> Result<Written, Diagnostics> {
    limits::check_limits(composed).map_err(|error| vec![error])?;
    let text = &composed.text;
    let translate = || lamplight_glsl::translate(text, glsl_stage(stage), COMPOSED, options);
    on_large_stack(translate).map_err(|problems| in_authors_text(problems, composed))
}

fn glsl_stage(stage: Stage) -> GlslStage {
    match stage {
        Stage::Vertex => GlslStage::Vertex,
        Stage::Fragment => GlslStage::Fragment,
        Stage::Compute => GlslStage::Compute,
    }
}

/// The text as WGSL that browsers take, with the places of its author. Its warnings are what WGSL has no
/// word for.
///
/// # Errors
/// As [`translate_glsl`]; also for a text that is not GLSL, or whose stage is not known.
pub fn glsl_as_wgsl(composed: &Composed, clip: Clip) -> Result<Composed, Diagnostics> {
    as_wgsl(composed, Options { clip, keeps_rule: false }).map(|translated| translated.wgsl)
}

/// A text in GLSL as WGSL.
#[derive(Debug)]
pub struct TranslatedGlsl {
    /// The text. Its warnings are what WGSL has no word for.
    pub wgsl: Composed,
    /// What the author calls the inputs, the outputs and the bindings.
    pub names: AuthorNames,
}

/// As [`glsl_as_wgsl`], without the filter that turns the rule for derivatives off. So the rule can be
/// looked at, and the output gets the filter where it needs it.
///
/// # Errors
/// As [`glsl_as_wgsl`].
pub fn glsl_as_plain_wgsl(composed: &Composed, clip: Clip) -> Result<TranslatedGlsl, Diagnostics> {
    as_wgsl(composed, Options { clip, keeps_rule: true })
}

fn as_wgsl(composed: &Composed, options: Options) -> Result<TranslatedGlsl, Diagnostics> {
    let (Language::Glsl, Some(stage)) = (composed.language, composed.stage) else {
        let message = "the stage of the GLSL text is not known";
        return Err(vec![Diagnostic::error(codes::GLSL_ERROR, message)]);
    };
    let Written { text, map, facts } = translate_glsl(composed, stage, options)?;
    let mut places = SourceMap::of_imports(composed.map.imports.clone());
    // A lean text has no places at all, and neither has its translation.
    let map = if composed.map.is_empty() { Vec::new() } else { map };
    for segment in map {
        let range = segment.at.range();
        let span = if range.is_empty() { None } else { composed.map.lookup(range) };
        places.push(Segment { start: segment.start, span, verbatim: false });
    }
    let warnings = facts.list.iter().map(|(fact, at)| {
        let warning = Diagnostic::warning(codes::TRANSLATED_OTHERWISE, fact.to_string());
        let warning = match fact {
            Fact::Location(name, location) => warning
                .note(format!("help: write `layout(location = {location})` before `{name}`"))
                .note(OTHER_STAGE),
            Fact::Binding(name, taken, free) => warning.note(format!(
                "help: `binding = {taken}` is taken: write `binding = {free}` before `{name}`"
            )),
            _ => warning,
        };
        let place = Some(at.range()).filter(|range| !range.is_empty());
        match place.and_then(|range| composed.map.lookup(range)) {
            Some(span) => warning.at(span, "declared here"),
            None => warning,
        }
    });
    let wgsl = Composed {
        language: Language::Wesl,
        stage: None,
        parts: parts_of_wgsl(&text),
        text,
        map: places,
        reads: composed.reads.clone(),
        warnings: warnings.collect(),
        decisions: composed.decisions.clone(),
        library: composed.library,
    };
    Ok(TranslatedGlsl { wgsl, names: facts.names })
}

/// Validates the translation of a text in GLSL, and looks for what a lint reports.
///
/// # Errors
/// What is wrong with the translation, which is a mistake of the translator.
pub fn validate_translation(wgsl: &Composed) -> Result<Diagnostics, Diagnostics> {
    let validated = validate_for_some(wgsl).map_err(of_translations)?;
    let lacking = lacking(wgsl, &validated, CAPABILITIES);
    // A target that is asked for and lacks it is an error of `compile`.
    let lacking = lacking.map(|error| Diagnostic { severity: Severity::Warning, ..error });
    Ok(lint_translation(wgsl).into_iter().chain(lacking).collect())
}

/// [`of_translation`] of each error.
pub fn of_translations(errors: Diagnostics) -> Diagnostics {
    errors.into_iter().map(of_translation).collect()
}

/// An error about the WGSL that a text was translated to. The author did not write it: what it says
/// of WGSL's rules is a mistake of the translator.
pub fn of_translation(error: Diagnostic) -> Diagnostic {
    if error.code != codes::WGSL_ERROR {
        return error;
    }
    let message = format!("the translation of this GLSL is not valid: {}", error.message);
    Diagnostic { code: codes::NAGA_INTERNAL, message, ..error }
        .note("help: this is a mistake of Lamplight; please report it with the shader")
}

/// Places in the composed text as places in the author's.
fn in_authors_text(mut problems: Diagnostics, composed: &Composed) -> Diagnostics {
    for problem in &mut problems {
        advise(problem, &composed.text);
    }
    let places: Vec<_> = problems
        .iter()
        .map(|problem| problem.labels.first().map(|label| label.span.range()))
        .collect();
    for problem in &mut problems {
        composed.map.move_labels(problem);
    }
    let hinted = problems.into_iter().zip(places);
    hinted.map(|(problem, place)| with_hint(problem, composed, place)).collect()
}

/// Adds to an error in the places of the composed text what to write.
fn advise(problem: &mut Diagnostic, text: &str) {
    let labels = problem.labels.iter();
    let mut mistake = Mistake {
        message: problem.message.clone(),
        labels: labels.map(|label| (label.span.range(), label.message.clone())).collect(),
        notes: std::mem::take(&mut problem.notes),
    };
    // An error at the end of the text has no place.
    mistake.labels.retain(|(range, _)| !range.is_empty());
    advice::advise_glsl(text, &mut mistake);
    let labels = mistake.labels.into_iter();
    problem.labels = labels
        .map(|(range, message)| Label { span: Span::new(COMPOSED, range), message })
        .collect();
    problem.message = mistake.message;
    problem.notes = mistake.notes;
}

/// Whether a text ends in `let` or `var` and a name.
fn declares_as_in_wgsl(before: &str) -> bool {
    let mut words = before.split_whitespace().rev();
    words.next().is_some() && matches!(words.next(), Some("let" | "var"))
}

/// A name that nothing declares may be one of the library's. A call that fits nothing shows what
/// there is.
fn with_hint(problem: Diagnostic, composed: &Composed, place: Option<Range<usize>>) -> Diagnostic {
    let message = problem.message.clone();
    let before = place.as_ref().and_then(|place| composed.text.get(..place.start));
    if message == "expected `;`, found `:`" && before.is_some_and(declares_as_in_wgsl) {
        return problem.note("help: GLSL declares with the type in front: `vec3 color = ...;`");
    }
    let quoted = message.strip_prefix('`').and_then(|rest| rest.split_once('`'));
    match quoted {
        Some((name, " is not declared")) => {
            hints::hint_unknown(Diagnostic { notes: Vec::new(), ..problem }, composed, name, place)
        }
        Some((name, rest)) if rest.starts_with(" does not take (") => {
            let mismatch = Diagnostic { code: codes::CALL_MISMATCH, ..problem };
            hints::note_signatures(mismatch, composed, name)
        }
        _ => problem,
    }
}
