//! `cargo xtask conformance glsl DIR...`: how much of other people's GLSL compiles for all targets that
//! can express it, beside what glslang accepts of it.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use lamplight::bundle::{Language, Stage, Target};
use lamplight::compose::Composed;
use lamplight::compose::glsl::named_stage;
use lamplight::link::{Linker, TextForms, compile};

use super::compiled::is_lack;
use xtask::{CommandFailure, CommandResult};

fn usage() -> CommandFailure {
    CommandFailure::usage(
        "usage: cargo xtask conformance glsl [-I DIR]... DIR...\n\n  \
         -I DIR  where `#include` finds files, beside the folder of the file",
    )
}

/// What became of the files of a folder.
#[derive(Default)]
struct Count {
    files: usize,
    /// Files that glslang accepts.
    accepted: usize,
    /// Of these, the files that compile for every target that has what they need.
    compiled: usize,
    /// Of these, the files that compile for all targets there are.
    everywhere: usize,
    /// Files by the reason for which they do not, with an example.
    causes: BTreeMap<String, (usize, PathBuf)>,
}

/// Prints a table with a line for each folder, and then the causes of the rest.
pub fn run(arguments: &[String]) -> CommandResult {
    let (mut folders, mut includes) = (Vec::new(), Vec::new());
    let mut rest = arguments.iter();
    while let Some(argument) = rest.next() {
        match argument.as_str() {
            "-I" => includes.push(format!("-I{}", rest.next().ok_or_else(usage)?)),
            folder if !folder.starts_with('-') => folders.push(PathBuf::from(folder)),
            _ => return Err(usage()),
        }
    }
    if folders.is_empty() {
        return Err(usage());
    }
    println!("{}", glslang_version()?);
    println!(
        "| folder | files | glslang accepts | compiled for all targets that can express them | | for all targets |"
    );
    println!("|---|---|---|---|---|---|");
    let mut counts = Vec::new();
    for folder in &folders {
        let count = count_folder(folder, &includes)?;
        let part = 100.0 * count.compiled as f64 / count.accepted.max(1) as f64;
        let Count { files, accepted, compiled, everywhere, causes: _ } = &count;
        println!(
            "| {} | {files} | {accepted} | {compiled} | {part:.1} % | {everywhere} |",
            folder.display()
        );
        counts.push(count);
    }
    let mut causes: BTreeMap<String, (usize, PathBuf)> = BTreeMap::new();
    for (cause, (files, example)) in counts.into_iter().flat_map(|count| count.causes) {
        causes.entry(cause).or_insert((0, example)).0 += files;
    }
    let mut causes: Vec<_> = causes.into_iter().collect();
    causes.sort_by_key(|(cause, (files, _))| (usize::MAX - files, cause.clone()));
    println!("\n| files | cause | example |\n|---|---|---|");
    for (cause, (files, example)) in causes {
        println!("| {files} | {cause} | {} |", example.display());
    }
    Ok(())
}

fn glslang_version() -> Result<String, CommandFailure> {
    let output = Command::new("glslangValidator").arg("--version").output();
    let output = output.map_err(|error| {
        CommandFailure::environment(format!("glslangValidator (glslang-tools): {error}"))
    })?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let version = text.lines().next().unwrap_or_default().to_owned();
    Ok(format!("{version}; options: -V for texts with features of Vulkan, else none\n"))
}

fn count_folder(folder: &Path, includes: &[String]) -> Result<Count, CommandFailure> {
    let mut files = Vec::new();
    list_files(folder, &mut files)
        .map_err(|error| CommandFailure::input(format!("`{}`: {error}", folder.display())))?;
    files.sort();
    let mut count = Count::default();
    for file in files {
        let Some(stage) = named_stage(&file.to_string_lossy()) else { continue };
        count.files += 1;
        let Some(text) = accepted_text(&file, stage.suffix(), includes) else { continue };
        count.accepted += 1;
        match compiled(&text, stage) {
            Ok(lacking) => {
                count.compiled += 1;
                count.everywhere += usize::from(lacking == 0);
            }
            Err(cause) => count.causes.entry(cause).or_insert((0, file)).0 += 1,
        }
    }
    Ok(count)
}

fn list_files(folder: &Path, files: &mut Vec<PathBuf>) -> std::io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        if entry.file_type()?.is_dir() {
            list_files(&entry.path(), files)?;
        } else {
            files.push(entry.path());
        }
    }
    Ok(())
}

/// The preprocessed text of a file, if glslang accepts it.
fn accepted_text(file: &Path, stage: &str, includes: &[String]) -> Option<String> {
    let folder = format!("-I{}", file.parent()?.display());
    let glslang = |options: &[&str]| {
        let mut command = Command::new("glslangValidator");
        command.args(["-S", stage]).args(options).arg(&folder).args(includes).arg(file);
        command.stdin(Stdio::null()).output().ok().filter(|output| output.status.success())
    };
    let accepts = glslang(&[]).or_else(|| glslang(&["-V", "-o", "/dev/null"]));
    accepts?;
    let text = glslang(&["-E"])?.stdout;
    String::from_utf8(text).ok()
}

/// Compiles a text for every target, and gives the number of those that lack what it needs. The error is
/// the cause, without names.
fn compiled(text: &str, stage: Stage) -> Result<usize, String> {
    let composed = Composed::of_text(Language::Glsl, Some(stage), text.to_owned());
    let text = TextForms { composed: &composed, lean: &composed };
    let (mut made, mut lacking) = (0, String::new());
    for target in Target::ALL {
        let targets = [*target];
        match compile(&text, "main", &targets, &Linker::new(&targets)) {
            Ok(_) => made += 1,
            Err(problems) => {
                let first = problems.first().ok_or_else(String::new)?;
                if !is_lack(first) {
                    return Err(first.message.clone());
                }
                lacking = first.message.clone();
            }
        }
    }
    if made == 0 { Err(lacking) } else { Ok(Target::ALL.len() - made) }
}
