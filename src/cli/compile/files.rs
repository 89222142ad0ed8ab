//! The files that `compile` writes: `NAME.ENTRY.STAGE.EXTENSION`, so that no two shaders share a
//! name.

use std::collections::BTreeSet;
use std::io::Write;
use std::path::Path;

use crate::bundle::Target;
use crate::cli::failure::Failure;
use crate::cli::stream;
use crate::cli::terminal::{is_terminal, stdout, write_data};
use crate::emit::{TargetEntry, targets};
use crate::generate::CompiledShader;
use crate::output::{self, Replace};

/// An output.
pub struct OutputFile {
    pub name: String,
    binary: bool,
    bytes: Vec<u8>,
}

/// Endings of root modules, which are removed for outputs: `forward.frag.glsl` has two.
const ENDINGS: &[&str] =
    &[".wesl", ".wgsl", ".glsl", ".vert", ".frag", ".comp", ".vs", ".fs", ".cs"];

/// The name of a root module without its endings.
pub fn module_stem(file: &Path) -> String {
    if stream::is_stream(file) {
        return "stdin".to_owned();
    }
    let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let mut stem = name.as_str();
    while let Some(rest) = ENDINGS.iter().find_map(|ending| stem.strip_suffix(ending)) {
        stem = rest;
    }
    if stem.is_empty() { name } else { stem.to_owned() }
}

/// A file for each target of a shader, and one for its reflection.
pub fn files_of(
    stem: &str,
    shader: &CompiledShader,
    wanted: &[Target],
    reflection: bool,
) -> Vec<OutputFile> {
    let named = |ending: &str| format!("{stem}.{}.{ending}", shader.entry);
    let stage = shader.made.unit.reflection.stage.suffix();
    let mut files = Vec::new();
    for &target in wanted {
        let (Some(entry), Some(artifact)) =
            (targets::find(target), shader.made.unit.targets.get(target.name()))
        else {
            continue;
        };
        let name = named(&file_ending(entry, stage));
        files.push(OutputFile { name, binary: entry.binary, bytes: artifact.bytes.to_vec() });
    }
    if reflection {
        let unit = &shader.made.unit;
        let natives: serde_json::Map<String, serde_json::Value> = unit
            .targets
            .iter()
            .map(|(target, artifact)| (target.clone(), serde_json::json!(&*artifact.native)))
            .collect();
        let json = serde_json::json!({
            "entry": shader.entry, "reflection": &*unit.reflection, "targets": natives,
        });
        let name = named(&format!("{stage}.json"));
        files.push(OutputFile { name, binary: false, bytes: format!("{json:#}\n").into_bytes() });
    }
    files
}

/// The ending of a file. Files of several targets must not share a name, and GLSL files end as
/// glslang expects.
pub fn file_ending(entry: &TargetEntry, stage: &str) -> String {
    match entry.glsl {
        Some(_) => format!("{}.{stage}", entry.target),
        None => format!("{stage}.{}", entry.extension),
    }
}

/// Fails if two shaders would have the same name. Root modules in different folders may share one.
pub fn refuse_same_names(files: &[OutputFile]) -> Result<(), Failure> {
    let mut names = BTreeSet::new();
    match files.iter().find(|file| !names.insert(&file.name)) {
        Some(file) => Err(Failure::usage(format!(
            "two shaders would both be `{}`: compile them into folders of their own",
            file.name
        ))),
        None => Ok(()),
    }
}

/// Writes files into a folder, and prints their paths.
pub fn write_files(files: &[OutputFile], folder: &Path, replace: Replace) -> Result<(), Failure> {
    let named = files.iter().map(|file| (file.name.as_str(), &*file.bytes));
    output::write_folder(folder, named, replace)?;
    for file in files {
        writeln!(stdout(), "{}", folder.join(&file.name).display())?;
    }
    Ok(())
}

/// Writes text to standard output, with file names if there are several files. A single binary may
/// go there too.
pub fn print_files(files: &[OutputFile]) -> Result<(), Failure> {
    if files.iter().any(|file| file.binary) && (files.len() > 1 || is_terminal()) {
        return Err(Failure::usage("a binary target needs `-o DIR`"));
    }
    for file in files {
        if files.len() > 1 {
            writeln!(stdout(), "// ==== {}", file.name)?;
        }
        write_data(&file.bytes)?;
    }
    Ok(())
}
