//! `--outputs`: what the validators of all targets say of the outputs of valid programs.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use lamplight::bundle::{Target, Unit};
use lamplight::compose::Keep;
use lamplight::generate::entry_points;
use lamplight_validate::on_large_stack;
use lamplight_validators::{Extent, Output, Refusal, Verdict, verdict};
use rayon::prelude::*;

use super::Program;
use super::compiled::{composed_wgsl, for_targets_that_can};
use super::table::general;
use crate::progress::show_progress;
use crate::validate::tint;
use xtask::CommandFailure;
use xtask::process::root;

/// The outputs of some programs, and those that are refused.
#[derive(Default)]
pub struct OutputTable {
    pub outputs: usize,
    /// By validator and message, the names of programs.
    refused: BTreeMap<String, Vec<String>>,
    /// Validators that are not here.
    missing: Vec<String>,
}

/// The units of a program, one for each entry point.
type Units = Vec<Unit>;

/// Compiles the valid ones of some programs in WGSL for every target that has what they need, and has
/// the validators look at the outputs.
pub fn tabulate(suite: &str, programs: &[Program]) -> Result<OutputTable, CommandFailure> {
    let valid: Vec<&Program> = programs.iter().filter(|program| program.expected).collect();
    let units: Vec<Units> =
        on_large_stack(|| valid.par_iter().map(|program| units_of(&program.text)).collect());
    let named = valid.iter().map(|program| program.name.clone()).zip(units);
    validate_units(suite, named)
}

fn units_of(text: &str) -> Units {
    let Ok(whole) = composed_wgsl(text, Keep::EntryPoints) else { return Vec::new() };
    let entries = entry_points(&whole).unwrap_or_default().into_iter();
    let unit_of = |entry: String| {
        let alone = composed_wgsl(text, Keep::Items(vec![entry.clone()])).ok()?;
        Some(for_targets_that_can(&alone, &entry).ok()?.unit)
    };
    entries.filter_map(|(entry, _)| unit_of(entry)).collect()
}

/// Writes the outputs and has the validators look at them.
pub fn validate_units(
    suite: &str,
    named: impl IntoIterator<Item = (String, Units)>,
) -> Result<OutputTable, CommandFailure> {
    let folder = root().join("target/conformance/outputs").join(suite);
    let failed = |error: &dyn std::fmt::Display| {
        CommandFailure::input(format!("`{}`: {error}", folder.display()))
    };
    if folder.is_dir() {
        std::fs::remove_dir_all(&folder).map_err(|error| failed(&error))?;
    }
    std::fs::create_dir_all(&folder).map_err(|error| failed(&error))?;
    let mut outputs = Vec::new();
    let mut names: BTreeMap<PathBuf, BTreeSet<String>> = BTreeMap::new();
    for (name, units) in named {
        for unit in units {
            for output in outputs_of(&unit, &folder).map_err(|error| failed(&error))? {
                names.entry(output.file.clone()).or_default().insert(name.clone());
                outputs.push(output);
            }
        }
    }
    let mut table = OutputTable { outputs: names.len(), ..OutputTable::default() };
    let progress = |done, total| show_progress("validating", done, total);
    let Verdict { validation, refusals } =
        verdict(outputs, Extent::All, None, &tint(), &progress).map_err(|error| failed(&error))?;
    table.missing = validation.missing().into_iter().map(str::to_owned).collect();
    for refusal in refusals {
        table.add(&refusal, &names);
    }
    Ok(table)
}

fn outputs_of(unit: &Unit, folder: &std::path::Path) -> Result<Vec<Output>, String> {
    let hash = unit.hash().map_err(|error| error.to_string())?;
    let mut outputs = Vec::new();
    for (target, artifact) in &unit.targets {
        let Some(target) = Target::find(target) else { continue };
        let name = blake3::hash(&artifact.bytes).to_hex();
        let file = folder.join(format!("{name}.{}", artifact.extension));
        if !file.is_file() {
            std::fs::write(&file, &artifact.bytes).map_err(|error| error.to_string())?;
        }
        let description = format!("{:?}{:?}", unit.reflection, artifact.native);
        outputs.push(Output {
            target,
            stage: unit.reflection.stage,
            entry: artifact.native.entry_name.clone(),
            file,
            unit: hash,
            reflection: unit.reflection.clone(),
            native: artifact.native.clone(),
            description: blake3::hash(description.as_bytes()).to_hex().to_string(),
        });
    }
    Ok(outputs)
}

impl OutputTable {
    fn add(&mut self, refusal: &Refusal, names: &BTreeMap<PathBuf, BTreeSet<String>>) {
        let Refusal { output, validator, message, .. } = refusal;
        let line = message.lines().next().unwrap_or_default();
        let cause = format!("{}: {validator}: {}", output.target.name(), general(line));
        let example = names.get(&output.file).and_then(|names| names.first().cloned());
        let example = format!("{} ({})", example.unwrap_or_default(), output.file.display());
        self.refused.entry(cause).or_default().push(example);
    }

    /// How many are refused.
    pub fn refused(&self) -> usize {
        self.refused.values().map(Vec::len).sum()
    }
}

impl std::fmt::Display for OutputTable {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        writeln!(to, "outputs {}, of which validators refuse {}", self.outputs, self.refused())?;
        for (cause, examples) in &self.refused {
            let example = examples.first().map_or("", String::as_str);
            writeln!(to, "{:6} {cause} ({example})", examples.len())?;
        }
        for missing in &self.missing {
            writeln!(to, "not validated: {missing}")?;
        }
        Ok(())
    }
}
