//! Compilers of GLSL that read many files in one run. Most of a run with a single short file is the
//! start of the compiler.

use std::path::Path;
use std::process::{Command, Stdio};

/// The number of files in one run.
pub const BATCH: usize = 64;

/// The files that are refused, each with the compiler's words. Each is judged by itself, unless all
/// are accepted in one run.
pub fn refused<K: Copy>(
    batch: &[(K, String)],
    accepts_all: impl Fn(&[&str]) -> bool,
    judge: impl Fn(&str) -> Result<(), String>,
) -> Vec<(K, String)> {
    let paths: Vec<&str> = batch.iter().map(|(_, path)| path.as_str()).collect();
    if accepts_all(&paths) {
        return Vec::new();
    }
    batch.iter().filter_map(|(key, path)| Some((*key, judge(path).err()?))).collect()
}

/// The files that glslc refuses to compile to SPIR-V for Vulkan. It writes its outputs to `folder`.
pub fn refused_by_glslc<K: Copy>(
    folder: &Path,
    options: &[&str],
    batch: &[(K, String)],
) -> Vec<(K, String)> {
    let judge = |paths: &[&str]| run(folder, "glslc", &[options, &["-c"], paths].concat());
    refused(batch, |paths| judge(paths).is_ok(), |path| judge(&[path]))
}

/// The files that glslangValidator refuses, all of a stage, by the rules of the version that each
/// names.
pub fn refused_by_version<K: Copy>(
    folder: &Path,
    stage: &str,
    batch: &[(K, String)],
) -> Vec<(K, String)> {
    let judge = |paths: &[&str]| run(folder, "glslangValidator", &[&["-S", stage], paths].concat());
    refused(batch, |paths| judge(paths).is_ok(), |path| judge(&[path]))
}

/// Runs a program in a folder; fails with its words.
pub fn run(folder: &Path, tool: &str, arguments: &[&str]) -> Result<(), String> {
    let output = Command::new(tool)
        .current_dir(folder)
        .args(arguments)
        .stdin(Stdio::null())
        .output()
        .map_err(|error| format!("`{tool}` does not start: {error}"))?;
    let said = [output.stdout, output.stderr].concat();
    match output.status.success() {
        true => Ok(()),
        false => Err(format!("{tool}: {}", String::from_utf8_lossy(&said))),
    }
}
