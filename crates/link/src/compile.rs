//! Compiles one text for every target: linked from functions where possible, as a whole elsewhere.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::browsers::fit_for_browsers;
use super::{Linked, Linker, Reason};
use lamplight_bundle::{
    Artifact, BoundsChecks, ClipConvention, Convention, Conventions, Language, Reflection,
    SourceClip, SpirvForm, Target, Unit,
};
use lamplight_compose::{self as compose, Composed};
use lamplight_diagnostic::{Diagnostic, Diagnostics, Severity, codes};
use lamplight_emit::{self as emit, targets};
use lamplight_files::limits::GROUP_BYTES;
use lamplight_glsl::wgsl::{AuthorNames, Clip, InterfaceName, Resource, Slot};
use lamplight_validate::{
    self as validate, TranslatedGlsl, Validated, on_large_stack, validate_for_some,
    validate_unguarded,
};

/// One text in two forms: as its author reads it, for errors; and without comments and layout,
/// which is what is compiled.
#[derive(Debug, Clone, Copy)]
pub struct TextForms<'a> {
    pub composed: &'a Composed,
    pub lean: &'a Composed,
}

/// What compiling a text gives: a unit, and the warnings for its author.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CompiledUnit {
    pub unit: Unit,
    pub warnings: Diagnostics,
    /// Targets that were compiled as a whole instead of from separate functions, with the reason.
    pub whole: Vec<(Target, Reason)>,
}

/// Compiles a text for every target. Every command gets the bytes that ship from here. GLSL is translated
/// to WGSL first.
///
/// # Errors
/// What is wrong with the text, at the places in its author's files.
pub fn compile(
    text: &TextForms<'_>,
    entry: &str,
    targets: &[Target],
    linker: &Linker<'_>,
) -> Result<CompiledUnit, Diagnostics> {
    match text.composed.language {
        Language::Wesl => compile_wgsl(text, entry, targets, linker),
        Language::Glsl => compile_glsl(text, entry, targets, linker),
    }
}

/// Compiles a text in GLSL. Most texts are linked from their lean form alone; warnings and errors are
/// looked for in a translation of the author's own text.
fn compile_glsl(
    text: &TextForms<'_>,
    entry: &str,
    targets: &[Target],
    linker: &Linker<'_>,
) -> Result<CompiledUnit, Diagnostics> {
    let clip = positions_of(text.composed, linker.conventions);
    let TranslatedGlsl { wgsl: mut lean, names } =
        match validate::glsl_as_plain_wgsl(text.lean, clip) {
            Ok(lean) => lean,
            // Only the author's text has places for errors.
            Err(_) => validate::glsl_as_plain_wgsl(text.composed, clip)?,
        };
    let has_warnings = !std::mem::take(&mut lean.warnings).is_empty();
    let lean = compose::lean(&lean);
    if !has_warnings && let Some(made) = link_clean(&lean, entry, targets, linker)? {
        return Ok(with_names(made, &names));
    }
    let mut composed = validate::glsl_as_plain_wgsl(text.composed, clip)?.wgsl;
    let mut warnings = std::mem::take(&mut composed.warnings);
    let derivatives = validate::lint_derivatives(&composed);
    let allowed = match derivatives.is_empty() {
        true => None,
        false => Some((
            validate::glsl_as_wgsl(text.composed, clip)?,
            compose::lean(&validate::glsl_as_wgsl(text.lean, clip)?),
        )),
    };
    let (composed, lean) = allowed.as_ref().map_or((&composed, &lean), |(text, lean)| (text, lean));
    let forms = TextForms { composed, lean };
    let made = compile_wgsl(&forms, entry, targets, linker).map_err(validate::of_translations)?;
    let is_for_browsers = targets.contains(&Target::WGSL);
    warnings.extend(derivatives.into_iter().map(|warning| match is_for_browsers {
        true => warning.note(format!(
            "the output for `{}` has `diagnostic(off, derivative_uniformity);`",
            Target::WGSL
        )),
        false => warning,
    }));
    warnings.extend(made.warnings);
    Ok(with_names(CompiledUnit { warnings, unit: made.unit, whole: made.whole }, &names))
}

/// The unit, whose reflection calls inputs, outputs and bindings as the author does.
fn with_names(mut made: CompiledUnit, names: &AuthorNames) -> CompiledUnit {
    let AuthorNames { interface, resources } = names;
    let Reflection { inputs, outputs, bindings, .. } = Arc::make_mut(&mut made.unit.reflection);
    for binding in bindings {
        let is_it = |one: &&Resource| (one.group, one.binding) == (binding.group, binding.binding);
        // A part of an array or of a structure has a name of its own.
        let whole = resources.iter().find(is_it).filter(|one| !one.name.contains(['[', '.']));
        if let Some(found) = whole.filter(|one| one.wgsl == binding.name) {
            binding.name.clone_from(&found.name);
        }
    }
    for (list, are_inputs) in [(inputs, true), (outputs, false)] {
        for varying in list {
            let is_it = |name: &&InterfaceName| {
                name.is_input == are_inputs
                    && match &name.slot {
                        Slot::Location(location) => varying.location == Some(*location),
                        Slot::Builtin(builtin) => varying.builtin.as_ref() == Some(builtin),
                    }
            };
            if let Some(found) = interface.iter().find(is_it) {
                varying.name = Some(found.name.clone());
            }
        }
    }
    made
}

/// A text that is linked in all targets and breaks no rule of browsers.
fn link_clean(
    lean: &Composed,
    entry: &str,
    targets: &[Target],
    linker: &Linker<'_>,
) -> Result<Option<CompiledUnit>, Diagnostics> {
    let Ok(linked) = linker.link(lean, entry) else { return Ok(None) };
    let is_suspect = linked.suspect;
    let (unit, whole) = unit_of(linked, targets);
    if is_suspect || !whole.is_empty() {
        return Ok(None);
    }
    check_size(&unit).map_err(|error| vec![error])?;
    Ok(Some(CompiledUnit { unit, warnings: Vec::new(), whole }))
}

/// The unit of the targets that are linked, and those that are not, each with the reason.
fn unit_of(linked: Linked, targets: &[Target]) -> (Unit, Vec<(Target, Reason)>) {
    let mut unit = Unit { reflection: linked.reflection, targets: BTreeMap::new() };
    let mut whole = Vec::new();
    for (target, made) in targets.iter().zip(linked.targets) {
        match made {
            Ok(artifact) => {
                unit.targets.insert(target.name().to_owned(), artifact);
            }
            Err(reason) => whole.push((*target, reason)),
        }
    }
    (unit, whole)
}

/// The clip space that the positions of a text are converted from.
fn positions_of(composed: &Composed, conventions: Conventions) -> Clip {
    match conventions.clip {
        ClipConvention::Wgpu => validate::positions_of(composed, conventions.source_clip),
        ClipConvention::Native => Clip::Kept,
    }
}

/// Compiles a text in WGSL.
fn compile_wgsl(
    text: &TextForms<'_>,
    entry: &str,
    targets: &[Target],
    linker: &Linker<'_>,
) -> Result<CompiledUnit, Diagnostics> {
    let linked = match linker.link(text.lean, entry) {
        Ok(linked) => linked,
        Err(reason) => {
            let (unit, warnings) = compile_whole(text, entry, targets, linker)?;
            check_size(&unit).map_err(|error| vec![error])?;
            let whole = targets.iter().map(|target| (*target, reason)).collect();
            return Ok(CompiledUnit { unit, warnings, whole });
        }
    };
    let is_suspect = linked.suspect;
    let (mut unit, whole) = unit_of(linked, targets);
    if !whole.is_empty() {
        let left: Vec<Target> = whole.iter().map(|(target, _)| *target).collect();
        unit.targets.extend(compile_whole(text, entry, &left, linker)?.0.targets);
    }
    let mut warnings = Vec::new();
    if is_suspect {
        warnings = lint_text(text, targets)?;
        fit_unit(text, entry, &mut unit)?;
    }
    check_size(&unit).map_err(|error| vec![error])?;
    Ok(CompiledUnit { unit, warnings, whole })
}

/// Validates a text after the sandbox: a large text first goes through everything that is asked for
/// in another process, which shows that naga survives it.
fn try_and_validate(
    text: &TextForms<'_>,
    entry: &str,
    targets: &[Target],
    linker: &Linker<'_>,
) -> Result<Validated, Diagnostics> {
    let outputs = || {
        let targets = targets.iter().map(|target| target.name().to_owned()).collect();
        // What naga reads is converted already, and the form of SPIR-V comes after naga.
        let Conventions { clip, source_clip: _, bounds, spirv: _ } = linker.conventions;
        let [clip, bounds] = [clip.name(), bounds.name()].map(str::to_owned);
        Some(validate::SandboxOutputs { entry: entry.to_owned(), targets, clip, bounds })
    };
    match validate::try_in_sandbox(text.lean, text.composed, outputs) {
        // The lean text is validated faster. Only the author's text has places for errors.
        Ok(()) => validate_unguarded(text.lean).or_else(|_| validate_for_some(text.composed)),
        Err(error) if error.code == codes::NAGA_EXHAUSTED => Err(vec![error]),
        // Expanded aliases can make the lean text too large where the author's text is not.
        Err(_) => {
            let tried = validate::try_in_sandbox(text.composed, text.composed, outputs);
            tried.map_err(|error| vec![error])?;
            validate_unguarded(text.composed)
        }
    }
}

/// Does what [`compile`] and [`validate()`] would do with a large text. It is called in a process
/// of its own, and its result does not matter: only that the process survives.
pub fn perform_job(job: &validate::SandboxJob) {
    let composed = Composed::of_text(Language::Wesl, None, job.text.clone());
    let Some(outputs) = &job.outputs else {
        let _ = validate_for_some(&composed);
        return;
    };
    let targets: Vec<Target> =
        outputs.targets.iter().filter_map(|name| Target::find(name)).collect();
    let text = TextForms { composed: &composed, lean: &composed };
    let conventions = Conventions {
        clip: ClipConvention::find(&outputs.clip).unwrap_or_default(),
        source_clip: SourceClip::WebGpu,
        bounds: BoundsChecks::find(&outputs.bounds).unwrap_or_default(),
        spirv: SpirvForm::default(),
    };
    let linker = Linker::with(&targets, conventions);
    let _ = on_large_stack(|| compile_whole(&text, &outputs.entry, &targets, &linker));
}

/// Refuses an output that is larger than a bundle allows.
fn check_size(unit: &Unit) -> Result<(), Diagnostic> {
    match unit.targets.iter().find(|(_, artifact)| artifact.bytes.len() > GROUP_BYTES) {
        None => Ok(()),
        Some((target, artifact)) => {
            let bytes = artifact.bytes.len();
            let message = format!(
                "the output for target `{target}` has {bytes} bytes, more than the {GROUP_BYTES} \
                 that a bundle takes"
            );
            Err(Diagnostic::error(codes::LIMIT_EXCEEDED, message))
        }
    }
}

fn lint_text(text: &TextForms<'_>, targets: &[Target]) -> Result<Diagnostics, Diagnostics> {
    let for_browsers = targets.contains(&Target::WGSL);
    let found = validate::lint_wgsl(text.composed, for_browsers);
    // Browsers refuse some, and a text can make others errors.
    match found.iter().any(|one| one.severity == Severity::Error) {
        true => Err(found),
        false => Ok(found),
    }
}

/// Validates a text, reflects its entry point and writes it for some targets.
fn compile_whole(
    text: &TextForms<'_>,
    entry: &str,
    targets: &[Target],
    linker: &Linker<'_>,
) -> Result<(Unit, Diagnostics), Diagnostics> {
    let whole = || validate_for_some(text.composed);
    let validated = try_and_validate(text, entry, targets, linker)?;
    emit::check_targets(text.lean, &validated, targets)
        .or_else(|_| emit::check_targets(text.composed, &whole()?, targets))?;
    let mut unit = compile_unit(text, &validated, entry, targets, linker)
        .map_err(|error| vec![emit::at_entry(error, text.composed, entry)])?;
    // Lints are looked for in the author's text, since the lean text has no places.
    let warnings = match validate::has_lints(text.lean) {
        true => lint_text(text, targets)?,
        false => Vec::new(),
    };
    fit_unit(text, entry, &mut unit)?;
    Ok((unit, warnings))
}

/// Makes the WGSL of a unit such that browsers take it, where filters at statements allow derivatives:
/// naga does not read these.
fn fit_unit(text: &TextForms<'_>, entry: &str, unit: &mut Unit) -> Result<(), Diagnostics> {
    if !text.lean.text.contains("@diagnostic") {
        return Ok(());
    }
    match unit.targets.get_mut(Target::WGSL.name()) {
        Some(artifact) => fit_for_browsers(text, entry, artifact),
        None => Ok(()),
    }
}

fn compile_unit(
    text: &TextForms<'_>,
    validated: &Validated,
    entry: &str,
    targets: &[Target],
    linker: &Linker<'_>,
) -> Result<Unit, Diagnostic> {
    let reflection = Arc::new(emit::reflect(validated, entry)?);
    let artifacts = targets.iter().map(|&target| {
        let artifact = compile_artifact(validated, entry, target, linker.conventions);
        let artifact = artifact.map_err(|error| place_error(error, text, entry, target, linker))?;
        Ok((target.name().to_owned(), artifact))
    });
    let targets = artifacts.collect::<Result<BTreeMap<_, _>, Diagnostic>>()?;
    Ok(Unit { reflection, targets })
}

/// Gives an error of a writer its place: the function that the target cannot express, or else the
/// entry point.
fn place_error(
    error: Diagnostic,
    text: &TextForms<'_>,
    entry: &str,
    target: Target,
    linker: &Linker<'_>,
) -> Diagnostic {
    if !error.labels.is_empty() {
        return error;
    }
    let culprit = linker.culprit(text.lean, entry, target);
    let function = culprit.as_deref().and_then(|name| text.composed.function(name));
    let function = function.or_else(|| text.composed.function(entry));
    match function.and_then(|function| text.composed.place_of(function)) {
        Some(span) => error.at(span, format!("`{target}` cannot express this function")),
        None => error,
    }
}

fn compile_artifact(
    validated: &Validated,
    entry: &str,
    target: Target,
    conventions: Conventions,
) -> Result<Artifact, Diagnostic> {
    let emitted = emit::emit_for(validated, entry, target, conventions)?;
    let extension = targets::find(target).map_or("", |entry| entry.extension).to_owned();
    Ok(Artifact { bytes: emitted.bytes.into(), extension, native: Arc::new(emitted.native) })
}
