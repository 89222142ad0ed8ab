//! Compilers of GLSL that read many files in one run. Most of a run with a single short file is the
//! start of the compiler.

use std::convert::Infallible;
use std::path::Path;
use std::process::{Command, Stdio};

use lamplight::tools::halve_refused;
use libtest_mimic::Failed;

use crate::examples;

/// The number of files in one run.
pub const BATCH: usize = 64;

/// The files that are refused, each with the compiler's words. A batch is halved until those at
/// fault are found.
fn refused<K: Copy>(
    batch: &[(K, String)],
    accepts_all: impl Fn(&[&str]) -> bool,
    compile: impl Fn(&str) -> Result<(), String>,
) -> Vec<(K, String)> {
    let together = |files: &[(K, String)]| {
        let paths: Vec<&str> = files.iter().map(|(_, path)| path.as_str()).collect();
        Ok::<_, Infallible>(accepts_all(&paths).then(Vec::new))
    };
    let alone = |(key, path): &(K, String)| {
        Ok(compile(path).err().map(|words| (*key, words)).into_iter().collect())
    };
    let Ok(refused) = halve_refused(batch, &together, &alone);
    refused
}

/// The files that glslc refuses to compile to SPIR-V for Vulkan. It writes its outputs to `folder`.
pub fn refused_by_glslc<K: Copy>(
    folder: &Path,
    options: &[&str],
    batch: &[(K, String)],
) -> Vec<(K, String)> {
    let compile = |paths: &[&str]| run(folder, "glslc", &[options, &["-c"], paths].concat());
    refused(batch, |paths| compile(paths).is_ok(), |path| compile(&[path]))
}

/// The files that glslangValidator refuses, all of a stage, by the rules of the version that each
/// names.
pub fn refused_by_version<K: Copy>(
    folder: &Path,
    stage: &str,
    batch: &[(K, String)],
) -> Vec<(K, String)> {
    let compile =
        |paths: &[&str]| run(folder, "glslangValidator", &[&["-S", stage], paths].concat());
    refused(batch, |paths| compile(paths).is_ok(), |path| compile(&[path]))
}

/// Options of glslangValidator for GLSL by the rules of Vulkan, which it compiles to SPIR-V.
pub const COMPILED: &[&str] = &["-V", "-o", "/dev/null"];

/// glslangValidator accepts a text of a stage.
pub fn accepts_text(text: &str, stage: &str, options: &[&str]) -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    std::fs::write(folder.path().join("text"), text)?;
    let arguments = [&["-S", stage], options, &["text"]].concat();
    run(folder.path(), "glslangValidator", &arguments)
        .map_err(|words| format!("{words}\n{text}").into())
}

/// Runs a program in a folder; fails with its words.
pub fn run(folder: &Path, tool: &str, arguments: &[&str]) -> Result<(), String> {
    let mut command = Command::new(tool);
    command.current_dir(folder).args(arguments).stdin(Stdio::null());
    let outcome = examples::run(&mut command).map(|_| ());
    outcome.map_err(|error| format!("{tool}: {}", error.message().unwrap_or_default()))
}
