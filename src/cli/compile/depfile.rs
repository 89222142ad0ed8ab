//! Writes a rule for make and ninja: the outputs, and the files that they depend on.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::cli::failure::Failure;
use crate::output::{self, Replace};
use crate::source::SourceSet;

/// Writes the rule. The library is part of this program, so it is not listed.
pub fn write_depfile(
    path: &Path,
    outputs: impl Iterator<Item = PathBuf>,
    sources: &SourceSet,
    replace: Replace,
) -> Result<(), Failure> {
    let inputs: BTreeSet<&str> = sources
        .iter()
        .filter(|(_, source)| source.on_disk)
        .map(|(_, source)| source.path.as_str())
        .collect();
    let outputs: Vec<String> =
        outputs.map(|path| escape_for_make(&path.to_string_lossy())).collect::<Result<_, _>>()?;
    let inputs: Vec<String> =
        inputs.iter().map(|path| escape_for_make(path)).collect::<Result<_, _>>()?;
    let inputs: String = inputs.iter().map(|path| format!(" \\\n  {path}")).collect();
    let rule = format!("{}:{inputs}\n", outputs.join(" "));
    // A file that is there may be replaced if it is a rule for the same outputs.
    let is_ours =
        |known: &[u8]| outputs.first().is_some_and(|output| known.starts_with(output.as_bytes()));
    Ok(output::write_file(path, rule.as_bytes(), is_ours, replace)?)
}

/// A name in the syntax of make. A line end in a name would begin a rule of its own, and make has
/// no way to write one.
fn escape_for_make(path: &str) -> Result<String, Failure> {
    if path.contains(['\n', '\r']) {
        return Err(Failure::input(format!(
            "the file name {path:?} has a line end, which a rule for make cannot hold"
        )));
    }
    let mut text = String::with_capacity(path.len());
    for letter in path.chars() {
        match letter {
            ' ' | '#' | '\\' => text.extend(['\\', letter]),
            '$' => text.push_str("$$"),
            _ => text.push(letter),
        }
    }
    Ok(text)
}
