//! Programs: their axes, and which values can be chosen together.

use std::collections::BTreeMap;

use lamplight::diagnostic::Diagnostics;
use lamplight::permute::{self, Assignment, Axis, Program, Quoted, Space, key};
use lamplight::source::SourceSet;
use serde::{Deserialize, Serialize};
use tsify::{Ts, Tsify};
use wasm_bindgen::prelude::wasm_bindgen;

use crate::diagnostic::{Diagnostic, diagnostics};
use crate::package::{Files, Value, manifest};
use crate::{Answer, answer};

/// A package.
#[derive(Deserialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct ProgramsRequest {
    /// The package; the library where it is left out.
    #[serde(default)]
    #[tsify(optional, type = "Record<string, string>")]
    pub files: Option<Files>,
}

/// The programs of a manifest.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct Programs {
    pub programs: Vec<ProgramInfo>,
    pub diagnostics: Vec<Diagnostic>,
}

/// What a program can be.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct ProgramInfo {
    pub name: String,
    pub doc: String,
    /// Root files: of WESL one, of GLSL one for each stage.
    pub wesl: Option<String>,
    pub glsl_vertex: Option<String>,
    pub glsl_fragment: Option<String>,
    pub targets: Vec<String>,
    pub axes: Vec<AxisInfo>,
    pub constraints: Vec<ConstraintInfo>,
    /// How many permutations the constraints leave, and how many of them ship.
    pub valid: f64,
    pub shipped: f64,
}

/// A choice.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct AxisInfo {
    pub name: String,
    pub doc: String,
    /// `static`, `spec` or `dynamic`.
    pub mode: String,
    pub values: Vec<Value>,
    pub default: Value,
}

/// What a permutation has to fulfil.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct ConstraintInfo {
    pub require: String,
    pub doc: String,
}

/// A point of a program's space.
#[derive(Deserialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct PointRequest {
    /// The package; the library where it is left out.
    #[serde(default)]
    #[tsify(optional, type = "Record<string, string>")]
    pub files: Option<Files>,
    pub program: String,
    /// A key: `shadow=hard,two_sided`.
    #[serde(default)]
    #[tsify(optional)]
    pub key: String,
}

/// What a key means, and what could be chosen next.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
#[tsify(hashmap_as_object)]
pub struct Point {
    /// Canonical.
    pub key: String,
    pub valid: bool,
    /// The sentences of the constraints that it breaks.
    pub broken: Vec<String>,
    /// The value of each axis.
    #[tsify(type = "Record<string, boolean | number | string>")]
    pub settings: BTreeMap<String, Value>,
    pub choices: Vec<Choice>,
    pub diagnostics: Vec<Diagnostic>,
}

/// The point that results if one axis gets another value.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct Choice {
    pub axis: String,
    pub value: Value,
    /// The key of that point.
    pub key: String,
    /// Why it cannot be chosen; empty if it can.
    pub reasons: Vec<String>,
}

/// The programs of a package's `lamplight.toml`; those of the library without files.
#[wasm_bindgen]
pub fn programs(request: Ts<ProgramsRequest>) -> Answer<Programs> {
    let files = request.to_rust()?.files;
    let mut sources = SourceSet::default();
    let (programs, problems) = match manifest(files.as_ref(), &mut sources) {
        Ok(found) => found.get().map_or_else(Default::default, |found| {
            (found.programs.iter().map(info).collect(), found.warnings.clone())
        }),
        Err(problems) => (Vec::new(), problems),
    };
    answer(&Programs { programs, diagnostics: diagnostics(&sources, &problems) })
}

fn info(program: &Program) -> ProgramInfo {
    let path = |file: &Option<permute::manifest::ManifestFile>| {
        file.as_ref().map(|file| file.path.clone())
    };
    let glsl = program.glsl.as_ref();
    let constraint = |constraint: &permute::space::Constraint| ConstraintInfo {
        require: constraint.text.clone(),
        doc: constraint.doc.clone().unwrap_or_default(),
    };
    ProgramInfo {
        name: program.name.clone(),
        doc: program.doc.clone().unwrap_or_default(),
        wesl: path(&program.wesl),
        glsl_vertex: glsl.and_then(|glsl| path(&glsl.vertex)),
        glsl_fragment: glsl.and_then(|glsl| path(&glsl.fragment)),
        targets: program.targets.iter().map(|target| target.name().to_owned()).collect(),
        axes: program.space.axes().iter().map(axis).collect(),
        constraints: program.space.constraints().iter().map(constraint).collect(),
        valid: program.space.valid_count() as f64,
        shipped: program.space.count() as f64,
    }
}

fn axis(axis: &Axis) -> AxisInfo {
    let values: Vec<Value> = axis.values.iter().map(Value::of).collect();
    AxisInfo {
        name: axis.name.clone(),
        doc: axis.doc.clone().unwrap_or_default(),
        mode: axis.mode.name().to_owned(),
        default: values.get(axis.default).cloned().unwrap_or(Value::Bool(false)),
        values,
    }
}

/// What a key means, and which values each axis can take together with the others.
#[wasm_bindgen]
pub fn point(request: Ts<PointRequest>) -> Answer<Point> {
    let request = request.to_rust()?;
    let mut sources = SourceSet::default();
    let found = meant(&request, &mut sources).unwrap_or_else(|problems| Point {
        key: request.key.clone(),
        valid: false,
        broken: Vec::new(),
        settings: BTreeMap::new(),
        choices: Vec::new(),
        diagnostics: diagnostics(&sources, &problems),
    });
    answer(&found)
}

fn meant(request: &PointRequest, sources: &mut SourceSet) -> Result<Point, Diagnostics> {
    let manifest = manifest(request.files.as_ref(), sources)?;
    let program = manifest.get().and_then(|manifest| manifest.program(&request.program));
    let program = program.ok_or_else(|| vec![unknown(&request.program)])?;
    let space = &program.space;
    let point = parsed(space, &request.key, sources)?;
    let settings = space
        .axes()
        .iter()
        .enumerate()
        .map(|(index, axis)| (axis.name.clone(), Value::of(space.value(index, &point))));
    Ok(Point {
        key: space.key(&point).to_string(),
        valid: space.is_valid(&point),
        broken: broken(space, &point),
        settings: settings.collect(),
        choices: choices(space, &point),
        diagnostics: Vec::new(),
    })
}

/// The point that a key names.
pub fn parsed(
    space: &Space,
    text: &str,
    sources: &mut SourceSet,
) -> Result<Assignment, Diagnostics> {
    let id = sources.add("key", text.to_owned());
    key::parse(space, &Quoted::whole(sources, id))
}

/// No program has that name.
fn unknown(name: &str) -> lamplight::diagnostic::Diagnostic {
    let message = format!("there is no program `{name}`");
    lamplight::diagnostic::Diagnostic::error(lamplight::diagnostic::codes::UNKNOWN_PROGRAM, message)
}

fn broken(space: &Space, point: &Assignment) -> Vec<String> {
    let sentence = |constraint: &permute::space::Constraint| match &constraint.doc {
        Some(doc) => doc.clone(),
        None => constraint.text.clone(),
    };
    space.broken(point).map(sentence).collect()
}

fn choices(space: &Space, point: &Assignment) -> Vec<Choice> {
    let mut found = Vec::new();
    for axis in space.axes() {
        for value in &axis.values {
            // A value that an axis lists is always one of it.
            let mut texts = SourceSet::default();
            let id = texts.add("key", format!("{}={value}", axis.name));
            let changed = key::parse_over(space, point.clone(), &Quoted::whole(&texts, id));
            let Ok(changed) = changed else { continue };
            found.push(Choice {
                axis: axis.name.clone(),
                value: Value::of(value),
                key: space.key(&changed).to_string(),
                reasons: broken(space, &changed),
            });
        }
    }
    found
}
