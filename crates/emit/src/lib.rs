//! Writes a valid module in each output language, one file a language.
//!
//! Unless [`ClipConvention::Native`](lamplight_bundle::ClipConvention) is asked for, all targets
//! keep WebGPU's conventions, so that one host-side path serves them: NDC depth is [0, 1], NDC y
//! points up, texture and framebuffer rows start at the top.
//! - `spirv`: as written; the host gives a viewport of negative height, as wgpu does.
//! - GLSL in every version: a vertex stage ends with `y = -y, z = 2z - w`, so that under
//!   GL's own clip space (leave `glClipControl` alone) depth values, shadow lookups, derivatives
//!   and `gl_FragCoord` are those of the other targets. Images are stored top row first: the last
//!   pass to the window flips them, and front faces wind the other way round for `glFrontFace`.
//! - `msl`, `hlsl`, `wgsl`: the same conventions are native.

pub mod clip;
mod columns;
mod depths;
mod descriptors;
mod ends;
mod extensions;
mod filters;
mod fractions;
mod gaps;
pub mod glsl;
mod gradients;
mod header;
mod immediates;
mod invariants;
mod isolate;
mod lacks;
mod lets;
mod lists;
mod located;
mod names;
mod nesting;
mod packed;
pub mod padding;
mod plain;
mod rebuild;
mod reflect;
mod remainder;
mod rename;
mod results;
mod rows;
mod sample_mask;
mod setters;
mod shapes;
mod short_storage;
mod sized;
mod slots;
mod specialise;
pub mod spirv;
mod text;
mod unused;
mod workgroups;
mod zeros;

#[doc(hidden)]
pub use ends::proof::LoopProofs;
pub use filters::without_derivative_rule;
pub use header::is_header_line;
pub use isolate::{isolate, with_defaults};
pub use names::type_name;
pub use plain::with_masked_shifts;
pub use reflect::reflect;
pub use specialise::keep_variables_only;

use naga::ShaderStage;
use naga::back::glsl::Version;
use naga::proc::{BoundsCheckPolicies, BoundsCheckPolicy};
use naga::valid::Capabilities;

use lamplight_bundle::{self as bundle, BoundsChecks, Conventions, Native, Target};
use lamplight_compose::{Composed, Part, PartKind};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_validate::{Validated, guard, on_large_stack};

/// An output language.
#[derive(Debug)]
pub struct TargetEntry {
    /// Its name.
    pub target: Target,
    /// The extension of its files, without the dot.
    pub extension: &'static str,
    /// Whether the output is bytes rather than text.
    pub binary: bool,
    /// One line for listings.
    pub about: &'static str,
    /// The version, if the language is GLSL. [`lacks`] refuses what this version does not have.
    pub glsl: Option<Version>,
    /// What the language has of what not every target has.
    pub capabilities: Capabilities,
    /// What lines before the first declaration begin with. Comments need not be listed.
    pub header: &'static [&'static str],
    /// What the language has for overrides.
    pub overrides: Overrides,
    /// Whether the language has immediates. Others have a uniform buffer.
    pub immediates: bool,
    /// What validates its outputs.
    pub validation: ValidatorRules,
    /// The clip spaces of its vertex stages.
    pub clip: &'static clip::Spaces,
    /// Writes the entry point of a module without overrides; only [`emit`] calls it.
    pub write: fn(&EmitSource<'_>) -> Result<Emitted, String>,
}

/// How the host chooses the value of an override.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Overrides {
    /// The language has overrides.
    Kept,
    /// Specialisation constants of SPIR-V.
    Specialised,
    /// Function constants of Metal.
    FunctionConstants,
    /// Macros, which the host defines before the text is compiled.
    Macros,
}

/// What validates the outputs of a target, from their bytes. Every target has a validator, and the
/// package `validators` runs it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ValidatorRules {
    /// The name of a file of `crates/validators/src/programs/`.
    pub validator: &'static str,
    /// The rules that outputs must keep. They are those of the validator, whose file explains them.
    pub rules: &'static [&'static str],
}

/// One file for each output language.
pub mod targets {
    use super::TargetEntry;
    include!(concat!(env!("OUT_DIR"), "/targets.rs"));

    /// The entry of a target.
    pub fn find(target: lamplight_bundle::Target) -> Option<&'static TargetEntry> {
        ALL.iter().copied().find(|entry| entry.target == target)
    }
}

/// What an output is written from.
pub struct EmitSource<'a> {
    /// A valid module without overrides.
    pub module: &'a naga::Module,
    /// What naga's validator found out about the module.
    pub info: &'a naga::valid::ModuleInfo,
    /// Stage of the entry point.
    pub stage: ShaderStage,
    /// Name of the entry point.
    pub entry: &'a str,
    /// Index of the entry point in the module.
    pub index: usize,
    /// The clip space and the bounds checks that are asked for.
    pub conventions: Conventions,
}

impl EmitSource<'_> {
    /// Whether the output checks indices and loops.
    pub fn is_restricted(&self) -> bool {
        self.conventions.bounds == BoundsChecks::Restrict
    }

    /// The same for another module that was made of its module, if there is one.
    fn with_analysed<'m>(
        &'m self,
        other: Option<&'m (naga::Module, naga::valid::ModuleInfo)>,
    ) -> EmitSource<'m> {
        let (module, info) =
            other.map_or((self.module, self.info), |(module, info)| (module, info));
        EmitSource { module, info, ..*self }
    }

    /// The checks, as naga names them.
    pub fn bounds_policies(&self) -> BoundsCheckPolicies {
        let policy = match self.conventions.bounds {
            BoundsChecks::Unchecked => BoundsCheckPolicy::Unchecked,
            BoundsChecks::Restrict => BoundsCheckPolicy::Restrict,
        };
        let (index, buffer, image_load) = (policy, policy, policy);
        // Arrays of bindings have no length that an output could ask for.
        let binding_array = BoundsCheckPolicy::Unchecked;
        BoundsCheckPolicies { index, buffer, image_load, binding_array }
    }
}

/// One shader in one output language.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Emitted {
    /// The output: text, or the words of SPIR-V.
    pub bytes: Vec<u8>,
    /// Its entry point's name, slots and combined samplers.
    pub native: Native,
}

/// Refuses what targets cannot express, before anything is written: overrides without a value, and
/// functions that are newer than a target's language.
///
/// # Errors
/// `override-without-value`, `emit-failed`, `not-portable`; in the author's places where `composed`
/// knows them.
pub fn check_targets(
    composed: &Composed,
    validated: &Validated,
    targets: &[Target],
) -> Result<(), Diagnostics> {
    lacks::check_capabilities(composed, validated, targets)?;
    specialise::check_overrides(composed, validated, targets)?;
    lacks::check_lacks(composed, validated, targets)
}

/// Writes one entry point for one target. Overrides stay open: [`Native::choices`] says how each
/// is chosen.
///
/// # Errors
/// `emit-failed` with the writer's message, `naga-internal` where the writer panicked,
/// `unknown-entry-point`, and `override-without-value`, whose place [`check_targets`] gives.
pub fn emit(validated: &Validated, entry: &str, target: Target) -> Result<Emitted, Diagnostic> {
    emit_for(validated, entry, target, Conventions::default())
}

/// [`emit()`] with conventions.
///
/// # Errors
/// As of [`emit()`].
pub fn emit_for(
    validated: &Validated,
    entry: &str,
    target: Target,
    conventions: Conventions,
) -> Result<Emitted, Diagnostic> {
    let index = find_target(validated, entry)?;
    let Some(writer) = targets::find(target) else {
        return Err(Diagnostic::error(
            codes::EMIT_FAILED,
            format!("there is no writer for target `{target}`"),
        ));
    };
    on_large_stack(|| guard("", || write_entry(validated, index, writer, conventions)))
        .and_then(|result| result)
        .map_err(|error| error.note(format!("while writing `{entry}` for target `{target}`")))
}

fn write_entry(
    validated: &Validated,
    index: usize,
    writer: &TargetEntry,
    conventions: Conventions,
) -> Result<Emitted, Diagnostic> {
    let mut emitted = written_plainly(validated, index, writer, conventions)?;
    let is_vertex = validated.module.entry_points[index].stage == ShaderStage::Vertex;
    emitted.native.clip = is_vertex.then(|| writer.clip.of(conventions.clip));
    Ok(emitted)
}

fn written_plainly(
    validated: &Validated,
    index: usize,
    writer: &TargetEntry,
    conventions: Conventions,
) -> Result<Emitted, Diagnostic> {
    let failed = |reason: String| {
        // What to do about it stands on a line of its own.
        let (reason, help) = reason.split_once('\n').unwrap_or((&reason, ""));
        let error =
            Diagnostic::error(codes::EMIT_FAILED, format!("target `{}`: {reason}", writer.target));
        if help.is_empty() { error } else { error.note(help) }
    };
    let point = &validated.module.entry_points[index];
    let fixed = match writer.overrides {
        Overrides::Kept => None,
        _ => specialise::with_constants(validated, index)?,
    };
    let own = index;
    let (module, info, index) = match &fixed {
        Some((module, info)) => (module, info, 0),
        None => (&validated.module, &validated.info, index),
    };
    let uniform = match writer.immediates {
        true => None,
        false => immediates::as_uniform(module).map_err(failed)?,
    };
    let (module, info) = uniform.as_ref().map_or((module, info), |(module, info)| (module, info));
    let (stage, entry) = (point.stage, point.name.as_str());
    let source = EmitSource { module, info, stage, entry, index, conventions };
    if writer.overrides == Overrides::Kept || module.overrides.is_empty() {
        return (writer.write)(&source).map_err(failed);
    }
    if let Some(written) = specialise::write_open(&source, writer) {
        return written.map_err(failed);
    }
    let (module, info) = specialise::with_defaults(validated, own)?;
    (writer.write)(&EmitSource { module: &module, info: &info, index: 0, ..source }).map_err(failed)
}

/// Gives an error of a writer, which has no place of its own, that of the entry point.
pub fn at_entry(error: Diagnostic, composed: &Composed, entry: &str) -> Diagnostic {
    let is_entry = |part: &&Part| {
        part.kind == PartKind::Function && part.names.iter().any(|name| name == entry)
    };
    let part = composed.parts.iter().find(is_entry).filter(|_| error.labels.is_empty());
    let name = part.map(|part| {
        let at = composed.text[part.range.clone()].find(&format!("fn {entry}"));
        part.range.start + at.map_or(0, |at| at + 3)
    });
    let name = name.or_else(|| declared_name(&composed.text, entry));
    match name.and_then(|start| composed.map.lookup(start..start + entry.len())) {
        Some(span) if error.labels.is_empty() => error.at(span, "of this entry point"),
        _ => error,
    }
}

/// Where a text without known parts, such as one in GLSL, declares an entry point.
fn declared_name(text: &str, entry: &str) -> Option<usize> {
    let is_whole = |end: usize| {
        let next = text[end..].chars().next();
        next.is_some_and(|next| next != '_' && !next.is_alphanumeric())
    };
    ["void ", "fn "].iter().find_map(|word| {
        let declared = format!("{word}{entry}");
        let mut found = text.match_indices(&declared).map(|(at, _)| at + word.len());
        found.find(|at| is_whole(at + entry.len()))
    })
}

/// Index of the entry point of that name.
fn find_target(validated: &Validated, entry: &str) -> Result<usize, Diagnostic> {
    let points = &validated.module.entry_points;
    points.iter().position(|point| point.name == entry).ok_or_else(|| {
        let names: Vec<&str> = points.iter().map(|point| point.name.as_str()).collect();
        let list = if names.is_empty() {
            "there are no entry points".to_owned()
        } else {
            format!("entry points: {}", names.join(", "))
        };
        Diagnostic::error(codes::UNKNOWN_ENTRY_POINT, format!("no entry point is named `{entry}`"))
            .suggest(entry, names.iter().copied())
            .note(list)
    })
}

/// The stage, if it is one that the crate handles.
fn known_stage(stage: ShaderStage) -> Option<bundle::Stage> {
    match stage {
        ShaderStage::Vertex => Some(bundle::Stage::Vertex),
        ShaderStage::Fragment => Some(bundle::Stage::Fragment),
        ShaderStage::Compute => Some(bundle::Stage::Compute),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::targets;
    use lamplight_validate::{CAPABILITIES, SOME_TARGET_HAS};

    /// The validator accepts what at least one target writes, and nothing else.
    #[test]
    fn some_target_has_what_is_accepted() {
        let all = targets::ALL.iter().fold(CAPABILITIES, |all, one| all.union(one.capabilities));
        assert_eq!(all, SOME_TARGET_HAS);
    }
}
