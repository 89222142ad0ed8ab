//! A value of an axis of one of the library's programs.

use lamplight::permute::manifest;
use lamplight::source::SourceSet;

use super::{Kind, Made, Repository, check_name, refuse_rest};

pub const KIND: Kind =
    Kind { name: "axis-value", example: &["forward::fog=layered"], rest: "", make };

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
    let (manifest, ships) = shipping(manifest, program, &format!("{axis}={value}"))?;
    let lock = in_lock(&repository.read(LOCK)?, &format!("{program} {axis} "), value)?;
    let mut files = vec![(MANIFEST.to_owned(), manifest), (LOCK.to_owned(), lock)];
    let pictures = repository.read(PICTURES)?;
    if pictures.contains(&table) {
        files.push((PICTURES.to_owned(), with_row(&pictures, &table, value)));
    }
    let constant = format!("{axis}_{value}").to_uppercase();
    let next = vec![
        format!(
            "shaderlib/programs/: `@if({axis} == {value})` in WESL and `#if {} == {constant}` in GLSL (trial library::values_have_effect)",
            axis.to_uppercase()
        ),
        format!(
            "{PICTURES}: what a picture takes from `{value}`; its row is a copy of the last one"
        ),
        format!("{MANIFEST}: {ships}; `doc` of the axis, if it describes values"),
        "cargo xtask record library:: _budget; read the difference".to_owned(),
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

/// The manifest in which some permutation with the setting ships, and how many do. Where no slice has
/// it, one permutation with it is included.
fn shipping(text: String, program: &str, setting: &str) -> Result<(String, String), String> {
    let shipped = shipped_keys(&text, program)?;
    let has = |keys: &[String]| keys.iter().filter(|key| has_setting(key, setting)).count();
    let (all, with) = (shipped.len(), has(&shipped));
    if with > 0 {
        let said = format!(
            "complete; {with} of {all} permutations that ship have `{setting}`, by slices with `*`"
        );
        return Ok((text, said));
    }
    // The setting alone, or else beside those that another value of the axis needs.
    let axis = setting.split('=').next().unwrap_or_default();
    let alike =
        shipped.iter().filter(|key| key.split(',').any(|one| one.split('=').next() == Some(axis)));
    let keys =
        std::iter::once(setting.to_owned()).chain(alike.map(|key| with_setting(key, setting)));
    for key in keys.take(TRIED) {
        let included = in_include(&text, program, &key)?;
        if shipped_keys(&included, program).is_ok_and(|keys| has(&keys) > 0) {
            let said = format!(
                "complete; no slice has `{setting}`, so `include` has `{key}` now; a slice would ship more"
            );
            return Ok((included, said));
        }
    }
    Ok((text, format!("no permutation with `{setting}` ships yet: add it to a slice")))
}

/// How many keys are tried.
const TRIED: usize = 20;

/// The keys of the permutations that ship.
fn shipped_keys(text: &str, program: &str) -> Result<Vec<String>, String> {
    let mut sources = SourceSet::default();
    let id = sources.add(MANIFEST, text);
    let manifest = manifest::parse(&sources, id).map_err(|errors| {
        errors.first().map_or(String::new(), |error| format!("`{MANIFEST}`: {}", error.message))
    })?;
    let program = manifest.program(program).ok_or_else(|| format!("no program `{program}`"))?;
    let space = &program.space;
    Ok(space.enumerate().iter().map(|point| space.key(point).to_string()).collect())
}

fn has_setting(key: &str, setting: &str) -> bool {
    key.split(',').any(|one| one == setting)
}

/// The key with a setting in place of the axis's own, its axes in order.
fn with_setting(key: &str, setting: &str) -> String {
    let axis = |one: &str| one.split('=').next().unwrap_or_default().to_owned();
    let rest = key.split(',').filter(|one| axis(one) != axis(setting));
    let mut settings: Vec<&str> = rest.chain([setting]).collect();
    settings.sort_by_key(|one| axis(one));
    settings.join(",")
}

/// The manifest in which a program includes one more key.
fn in_include(text: &str, program: &str, key: &str) -> Result<String, String> {
    let table = format!("[program.{program}]\n");
    let start = text.find(&table).ok_or_else(|| format!("`{MANIFEST}` has no `{table}`"))?;
    let end = text[start..].find("\n\n[").map_or(text.len(), |at| start + at);
    let row = format!("    \"{key}\",\n");
    let list = text[start..end].find("\ninclude = [\n").map(|at| start + at);
    Ok(match list {
        Some(list) => {
            let close = list + text[list..].find("\n]").map_or(0, |at| at + 1);
            format!("{}{row}{}", &text[..close], &text[close..])
        }
        None => format!("{}\ninclude = [\n{row}]{}", &text[..end], &text[end..]),
    })
}

/// Appends a line of its own, since lines of the lock file never change.
fn in_lock(text: &str, line: &str, value: &str) -> Result<String, String> {
    match text.lines().any(|known| known.starts_with(line)) {
        true => Ok(format!("{text}{line}+ {value}\n")),
        false => Err(format!("`{LOCK}` has no line `{}`", line.trim())),
    }
}

/// A row at the end of a table, which says of the value what the last row says of its own.
fn with_row(text: &str, table: &str, value: &str) -> String {
    let start = text.find(table).map_or(text.len(), |at| at + table.len());
    let rows = text[start..].find("\n[").map_or(text.len(), |at| start + at);
    let (before, after) = text.split_at(rows);
    let last = before[start..].trim_end().lines().next_back();
    let said = last.and_then(|row| row.split_once(" = ")).map_or("{}", |(_, said)| said);
    format!("{}\n{value} = {said}\n{after}", before.trim_end())
}
