//! Measures the permutations of a program, and what each value of an axis changes.

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;

use super::pipeline::ReflectedStage;
use super::statistics::{CostFigure, FIGURES};
use super::{Cost, CostSubject, stages_subject};
use lamplight_bundle::key::{self, KeyPart};
use lamplight_bundle::{
    self as bundle, Axis, Constant, EntryContents, Hash, Language, OverrideChoice, ProgramContents,
    Stage, Target,
};

/// A subject for every permutation of a program for which there is SPIR-V. Its name is the key.
///
/// # Errors
/// A permutation that no pipeline can be made of, and why.
pub fn permutation_subjects(
    program: &ProgramContents,
    language: Language,
) -> Result<Vec<CostSubject>, String> {
    let Some(entries) = program.languages.get(&language) else { return Ok(Vec::new()) };
    let known = entries.iter().map(|(name, entry)| known_units(name, entry));
    let known = known.collect::<Result<Vec<_>, String>>()?;
    let keys: BTreeSet<&String> = entries.values().flat_map(|entry| entry.keys.keys()).collect();
    let subject = |key: &String| {
        let units = entries.values().zip(&known).filter_map(|(entry, known)| {
            let stage = known.get(entry.keys.get(key)?)?;
            Some(chosen_stage(&program.axes, key, stage))
        });
        stages_subject(key, units.collect::<Result<_, _>>()?)
    };
    keys.into_iter()
        .map(|key| subject(key).map_err(|reason| format!("permutation `{key}`: {reason}")))
        .collect()
}

/// A stage in SPIR-V, and the numbers of its overrides.
struct SpecialisedStage {
    known: ReflectedStage,
    choices: Vec<OverrideChoice>,
}

/// The units of an entry point, by hash.
fn known_units(
    name: &str,
    entry: &EntryContents,
) -> Result<BTreeMap<Hash, SpecialisedStage>, String> {
    let unit = |(hash, unit): (&Hash, &bundle::Unit)| {
        let artifact = unit.targets.get(Target::SPIRV.name()).ok_or("there is no SPIR-V")?;
        let reflection = unit.reflection.as_ref().clone();
        let known = ReflectedStage::new(&artifact.native.entry_name, &artifact.bytes, reflection)?;
        Ok((*hash, SpecialisedStage { known, choices: artifact.native.choices.clone() }))
    };
    let units = entry.units.iter().map(unit).collect::<Result<_, String>>();
    units.map_err(|reason| format!("entry point `{name}`: {reason}"))
}

/// The stage of a key, with the values that the key gives its overrides.
fn chosen_stage(
    axes: &[Axis],
    key: &str,
    unit: &SpecialisedStage,
) -> Result<ReflectedStage, String> {
    let mut known = unit.known.clone();
    let constants =
        bundle::constants(axes, key, &known.reflection).map_err(|error| error.to_string())?;
    for constant in constants {
        // An override that the stage does not use has no number.
        let choice = unit.choices.iter().find(|choice| choice.name == constant.name);
        let Some(id) = choice.and_then(|choice| choice.id) else { continue };
        known.words.constants.push((id, constant_bits(&constant)?));
    }
    Ok(known)
}

/// The 32 bits that a specialisation constant takes.
fn constant_bits(constant: &Constant) -> Result<u32, String> {
    match constant.value.as_str() {
        "true" => Ok(1),
        "false" => Ok(0),
        value => value
            .parse::<u32>()
            .or_else(|_| value.parse::<i32>().map(i32::cast_unsigned))
            .map_err(|_| format!("override `{}` is `{value}`", constant.name)),
    }
}

/// What one value of an axis changes in a stage on a GPU, compared with the axis's default.
#[derive(Debug, Clone, Serialize)]
pub struct CostChange {
    pub axis: String,
    pub value: String,
    pub gpu: &'static str,
    pub stage: Stage,
    /// Pairs of permutations that differ only in the axis.
    pub pairs: usize,
    /// By the figure's key.
    pub figures: BTreeMap<&'static str, Spread>,
}

/// How much a figure changes over the pairs.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Spread {
    pub least: i64,
    pub median: i64,
    pub most: i64,
    /// The figure of the median permutation with the default, and with the value.
    pub before: i64,
    pub after: i64,
}

/// The changes of every value for which some pair of permutations exists.
pub fn value_changes(axes: &[Axis], costs: &[Cost]) -> Vec<CostChange> {
    let mut by_place: BTreeMap<(&str, Stage), BTreeMap<&str, &Cost>> = BTreeMap::new();
    for cost in costs {
        let place = by_place.entry((cost.gpu.name, cost.stage)).or_default();
        place.insert(&cost.name, cost);
    }
    let mut changes = Vec::new();
    for axis in axes {
        for value in axis.values.iter().filter(|value| **value != axis.default) {
            for ((gpu, stage), costs) in &by_place {
                let pairs = cost_pairs(&axis.name, value, costs);
                if pairs.is_empty() {
                    continue;
                }
                let spread = |figure: &CostFigure| (figure.key, Spread::over(figure, &pairs));
                changes.push(CostChange {
                    axis: axis.name.clone(),
                    value: value.clone(),
                    gpu,
                    stage: *stage,
                    pairs: pairs.len(),
                    figures: FIGURES.iter().map(spread).collect(),
                });
            }
        }
    }
    changes
}

/// The costs of permutations with the axis's default and with the value, which are otherwise the
/// same.
fn cost_pairs<'c>(
    axis: &str,
    value: &str,
    costs: &BTreeMap<&str, &'c Cost>,
) -> Vec<(&'c Cost, &'c Cost)> {
    let pair = |(key, with): (&&str, &&'c Cost)| {
        let (this, rest): (Vec<KeyPart<'_>>, Vec<KeyPart<'_>>) =
            key::parts(key).partition(|part| part.axis.text == axis);
        let has_value = this.iter().any(|part| part.chosen() == value);
        let without = key::write(rest.iter().map(|part| (part.axis.text, part.chosen())));
        costs.get(without.as_str()).filter(|_| has_value).map(|without| (*without, *with))
    };
    costs.iter().filter_map(pair).collect()
}

impl Spread {
    fn over(figure: &CostFigure, pairs: &[(&Cost, &Cost)]) -> Self {
        let mut values: Vec<(i64, i64, i64)> = pairs
            .iter()
            .map(|(without, with)| {
                let (before, after) = (figure.of(without.figures()), figure.of(with.figures()));
                (after - before, before, after)
            })
            .collect();
        values.sort_unstable();
        let (median, before, after) = values.get(values.len() / 2).copied().unwrap_or_default();
        Self {
            least: values.first().map_or(0, |first| first.0),
            median,
            most: values.last().map_or(0, |last| last.0),
            before,
            after,
        }
    }
}
