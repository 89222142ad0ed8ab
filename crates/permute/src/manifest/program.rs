//! One program of a manifest.

use toml::de::DeTable;

use super::reader::{Depth, ManifestReader, TomlName, TomlValue};
use super::{axes, lists, names};
use crate::axis::Axis;
use crate::space::{Constraint, SliceLists, Space, TooComplex};
use crate::{lint, report};
use lamplight_bundle::{
    BoundsChecks, ClipConvention, Convention, Conventions, SourceClip, SpirvForm, Target,
};
use lamplight_diagnostic::source::{LIMITS, Span};
use lamplight_diagnostic::{Diagnostic, Severity, codes};

/// Entry points in one or both languages, and what they vary in.
#[derive(Debug, Clone)]
pub struct Program {
    /// As the manifest and bundles call it.
    pub name: String,
    /// What it is, in the manifest's words.
    pub doc: Option<String>,
    /// The root module. There is this, or `glsl`, or both.
    pub wesl: Option<ManifestFile>,
    /// Its root files in GLSL, one for each stage.
    pub glsl: Option<Glsl>,
    /// In the order declared; all, where the manifest names none.
    pub targets: Vec<Target>,
    /// The clip space and the checks of its outputs.
    pub conventions: Conventions,
    /// Its permutations.
    pub space: Space,
    /// A list of the keys that engines asked for: only these are wanted, and those of `include`.
    pub usage: Option<ManifestFile>,
    /// The most permutations that it may have. A program with more is refused.
    pub limit: usize,
    /// The name in the manifest.
    pub span: Span,
}

impl Program {
    /// The root files of both languages.
    pub fn files(&self) -> impl Iterator<Item = &ManifestFile> {
        let glsl = self.glsl.iter().flat_map(|glsl| [&glsl.vertex, &glsl.fragment]).flatten();
        self.wesl.iter().chain(glsl)
    }

    /// As [`Self::files`], but mutable.
    pub fn files_mut(&mut self) -> impl Iterator<Item = &mut ManifestFile> {
        let glsl = self.glsl.iter_mut().flat_map(|glsl| [&mut glsl.vertex, &mut glsl.fragment]);
        self.wesl.iter_mut().chain(glsl.flatten())
    }
}

/// A file that a manifest names.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ManifestFile {
    /// Relative to the package's root, `/`-separated.
    pub path: String,
    /// Where it is named.
    pub span: Span,
}

/// The stages of a GLSL program, at least one of them.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Glsl {
    /// Root file of the vertex stage.
    pub vertex: Option<ManifestFile>,
    /// Root file of the fragment stage.
    pub fragment: Option<ManifestFile>,
}

const KEYS: &[&str] = &[
    "wesl",
    "glsl",
    "targets",
    "clip",
    "source_clip",
    "bounds",
    "spirv",
    "axis",
    "constraint",
    "include",
    "only",
    "exclude",
    "usage",
    "limit",
    "features_default",
    "doc",
];

/// Reads a program; `None` if there is an error in it.
pub fn read_program(
    reader: &mut ManifestReader,
    name: &TomlName,
    value: &TomlValue,
) -> Option<Program> {
    let errors = error_count(reader);
    let span = reader.span(name.span());
    let name = name.get_ref().to_string();
    let what = format!("program `{name}`");
    reader.problems.extend(names::check_name(&name, "a program", span));
    let table = reader.table(value, &what)?;
    reader.check_keys(table, KEYS, &what);
    let doc = reader.doc(table);
    let wesl = table.get("wesl").and_then(|value| read_file(reader, value, "`wesl`"));
    let glsl = table.get("glsl").and_then(|value| read_glsl(reader, value));
    if !table.contains_key("wesl") && !table.contains_key("glsl") {
        let message = format!("{what} has no source");
        reader.problems.push(
            Diagnostic::error(codes::MISSING_KEY, message).at(span, "needs `wesl`, `glsl` or both"),
        );
    }
    let usage = table.get("usage").and_then(|value| read_file(reader, value, "`usage`"));
    let targets =
        table.get("targets").map_or(Target::ALL.to_vec(), |value| read_targets(reader, value));
    let conventions = read_conventions(reader, table);
    let limit =
        table.get("limit").map_or(Some(LIMITS.permutations), |value| read_limit(reader, value));
    let undeclared =
        table.get("features_default").and_then(|value| features_default(reader, value));
    let mut space = read_space(reader, table, &what, span)?;
    space.undeclared = undeclared;
    let program =
        Program { name, doc, wesl, glsl, targets, conventions, space, usage, limit: limit?, span };
    if reader.depth == Depth::Whole {
        check_limit(reader, &program);
    }
    (self::error_count(reader) == errors).then_some(program)
}

fn error_count(reader: &ManifestReader) -> usize {
    reader.problems.iter().filter(|problem| problem.severity == Severity::Error).count()
}

fn read_file(reader: &mut ManifestReader, value: &TomlValue, what: &str) -> Option<ManifestFile> {
    let text = reader.string(value, what)?;
    Some(ManifestFile { path: text.text, span: text.span })
}

fn read_glsl(reader: &mut ManifestReader, value: &TomlValue) -> Option<Glsl> {
    let table = reader.table(value, "`glsl`")?;
    reader.check_keys(table, &["vertex", "fragment"], "`glsl`");
    let mut stage = |name: &str| {
        table.get(name).and_then(|value| read_file(reader, value, &format!("`{name}`")))
    };
    let found = Glsl { vertex: stage("vertex"), fragment: stage("fragment") };
    if table.is_empty() {
        let place = reader.span(value.span());
        reader.problems.push(
            Diagnostic::error(codes::MISSING_KEY, "`glsl` has no stage")
                .at(place, "needs `vertex`, `fragment` or both"),
        );
    }
    Some(found)
}

fn read_targets(reader: &mut ManifestReader, value: &TomlValue) -> Vec<Target> {
    let Some(array) = reader.array(value, "`targets`") else { return Vec::new() };
    let mut found: Vec<Target> = Vec::new();
    for value in array.iter() {
        let target = read_target(reader, value);
        found.extend(target.filter(|target| !found.contains(target)));
    }
    found
}

fn read_target(reader: &mut ManifestReader, value: &TomlValue) -> Option<Target> {
    let unknown = (codes::UNKNOWN_TARGET, ["there is no target", "not a target", "targets"]);
    let known = Target::ALL.iter().map(|target| (target.name(), *target));
    reader.choice(value, "a target", known, unknown)
}

/// The conventions of a program. Where a name is wrong, the error is reported and the default is
/// used.
fn read_conventions(reader: &mut ManifestReader, table: &DeTable) -> Conventions {
    let clip = table.get("clip").and_then(|value| {
        let unknown = (codes::UNKNOWN_CLIP, ["there is no clip space", "not one", "clip spaces"]);
        reader.choice(value, "`clip`", ClipConvention::ALL.iter().copied(), unknown)
    });
    let bounds = table.get("bounds").and_then(|value| {
        let unknown =
            (codes::UNKNOWN_BOUNDS, ["there is no choice of checks", "not one", "checks"]);
        reader.choice(value, "`bounds`", BoundsChecks::ALL.iter().copied(), unknown)
    });
    let source_clip = table.get("source_clip").and_then(|value| {
        let unknown = (codes::UNKNOWN_CLIP, ["there is no clip space", "not one", "clip spaces"]);
        reader.choice(value, "`source_clip`", SourceClip::ALL.iter().copied(), unknown)
    });
    let spirv = table.get("spirv").and_then(|value| {
        let unknown = (codes::UNKNOWN_SPIRV, ["there is no form of SPIR-V", "not one", "forms"]);
        reader.choice(value, "`spirv`", SpirvForm::ALL.iter().copied(), unknown)
    });
    Conventions {
        clip: clip.unwrap_or_default(),
        source_clip: source_clip.unwrap_or_default(),
        bounds: bounds.unwrap_or_default(),
        spirv: spirv.unwrap_or_default(),
    }
}

/// The words of `features_default`, with the value of a feature that no axis declares.
const FEATURES: &[(&str, Option<bool>)] =
    &[("on", Some(true)), ("off", Some(false)), ("error", None)];

fn features_default(reader: &mut ManifestReader, value: &TomlValue) -> Option<bool> {
    let text = reader.string(value, "`features_default`")?;
    let found = FEATURES.iter().find(|(name, _)| *name == text.text);
    if found.is_none() {
        let message = format!("`features_default` is `on`, `off` or `error`, not `{}`", text.text);
        let unknown =
            Diagnostic::error(codes::UNKNOWN_VALUE, message).at(text.span, "not a choice");
        reader.problems.push(unknown.suggest(&text.text, FEATURES.iter().map(|(name, _)| *name)));
    }
    found.and_then(|(_, undeclared)| *undeclared)
}

fn read_limit(reader: &mut ManifestReader, value: &TomlValue) -> Option<usize> {
    let number = reader.integer(value, "`limit`")?;
    let found =
        usize::try_from(number).ok().filter(|limit| (1..=LIMITS.permutations).contains(limit));
    if found.is_none() {
        let message =
            format!("`limit` is a number of permutations from 1 to {}", LIMITS.permutations);
        reader.problems.push(
            Diagnostic::error(codes::WRONG_TYPE, message)
                .at(reader.span(value.span()), "out of range"),
        );
    }
    found
}

/// Reads the axes first. If one of them is missing nothing else is read, since most errors would
/// only follow from that.
fn read_space(
    reader: &mut ManifestReader,
    table: &DeTable,
    what: &str,
    place: Span,
) -> Option<Space> {
    let before = error_count(reader);
    let axes =
        table.get("axis").map_or(Some(Vec::new()), |value| axes::read_axes(reader, value))?;
    let constraints = table
        .get("constraint")
        .map_or(Vec::new(), |value| axes::read_constraints(reader, &axes, value));
    if reader.depth == Depth::Outline {
        return (error_count(reader) == before).then(|| Space::outline(axes, constraints));
    }
    let only = table.get("only").map_or(Vec::new(), |value| lists::read_only(reader, &axes, value));
    let exclude =
        table.get("exclude").map_or(Vec::new(), |value| lists::read_exclude(reader, &axes, value));
    let space = read_lists(
        reader,
        table,
        axes,
        constraints,
        SliceLists { only, exclude, include: Vec::new() },
    );
    let Ok(space) = space else {
        let message = format!(
            "the constraints and lists of {what} are too complex to count its permutations"
        );
        reader
            .problems
            .push(Diagnostic::error(codes::SPACE_TOO_COMPLEX, message).at(place, "declared here"));
        return None;
    };
    if error_count(reader) > before {
        return None;
    }
    reader.problems.extend(lint::lint(&space, what, place));
    Some(space)
}

/// Reads the lists. Keys can be read only once there is a space, which the lists then narrow.
fn read_lists(
    reader: &mut ManifestReader,
    table: &DeTable,
    axes: Vec<Axis>,
    constraints: Vec<Constraint>,
    mut lists: SliceLists,
) -> Result<Space, TooComplex> {
    let valid = Space::new(axes.clone(), constraints.clone(), SliceLists::default())?;
    lists.include =
        table.get("include").map_or(Vec::new(), |value| lists::read_include(reader, &valid, value));
    if lists == SliceLists::default() { Ok(valid) } else { Space::new(axes, constraints, lists) }
}

fn check_limit(reader: &mut ManifestReader, program: &Program) {
    if program.space.count() <= program.limit as u128 {
        return;
    }
    let report = report::report(&program.name, &program.space);
    let limit = report::Count(program.limit as u128);
    let message = format!(
        "program `{}` has {} permutations, and its limit is {limit}",
        program.name, report.wanted
    );
    let diagnostic =
        Diagnostic::error(codes::TOO_MANY_PERMUTATIONS, message).at(program.span, "declared here");
    let raise = if program.limit < LIMITS.permutations { ", or raise `limit`" } else { "" };
    let advice = format!("add constraints or name the slices you need in `only`{raise}");
    reader.problems.push(diagnostic.note(advice).note(report.to_string()));
}
