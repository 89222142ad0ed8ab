//! Shaders of `naga_oil` beside what `lamplight migrate` makes of them: both composers compose each
//! root for the same shader defs, and naga says whether the modules are the same.
//!
//! `cargo xtask bench migrate DIR`, where DIR has the `.wgsl` files of the packages side by side.
//! With `FILE` behind it, what `naga_oil` makes of `main.wgsl` is recorded for the tests.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::error::Error;
use std::path::Path;

use lamplight::migrate::{self, Migrated};
use lamplight::resolve::Packages;
use lamplight::source::{Disk, Files, SourceSet};
use naga_oil::compose::{
    ComposableModuleDescriptor, Composer, NagaModuleDescriptor, ShaderDefValue,
};

use crate::Outcome;
use crate::alike::{VALUE, choices, fingerprint, normalised, ours, packages, prefixes, validator};

/// Random choices of shader defs for each root, besides the choice that turns none on.
const CHOICES: usize = 24;

/// Prints how many files are migrated, composed, and the same.
pub fn run() -> Outcome {
    let folder = std::env::args().nth(2).ok_or("usage: cargo xtask bench migrate DIR")?;
    let files = read(Path::new(&folder))?;
    let mut sources = SourceSet::default();
    let added: Vec<_> = files
        .iter()
        .map(|(path, text)| (path.clone(), sources.add(path.as_str(), text.as_str())))
        .collect();
    let migrated = migrate::naga_oil(&sources, &added);
    println!("migrated: {} of {} files", migrated.files.len(), files.len());
    if let Some(file) = std::env::args().nth(3) {
        return record(&files, &migrated, &file);
    }
    let packages = packages(&migrated);
    let (mut counts, mut reasons) = (Counts::default(), BTreeMap::new());
    let mut composer = modules(&files);
    let roots = files.iter().filter(|(_, text)| has_entry(text));
    for (path, text) in roots {
        let mut same = Counts::default();
        for choice in 0..=CHOICES {
            let defs = defs(&migrated, text, choice);
            let outcome = one(&mut composer, &packages, path, text, &migrated, &defs);
            if let Outcomes::Other(why) | Outcomes::NotComposed(why) = &outcome {
                reasons.entry(path.clone()).or_insert_with(|| why.clone());
            }
            same.add(&outcome);
        }
        counts.roots += 1;
        counts.whole += usize::from(same.other + same.failed == 0 && same.same > 0);
        counts.unknown += usize::from(same.same + same.other + same.failed == 0);
        counts.same += same.same;
        counts.other += same.other;
        counts.failed += same.failed;
        counts.refused += same.refused;
    }
    for (path, why) in &reasons {
        println!("{path}: {why}");
    }
    println!("{counts:#?}");
    Ok(())
}

#[derive(Debug, Default)]
struct Counts {
    /// Files with an entry point.
    roots: usize,
    /// Roots that are the same for all choices that `naga_oil` composes.
    whole: usize,
    /// Roots that `naga_oil` composes for no choice.
    unknown: usize,
    /// Choices for which both composers make the same module.
    same: usize,
    /// Choices for which the modules differ.
    other: usize,
    /// Choices that only `naga_oil` composes, from the original.
    failed: usize,
    /// Choices that `naga_oil` or naga refuses in the original.
    refused: usize,
}

impl Counts {
    fn add(&mut self, outcome: &Outcomes) {
        match outcome {
            Outcomes::Same => self.same += 1,
            Outcomes::Other(_) => self.other += 1,
            Outcomes::NotComposed(_) => self.failed += 1,
            Outcomes::Refused => self.refused += 1,
        }
    }
}

enum Outcomes {
    Same,
    Other(String),
    NotComposed(String),
    Refused,
}

fn read(folder: &Path) -> Result<BTreeMap<String, String>, Box<dyn Error>> {
    let disk = Disk::new(folder)?;
    let mut files = BTreeMap::new();
    for path in disk.list(&["wgsl"]) {
        let text = disk.read(&path).map_err(|error| format!("{path}: {error:?}"))?;
        files.insert(path, text.ok_or("a file went away")?);
    }
    Ok(files)
}

fn has_entry(text: &str) -> bool {
    ["@vertex", "@fragment", "@compute"].iter().any(|entry| text.contains(entry))
}

/// The shader defs of a choice. Choice 0 turns none on; others turn on random ones, odd choices
/// only ones that the text names.
fn defs(migrated: &Migrated, text: &str, choice: usize) -> BTreeMap<String, bool> {
    let mut state = (choice as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ text.len() as u64;
    let mut random = move |bound: u64| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) % bound
    };
    let density = [0, 2, 4, 12][choice.min(1) + choice % 3];
    let mut one = |name: &String| {
        let is_own = text.contains(name.as_str());
        let on = density > 0 && random(if is_own { 2 } else { density }) == 0;
        (name.clone(), choice > 0 && on && (is_own || choice.is_multiple_of(2)))
    };
    migrated.features.iter().map(&mut one).collect()
}

fn one(
    composer: &mut Composer,
    packages: &Packages,
    path: &str,
    text: &str,
    migrated: &Migrated,
    defs: &BTreeMap<String, bool>,
) -> Outcomes {
    let Some(theirs) = original(composer, path, text, migrated, defs) else {
        return Outcomes::Refused;
    };
    let ours = match ours(packages, path, migrated, text, defs) {
        Ok(ours) => ours,
        Err(why) => return Outcomes::NotComposed(why),
    };
    let prefixes = prefixes(migrated);
    let (theirs, ours) = (normalised(theirs, &prefixes), normalised(ours, &prefixes));
    match theirs.symmetric_difference(&ours).next() {
        None => Outcomes::Same,
        Some(_) => {
            let only = |one: &BTreeSet<String>, other: &BTreeSet<String>| {
                one.difference(other).take(2).cloned().collect::<Vec<_>>().join("\n")
            };
            Outcomes::Other(format!(
                "differs\n--- naga_oil\n{}\n--- lamplight\n{}",
                only(&theirs, &ours),
                only(&ours, &theirs)
            ))
        }
    }
}

fn is_module(text: &str) -> bool {
    text.contains("#define_import_path")
}

/// A composer of `naga_oil` with all modules. Each is added once those that it imports have been
/// added.
fn modules(files: &BTreeMap<String, String>) -> Composer {
    let mut composer = Composer::non_validating();
    composer.capabilities = naga::valid::Capabilities::all();
    let mut left: Vec<(&String, &String)> =
        files.iter().filter(|(_, text)| is_module(text)).collect();
    let mut names = BTreeSet::new();
    // Of two files with one path the first counts, as it does for `migrate`.
    left.retain(|(_, text)| {
        names.insert(
            text.split("#define_import_path")
                .nth(1)
                .map(|rest| rest.split_whitespace().next().unwrap_or_default().to_owned()),
        )
    });
    loop {
        let before = left.len();
        left.retain(|(path, source)| {
            let descriptor =
                ComposableModuleDescriptor { source, file_path: path, ..Default::default() };
            composer.add_composable_module(descriptor).is_err()
        });
        if left.is_empty() || left.len() == before {
            return composer;
        }
    }
}

fn original(
    composer: &mut Composer,
    path: &str,
    text: &str,
    migrated: &Migrated,
    defs: &BTreeMap<String, bool>,
) -> Option<naga::Module> {
    let on = defs.iter().filter(|(_, on)| **on);
    let mut shader_defs: HashMap<String, ShaderDefValue> =
        on.map(|(name, _)| (name.clone(), ShaderDefValue::Bool(true))).collect();
    for name in migrated.constants.iter().chain(&migrated.numbers) {
        if defs.get(name).copied().unwrap_or(true) {
            shader_defs.insert(name.clone(), ShaderDefValue::UInt(VALUE));
        }
    }
    let made = composer.make_naga_module(NagaModuleDescriptor {
        source: text,
        file_path: path,
        shader_defs,
        ..Default::default()
    });
    let module = made.ok()?;
    validator().validate(&module).ok()?;
    Some(module)
}

/// What `naga_oil` makes of `main.wgsl` for every choice, which the tests compare with.
fn record(files: &BTreeMap<String, String>, migrated: &Migrated, file: &str) -> Outcome {
    let (mut composer, prefixes) = (modules(files), prefixes(migrated));
    let mut lines = String::new();
    for defs in choices(migrated) {
        let text = files.get("main.wgsl").ok_or("there is no `main.wgsl`")?;
        let made = original(&mut composer, "main.wgsl", text, migrated, &defs);
        let made = made.ok_or_else(|| format!("naga_oil refuses {defs:?}"))?;
        let on: Vec<&str> =
            defs.iter().filter(|(_, on)| **on).map(|(name, _)| name.as_str()).collect();
        let fingerprint = fingerprint(&normalised(made, &prefixes));
        lines += &format!("{fingerprint} {}\n", on.join(","));
    }
    Ok(std::fs::write(file, lines)?)
}
