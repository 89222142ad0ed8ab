//! A text has the same bytes alone as among others.

use std::collections::BTreeSet;

use lamplight::bundle::Unit;
use lamplight::diagnostic::render::{Form, render};
use lamplight::generate::{Discard, Generated, Tools, generate};
use lamplight::permute::Manifest;
use lamplight::project;
use lamplight::resolve::Packages;
use lamplight::source::SourceSet;
use libtest_mimic::Failed;

use super::{Outcome, STEP, all_linked, hashes, made, request, units};

/// Each text, compiled alone, has the same bytes, names and reflection as among all others.
pub fn agree(
    sources: &mut SourceSet,
    packages: &Packages,
    manifest: &Manifest,
    step: usize,
) -> Result<Generated, Failed> {
    let together = made(sources, packages, manifest, None)?;
    let all = units(&together);
    let keys: BTreeSet<&String> = all.keys().map(|(_, _, key)| *key).collect();
    for key in keys.into_iter().step_by(step) {
        let alone = made(sources, packages, manifest, Some(key))?;
        for (name @ (language, entry, key), unit) in units(&alone) {
            differ(unit, all[&name])
                .map_or(Ok(()), |what| Err(format!("[{key}] {language:?} {entry}: {what}")))?;
        }
    }
    Ok(together)
}

fn differ(alone: &Unit, together: &Unit) -> Option<String> {
    if alone.reflection != together.reflection {
        let (alone, together) = (&alone.reflection, &together.reflection);
        return Some(format!("reflection, alone:\n{alone:?}\ntogether:\n{together:?}"));
    }
    let differ = |target: &&String| alone.targets[*target] != together.targets[*target];
    alone.targets.keys().find(differ).map(|target| {
        let text = |unit: &Unit| String::from_utf8_lossy(&unit.targets[target].bytes).into_owned();
        format!("{target} differs, alone:\n{}\ntogether:\n{}", text(alone), text(together))
    })
}

/// Permutations of `forward` have the same bytes alone and together, and all of them are linked.
/// Their hashes are compared, since all outputs together take gigabytes of memory.
pub fn forward() -> Outcome {
    let (mut sources, mut manifest) = project::library_manifest()
        .map_err(|(sources, problems)| render(&sources, &problems, Form::Human))?;
    manifest.programs.retain(|program| program.name == "forward");
    let packages = project::library_packages();
    let together = hashed(&mut sources, &packages, &manifest, None)?;
    let all = hashes(&together);
    let keys: BTreeSet<&String> = all.keys().map(|(_, _, key)| *key).collect();
    for key in keys.into_iter().step_by(STEP) {
        let alone = hashed(&mut sources, &packages, &manifest, Some(key))?;
        if hashes(&alone).iter().any(|(name, hash)| all[name] != *hash) {
            agree(&mut sources, &packages, &manifest, STEP)?;
            return Err(format!("[{key}]: only the hashes differ").into());
        }
    }
    all_linked(&together)
}

/// As [`made`], but only with the hashes of the units.
fn hashed(
    sources: &mut SourceSet,
    packages: &Packages,
    manifest: &Manifest,
    key: Option<&str>,
) -> Result<Generated, Failed> {
    let request = request(sources, key);
    let sink = Discard::default();
    let tools =
        Tools { sink: &sink, cache: None, tool: "test", optimiser: None, progress: &|_| () };
    let made = generate(sources, packages, manifest, &request, &tools);
    Ok(made.map_err(|problems| render(sources, &problems, Form::Human))?)
}
