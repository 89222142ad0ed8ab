//! Shaders in a folder. Tint's command says which are valid.

use std::path::{Path, PathBuf};
use std::process::Command;

use super::Program;
use xtask::CommandFailure;

/// All WGSL files below a folder, in the order of their paths.
pub fn programs(folder: &Path) -> Result<Vec<Program>, CommandFailure> {
    let files = files_below(folder, "wgsl")?;
    let read = |file: PathBuf| {
        let text = std::fs::read_to_string(&file)
            .map_err(|error| CommandFailure::input(format!("`{}`: {error}", file.display())))?;
        let expected = is_valid(&file)?;
        let name = file.strip_prefix(folder).unwrap_or(&file).display().to_string();
        Ok(Program { name, text, expected })
    };
    files.into_iter().map(read).collect()
}

/// All files below a folder whose names end so, in the order of their paths.
pub fn files_below(folder: &Path, extension: &str) -> Result<Vec<PathBuf>, CommandFailure> {
    let mut files = Vec::new();
    collect(folder, extension, &mut files)?;
    files.sort();
    Ok(files)
}

fn collect(folder: &Path, extension: &str, files: &mut Vec<PathBuf>) -> Result<(), CommandFailure> {
    let failed =
        |error: std::io::Error| CommandFailure::input(format!("`{}`: {error}", folder.display()));
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if path.is_dir() {
            collect(&path, extension, files)?;
        } else if path.extension().is_some_and(|found| found == extension) {
            files.push(path);
        }
    }
    Ok(())
}

fn is_valid(file: &Path) -> Result<bool, CommandFailure> {
    let output = Command::new("tint").args(["--format", "wgsl"]).arg(file).output();
    let output = output.map_err(|error| CommandFailure::environment(format!("`tint`: {error}")))?;
    Ok(output.status.success())
}
