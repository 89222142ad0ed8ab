//! Writes a rule for make and ninja: the outputs, and the files that they depend on.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::cli::failure::Failure;
use crate::output::{self, HEAD_BYTES, Replace};
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
    let escaped = |path: &str, as_target| escape_for_make(path, as_target);
    let outputs: Vec<String> =
        outputs.map(|path| escaped(&path.to_string_lossy(), true)).collect::<Result<_, _>>()?;
    let inputs: Vec<String> =
        inputs.iter().map(|path| escaped(path, false)).collect::<Result<_, _>>()?;
    let inputs: String = inputs.iter().map(|path| format!(" \\\n  {path}")).collect();
    let rule = format!("{}:{inputs}\n", outputs.join(" "));
    // A file that is there may be replaced if it is a rule that this function wrote, for these or
    // for other outputs.
    let is_ours = |known: &[u8]| {
        is_rule(known) || outputs.first().is_some_and(|output| known.starts_with(output.as_bytes()))
    };
    Ok(output::write_file(path, rule.as_bytes(), is_ours, replace)?)
}

/// Whether the beginning of a file has the form of a rule from here: the outputs on the first line,
/// then one file on each line, and no recipe.
fn is_rule(head: &[u8]) -> bool {
    let is_cut = head.len() >= HEAD_BYTES;
    let mut lines: Vec<&[u8]> = head.split(|byte| *byte == b'\n').collect();
    // What follows the last line end is empty, or a line that is cut.
    let rest = lines.pop();
    let Some((first, inputs)) = lines.split_first() else { return false };
    let Some((last, others)) = inputs.split_last() else { return false };
    let continues = |line: &&[u8]| line.starts_with(b"  ") && line.ends_with(b" \\");
    first.ends_with(b": \\")
        && others.iter().all(continues)
        && last.starts_with(b"  ")
        && (is_cut || (!last.ends_with(b" \\") && rest.is_some_and(<[u8]>::is_empty)))
}

/// A name in the syntax of make, which ninja reads too. A line end in a name would begin a rule of
/// its own, and make has no way to write one.
///
/// Make removes a backslash only before a letter that has a meaning there, and `%` has one only in a
/// target. Ninja keeps the backslashes before `%`, `;` and `?`: it has no form for them.
fn escape_for_make(path: &str, as_target: bool) -> Result<String, Failure> {
    if path.contains(['\n', '\r']) {
        return Err(Failure::input(format!(
            "the file name {path:?} has a line end, which a rule for make cannot hold"
        )));
    }
    if as_target && path.contains(';') {
        return Err(Failure::input(format!(
            "the name {path:?} has a `;`, which a rule for make cannot hold before its colon"
        )));
    }
    let is_special = |letter: char| {
        matches!(letter, ' ' | '\t' | '#' | ':' | ';' | '*' | '?' | '[')
            || as_target && letter == '%'
    };
    let mut text = String::with_capacity(path.len());
    // Backslashes that were written since the last other letter. They are doubled before a
    // backslash that escapes.
    let mut backslashes = 0;
    for letter in path.chars() {
        if is_special(letter) {
            text.extend(std::iter::repeat_n('\\', backslashes + 1));
        }
        backslashes = if letter == '\\' { backslashes + 1 } else { 0 };
        match letter {
            '$' => text.push_str("$$"),
            _ => text.push(letter),
        }
    }
    // The blank or the colon after the name must not be escaped.
    text.extend(std::iter::repeat_n('\\', backslashes));
    Ok(text)
}
