//! A value of an axis of one of the library's programs.

use super::{Kind, Made, Repository, check_name, refuse_rest};

pub const KIND: Kind =
    Kind { name: "axis-value", example: &["forward::fog=height"], rest: "", make };

const MANIFEST: &str = "shaderlib/lamplight.toml";
const LOCK: &str = "shaderlib/lamplight.lock";
const PICTURES: &str = "shaderlib/pictures.toml";

fn make(repository: &Repository<'_>, text: &str, rest: &[&str]) -> Result<Made, String> {
    refuse_rest(rest)?;
    let parsed = text.split_once("::").and_then(|(program, rest)| {
        let (axis, value) = rest.split_once('=')?;
        Some((program, axis, value))
    });
    let (program, axis, value) =
        parsed.ok_or_else(|| format!("`{text}` is not a value of an axis: PROGRAM::AXIS=VALUE"))?;
    [program, axis, value].iter().try_for_each(|name| check_name(name, '_'))?;
    let table = format!("[program.{program}.axis.{axis}]\n");
    let manifest = in_manifest(&repository.read(MANIFEST)?, &table, value)?;
    let lock = in_lock(&repository.read(LOCK)?, &format!("{program} {axis} "), value)?;
    let mut files = vec![(MANIFEST.to_owned(), manifest), (LOCK.to_owned(), lock)];
    let pictures = repository.read(PICTURES)?;
    if pictures.contains(&table) {
        files.push((PICTURES.to_owned(), with_row(&pictures, &table, &format!("{value} = {{}}"))));
    }
    let constant = format!("{axis}_{value}").to_uppercase();
    let next = vec![
        format!(
            "shaderlib/programs/: `@if({axis} == {value})` in WESL and `#if {} == {constant}` in GLSL (trial library::values_have_effect)",
            axis.to_uppercase()
        ),
        format!("{PICTURES}: what a picture takes from `{value}`, if it is more than nothing"),
        format!("{MANIFEST}: a slice or a key that ships the value, where no `*` does"),
        "INSTA_UPDATE=always cargo xtask test library::hashes; read the difference".to_owned(),
        "cargo xtask docs".to_owned(),
    ];
    Ok(Made { files, next })
}

/// The value at the end of the axis's list.
fn in_manifest(text: &str, table: &str, value: &str) -> Result<String, String> {
    let name = table.trim();
    let start = text.find(table).ok_or_else(|| format!("`{MANIFEST}` has no `{name}`"))?;
    let list = text[start..]
        .find("\nvalues = [\"")
        .map(|at| start + at)
        .filter(|at| !text[start + 1..*at].contains("\n["))
        .ok_or_else(|| format!("`{name}` has no list of names"))?;
    let end = list + text[list..].find(']').ok_or_else(|| format!("`{name}` has no `]`"))?;
    if text[list..end].contains(&format!("\"{value}\"")) {
        return Err(format!("`{name}` has the value `{value}` already"));
    }
    Ok(format!("{}, \"{value}\"{}", &text[..end], &text[end..]))
}

/// Appends a line of its own, since lines of the lock file never change.
fn in_lock(text: &str, line: &str, value: &str) -> Result<String, String> {
    match text.lines().any(|known| known.starts_with(line)) {
        true => Ok(format!("{text}{line}+ {value}\n")),
        false => Err(format!("`{LOCK}` has no line `{}`", line.trim())),
    }
}

/// A row at the end of a table.
fn with_row(text: &str, table: &str, row: &str) -> String {
    let start = text.find(table).map_or(text.len(), |at| at + table.len());
    let rows = text[start..].find("\n[").map_or(text.len(), |at| start + at);
    let (before, after) = text.split_at(rows);
    format!("{}\n{row}\n{after}", before.trim_end())
}
