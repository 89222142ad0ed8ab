//! The numbers of `shaderlib/published.toml`, which are those of the sources' texts, are those of the
//! presets, of their scenes and of the functions that compute what is printed.

use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;
use std::sync::OnceLock;

use glam::DVec3;
use lamplight::LIBRARY_FILES;
use lamplight::catalogue::preset::{Preset, PresetNumber};
use lamplight::scene::sets::{self, Scene};
use lamplight::source::Files as _;
use libtest_mimic::{Failed, Trial};
use serde::Deserialize;

use super::listings::is_published;
use crate::examples::run;
use crate::render::library;

/// What a text says of a listing.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Published {
    pub section: String,
    #[serde(default)]
    own: BTreeSet<String>,
    pub quantities: Vec<Quantity>,
}

/// One number of it, and where the library has it.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Quantity {
    name: String,
    value: PresetNumber,
    preset: Option<String>,
    factor: Option<f64>,
    scene: Option<String>,
    probe: Option<usize>,
    code: Option<String>,
    eval: Option<String>,
    differs: Option<String>,
}

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("published::quantities", quantities_agree),
        Trial::test("published::quantities_are_noticed", wrong_is_noticed),
    ]
}

/// The tables of the file, by listing.
pub fn published_tables() -> Result<BTreeMap<String, Published>, String> {
    let text = LIBRARY_FILES.read("published.toml").ok().flatten();
    toml::from_str(&text.ok_or("no published.toml")?).map_err(|error| error.to_string())
}

fn quantities_agree() -> Result<(), Failed> {
    let tables = published_tables()?;
    let presets: BTreeMap<&str, &Preset> = library()
        .presets
        .iter()
        .filter(|preset| is_published(preset))
        .map(|preset| (preset.name.as_str(), preset))
        .collect();
    let mut wrong = String::new();
    for name in tables.keys().filter(|name| !presets.contains_key(name.as_str())) {
        wrong += &format!("{name}: numbers of a listing that no preset draws\n");
    }
    for (name, preset) in presets {
        match tables.get(name) {
            None => wrong += &format!("{name}: no numbers in published.toml\n"),
            Some(table) => {
                disagreements(preset, table).iter().for_each(|one| {
                    wrong += &format!("{name}: {one}\n");
                });
            }
        }
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong.into()) }
}

/// What is wrong with the numbers of a preset.
pub fn disagreements(preset: &Preset, table: &Published) -> Vec<String> {
    let wrong = table.quantities.iter().filter_map(|quantity| disagreement(preset, quantity));
    let mut wrong: Vec<String> = wrong.collect();
    let stated: BTreeSet<String> =
        table.quantities.iter().filter_map(|one| one.preset.clone()).collect();
    let numbers: BTreeSet<String> = preset
        .numbers
        .iter()
        .flat_map(|(group, fields)| fields.keys().map(move |field| format!("{group}.{field}")))
        .collect();
    let rest = &numbers - &stated;
    let missing = rest.difference(&table.own);
    wrong.extend(missing.map(|path| format!("the text has no number for {path}")));
    let stale = table.own.difference(&rest);
    wrong.extend(stale.map(|path| format!("`own` has {path}, which is not the preset's own")));
    wrong
}

/// How a number differs, unless it does not, or the preset says so.
fn disagreement(preset: &Preset, quantity: &Quantity) -> Option<String> {
    if let Some(words) = &quantity.differs {
        let is_stated = preset.deviations.iter().any(|one| one.contains(words.as_str()));
        return (!is_stated).then(|| format!("no deviation says `{words}`"));
    }
    let wanted = quantity.value.to_vec();
    if let Some(path) = &quantity.code {
        let missing = wanted.iter().find(|number| !is_in_code(path, **number));
        return missing.map(|number| format!("{}: {path} does not have {number}", quantity.name));
    }
    let found = found_numbers(preset, quantity);
    let factor = quantity.factor.unwrap_or(1.0);
    // The texts have up to nine digits, and the library's functions 24 bits.
    let error = if quantity.eval.is_some() { 1e-6 } else { 1e-9 };
    let is_near = |(a, b): (&f64, &f64)| (a * factor - b).abs() <= error * b.abs().max(1e-3);
    let agree = found.len() == wanted.len() && found.iter().zip(&wanted).all(is_near);
    (!agree).then(|| format!("{}: the text has {wanted:?}, here {found:?}", quantity.name))
}

fn found_numbers(preset: &Preset, quantity: &Quantity) -> Vec<f64> {
    if let Some((group, field)) = quantity.preset.as_ref().and_then(|path| path.split_once('.')) {
        let number = preset.numbers.get(group).and_then(|fields| fields.get(field));
        return number.map(PresetNumber::to_vec).unwrap_or_default();
    }
    if let Some(expression) = &quantity.eval {
        return evaluated().get(expression).map(|value| vec![*value]).unwrap_or_default();
    }
    if let (Some(index), Some(name)) = (quantity.probe, &preset.probe) {
        let probe = library().probes.iter().find(|probe| probe.name == *name);
        return probe
            .and_then(|probe| probe.coefficients.get(index))
            .map(|coefficient| coefficient.to_vec())
            .unwrap_or_default();
    }
    match (quantity.scene.as_deref(), sets::scene(&preset.scene)) {
        (Some(path), Some(scene)) => scene_numbers(&scene, path).unwrap_or_default(),
        _ => Vec::new(),
    }
}

/// The values of all expressions of the file.
fn evaluated() -> &'static BTreeMap<String, f64> {
    static VALUES: OnceLock<BTreeMap<String, f64>> = OnceLock::new();
    VALUES.get_or_init(|| {
        let tables = published_tables().unwrap_or_default();
        let quantities = tables.values().flat_map(|table| &table.quantities);
        let expressions: Vec<String> = quantities.filter_map(|one| one.eval.clone()).collect();
        let mut command = Command::new(env!("CARGO_BIN_EXE_lamplight"));
        let printed = run(command.arg("eval").args(&expressions)).unwrap_or_default();
        let values = printed.lines().filter_map(|line| line.parse().ok());
        expressions.into_iter().zip(values).collect()
    })
}

/// A number of a scene.
fn scene_numbers(scene: &Scene, path: &str) -> Option<Vec<f64>> {
    let vector = |vector: DVec3| Some(vector.to_array().to_vec());
    match path {
        "eye.position" => vector(scene.eye.position),
        "eye.near" => Some(vec![scene.eye.near]),
        "eye.fov_y" => Some(vec![scene.eye.fov_y.to_degrees()]),
        "lamp.target" => vector(scene.lamps.first()?.target),
        "lamps" => Some(vec![scene.lamps.len() as f64]),
        "count" => Some(vec![scene.objects.len() as f64]),
        "object.position" => vector(scene.objects.first()?.world_from_object.w_axis.truncate()),
        "object.color" => vector(scene.objects.first()?.color),
        "second.height" => Some(vec![scene.objects.get(1)?.world_from_object.w_axis.y]),
        _ => None,
    }
}

/// Whether a function or a structure of the library has a number in its text.
fn is_in_code(path: &str, number: f64) -> bool {
    let Some((module, name)) = path.rsplit_once("::") else { return false };
    let file = format!("{}.wesl", module.replace("::", "/"));
    let text = LIBRARY_FILES.read(&file).ok().flatten().unwrap_or_default();
    let begins = [format!("fn {name}("), format!("struct {name} {{"), format!("const {name}")];
    let bodies = text.split("\n}").filter(|body| begins.iter().any(|begin| body.contains(begin)));
    let is_digit = |one: char| one.is_ascii_digit() || one == '.';
    let mut numbers = bodies.flat_map(|body| body.split(|one: char| !is_digit(one)));
    numbers.any(|text| text.trim_end_matches('.').parse() == Ok(number))
}

/// The check notices a number that differs, one that the text does not have, one that is listed as the
/// preset's own and is not there, and a deviation that is not stated.
fn wrong_is_noticed() -> Result<(), Failed> {
    let tables = published_tables()?;
    let named = |name: &str| {
        let preset = library().presets.iter().find(|preset| preset.name == name);
        let both = preset.cloned().zip(tables.get(name));
        both.ok_or_else(|| format!("no {name}"))
    };
    let (mut preset, table) = named("oglpg_7_3")?;
    let light = preset.numbers.get_mut("light").ok_or("no light")?;
    light.insert("strength".to_owned(), PresetNumber::Scalar(9.0));
    light.insert("range".to_owned(), PresetNumber::Scalar(1.0));
    light.remove("ambient");
    let found = disagreements(&preset, table);
    let expected = [
        "Strength: the text has [10.0], here [9.0]",
        "the text has no number for light.range",
        "`own` has light.ambient, which is not the preset's own",
    ];
    let (mut unstated, table) = named("igl_2_cube")?;
    unstated.deviations.clear();
    let missing = disagreements(&unstated, table);
    if found == expected && missing == ["no deviation says `Each face covers 90 degrees.`"] {
        return Ok(());
    }
    Err(format!("found {found:?} and {missing:?}").into())
}
