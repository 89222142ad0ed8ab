//! The permutations of a program as subjects, and what each value of an axis changes.

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;

use super::pipeline::Known;
use super::statistics::{FIGURES, Figure};
use super::{Cost, Subject, stages};
use crate::bundle::{Axis, Language, ProgramContents, Stage, Target};

/// Every permutation of a program that has its SPIR-V, by key.
pub fn subjects(program: &ProgramContents, language: Language) -> Vec<Subject> {
    let Some(entries) = program.languages.get(&language) else { return Vec::new() };
    let known: Vec<BTreeMap<_, Known>> = entries
        .values()
        .map(|entry| {
            let units = entry.units.iter().filter_map(|(hash, unit)| {
                let artifact = unit.targets.get(Target::SPIRV.name())?;
                let reflection = unit.reflection.as_ref().clone();
                let name = &artifact.native.entry_name;
                Some((*hash, Known::new(name, &artifact.bytes, reflection)?))
            });
            units.collect()
        })
        .collect();
    let keys: BTreeSet<&String> = entries.values().flat_map(|entry| entry.keys.keys()).collect();
    let subject = |key: &&String| {
        let units = entries
            .values()
            .zip(&known)
            .filter_map(|(entry, known)| known.get(entry.keys.get(*key)?).cloned());
        stages(key, units.collect())
    };
    keys.iter().filter_map(subject).collect()
}

/// What one value of an axis changes in a stage on a GPU, against the axis's default.
#[derive(Debug, Clone, Serialize)]
pub struct Change {
    pub axis: String,
    pub value: String,
    pub gpu: &'static str,
    pub stage: Stage,
    /// Pairs of permutations that differ in the axis alone.
    pub pairs: usize,
    /// By the figure's key.
    pub figures: BTreeMap<&'static str, Spread>,
}

/// How far a figure changes over the pairs.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Spread {
    pub least: i64,
    pub median: i64,
    pub most: i64,
    /// The figure of the median permutation with the default, and with the value.
    pub before: i64,
    pub after: i64,
}

/// The changes of every value of every axis that some pair of permutations shows.
pub fn changes(axes: &[Axis], costs: &[Cost]) -> Vec<Change> {
    let mut by_place: BTreeMap<(&str, Stage), BTreeMap<&str, &Cost>> = BTreeMap::new();
    for cost in costs {
        let place = by_place.entry((cost.gpu.name, cost.stage)).or_default();
        place.insert(&cost.name, cost);
    }
    let mut changes = Vec::new();
    for axis in axes {
        for value in axis.values.iter().filter(|value| **value != axis.default) {
            for ((gpu, stage), costs) in &by_place {
                let pairs = pairs(&axis.name, value, costs);
                if pairs.is_empty() {
                    continue;
                }
                let spread = |figure: &Figure| (figure.key, Spread::over(figure, &pairs));
                changes.push(Change {
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

/// Costs of permutations with the axis's default and with the value, alike in all else.
fn pairs<'c>(
    axis: &str,
    value: &str,
    costs: &BTreeMap<&str, &'c Cost>,
) -> Vec<(&'c Cost, &'c Cost)> {
    // `true` is written as the axis alone.
    let written = if value == "true" { axis.to_owned() } else { format!("{axis}={value}") };
    let pair = |(key, with): (&&str, &&'c Cost)| {
        let parts: Vec<&str> = key.split(',').collect();
        let rest: Vec<&str> = parts.iter().copied().filter(|part| *part != written).collect();
        let without = (rest.len() < parts.len()).then(|| rest.join(","))?;
        costs.get(without.as_str()).map(|without| (*without, *with))
    };
    costs.iter().filter_map(pair).collect()
}

impl Spread {
    fn over(figure: &Figure, pairs: &[(&Cost, &Cost)]) -> Self {
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
