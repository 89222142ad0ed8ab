//! External validators accept the composed texts and the outputs of programs.

use std::collections::BTreeMap;
use std::path::Path;

use lamplight::bundle::{Language, Target};
use lamplight::compose::Composed;
use lamplight::emit::{emit, targets};
use lamplight::permute::manifest::Program;
use lamplight::permute::{Assignment, cover};
use lamplight::validate::on_large_stack;
use libtest_mimic::Failed;
use rayon::prelude::*;

use super::{Sources, alone, report, texts};
use crate::glslang::{BATCH, refused_by_glslc, refused_by_version, run};

/// glslc compiles the composed GLSL of every permutation that ships.
pub fn glslc_takes_sources(
    program: &Program,
    stage: &(&'static str, &'static str, &'static str),
) -> Result<(), Failed> {
    let sources = Sources::new(program, stage)?;
    let folder = tempfile::tempdir()?;
    let [_, (_, compose)] = sources.languages();
    let texts = texts(program, &sources.texts, &program.space.enumerate(), &*compose)?;
    let mut files = Vec::new();
    for (index, (composed, point)) in texts.composed.iter().enumerate() {
        let path =
            folder.path().join(format!("{index}.{}", stage.2)).to_string_lossy().into_owned();
        std::fs::write(&path, &composed.text)?;
        files.push((point, path));
    }
    let batches = files.par_chunks(BATCH);
    let refused = batches.flat_map_iter(|batch| refused_by_glslc(folder.path(), &[], batch));
    report(program, refused.collect())
}

/// A file, and the permutation that it is of.
type FileOf<'p> = (&'p Assignment, String);

/// spirv-val and glslangValidator accept the outputs of the covering set. glslc compiles the GLSL
/// sources from which they were made.
pub fn validators(
    program: &Program,
    stage: &(&'static str, &'static str, &'static str),
) -> Result<(), Failed> {
    let sources = Sources::new(program, stage)?;
    let folder = tempfile::tempdir()?;
    for (entry, compose) in sources.languages() {
        let texts =
            texts(program, &sources.texts, &cover::pairwise(&program.space).points, &*compose)?;
        let write = |(index, (composed, point)): (usize, &'_ (Composed, Assignment))| {
            let prefix = folder.path().join(format!("{entry}{index}"));
            (point.clone(), write_outputs(composed, entry, stage.2, &prefix))
        };
        let written: Vec<_> =
            on_large_stack(|| texts.composed.par_iter().enumerate().map(write).collect());
        let mut failures = Vec::new();
        let mut files: BTreeMap<&str, Vec<FileOf<'_>>> = BTreeMap::new();
        for (point, outputs) in &written {
            match outputs {
                Ok(outputs) => outputs.iter().for_each(|(rule, path)| {
                    files.entry(rule).or_default().push((point, path.clone()));
                }),
                Err(what) => failures.push((point, what.clone())),
            }
        }
        let batches =
            files.iter().flat_map(|(rule, files)| files.chunks(BATCH).map(|batch| (*rule, batch)));
        let batches: Vec<_> = batches.collect();
        failures.par_extend(batches.into_par_iter().flat_map_iter(|(rule, batch)| match rule {
            SOURCES => refused_by_glslc(folder.path(), &[], batch),
            _ => refused_by_version(folder.path(), stage.2, batch),
        }));
        report(program, failures)?;
    }
    Ok(())
}

/// The name of the GLSL sources among the rules.
const SOURCES: &str = "sources";

/// Writes the outputs of a text, has spirv-val validate the SPIR-V, and returns the files of GLSL,
/// each with a name for the rules by which it is validated.
fn write_outputs(
    composed: &Composed,
    entry: &str,
    extension: &str,
    prefix: &Path,
) -> Result<Vec<(String, String)>, String> {
    let alone = alone(composed, entry).map_err(|problems| problems[0].message.clone())?;
    let write = |target: Target, extension: &str| -> Result<String, String> {
        let path = prefix.with_extension(format!("{target}.{extension}"));
        let emitted = emit(&alone, entry, target).map_err(|problem| problem.message)?;
        std::fs::write(&path, emitted.bytes).map_err(|error| error.to_string())?;
        Ok(path.to_string_lossy().into_owned())
    };
    let spirv = write(Target::SPIRV, "spv")?;
    run(Path::new("."), "spirv-val", &["--target-env", "vulkan1.1", &spirv])?;
    let mut files = Vec::new();
    if composed.language == Language::Glsl {
        files.push((SOURCES.to_owned(), save(&composed.text, prefix, "source", extension)?));
    }
    for entry in targets::ALL.iter().filter(|entry| entry.glsl.is_some()) {
        let path = write(entry.target, extension)?;
        files.push((entry.target.to_string(), path.clone()));
        // Engines use the text for ES 3.00 with later versions of ES too, so it must be valid
        // there.
        let is_version = |rule: &&&str| rule.starts_with(|first: char| first.is_ascii_digit());
        for version in entry.validation.rules.iter().filter(is_version) {
            let text = std::fs::read_to_string(&path).map_err(|error| error.to_string())?;
            let (_, rest) = text.split_once('\n').ok_or("the text has one line")?;
            let text = format!("#version {version}\n{rest}");
            let name = format!("{}.{}", entry.target, version.replace(' ', "_"));
            files.push((name.clone(), save(&text, prefix, &name, extension)?));
        }
    }
    Ok(files)
}

fn save(text: &str, prefix: &Path, name: &str, extension: &str) -> Result<String, String> {
    let path = prefix.with_extension(format!("{name}.{extension}"));
    std::fs::write(&path, text).map_err(|error| error.to_string())?;
    Ok(path.to_string_lossy().into_owned())
}
