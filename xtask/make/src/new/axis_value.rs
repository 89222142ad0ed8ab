//! A value of an axis of one of the library's programs.

use lamplight::bundle::key;
use lamplight::permute::{Manifest, manifest};
use lamplight::source::SourceSet;

use super::axis_places::{program_files, testing_lines};
use super::{NewFiles, Repository, TaskKind, check_name};

pub const KIND: TaskKind = TaskKind {
    name: "axis-value",
    example: &["forward::fog=layered"],
    rest: "['`layered` is fog in layers.']",
    make,
};

const MANIFEST: &str = "shaderlib/lamplight.toml";
const LOCK: &str = "shaderlib/lamplight.lock";
const PICTURES: &str = "shaderlib/pictures.toml";

/// A value, the axis and the program.
struct NamedValue<'n> {
    program: &'n str,
    axis: &'n str,
    value: &'n str,
}

impl<'n> NamedValue<'n> {
    fn read(text: &'n str) -> Result<Self, String> {
        let parsed = text.split_once("::").and_then(|(program, rest)| {
            let (axis, value) = rest.split_once('=')?;
            Some(Self { program, axis, value })
        });
        let named = parsed
            .ok_or_else(|| format!("`{text}` is not a value of an axis: PROGRAM::AXIS=VALUE"))?;
        let Self { program, axis, value } = named;
        [program, axis, value].iter().try_for_each(|name| check_name(name, '_'))?;
        Ok(named)
    }
}

fn make(repository: &Repository<'_>, text: &str, rest: &[&str]) -> Result<NewFiles, String> {
    let sentence = match rest {
        [] => None,
        [sentence] => Some(*sentence),
        _ => return Err("after the value: a sentence for `doc` of the axis, or nothing".to_owned()),
    };
    let named = NamedValue::read(text)?;
    let NamedValue { program, axis, value } = named;
    let table = format!("[program.{program}.axis.{axis}]\n");
    let old = repository.read(MANIFEST)?;
    let text = in_manifest(&old, &table, value)?;
    let text = sentence.map_or(Ok(text.clone()), |sentence| in_doc(&text, &table, sentence))?;
    let (text, ships) = shipping(text, program, axis, value)?;
    let lock = in_lock(&repository.read(LOCK)?, &format!("{program} {axis} "), value)?;
    let mut files = vec![(MANIFEST.to_owned(), text), (LOCK.to_owned(), lock)];
    let pictures = repository.read(PICTURES)?;
    let has_pictures = pictures.contains(&table);
    let with_row = if has_pictures { with_row(&pictures, &table, value) } else { String::new() };
    let row = with_row.lines().find(|line| !pictures.lines().any(|old| old == *line));
    let row = row.unwrap_or_default().to_owned();
    if has_pictures {
        files.push((PICTURES.to_owned(), with_row));
    }
    let places = AxisPlaces::find(repository, &read_manifest(&old)?, &named)?;
    let mut next = places.steps(&named);
    if has_pictures {
        next.push(format!(
            "{PICTURES}: what a picture takes from `{value}`; its row is a copy of the last one: `{row}`"
        ));
    }
    next.push(match sentence {
        Some(_) => format!("{MANIFEST}: {ships}"),
        None => format!("{MANIFEST}: {ships}; `doc` of the axis, if it describes values"),
    });
    next.push("cargo xtask record library:: _budget; read the difference".to_owned());
    next.push("cargo xtask docs".to_owned());
    Ok(NewFiles { files, next })
}

/// Where a program tests the axis.
struct AxisPlaces {
    /// Lines that test the axis, with their places.
    lines: Vec<String>,
    /// Other programs that test an axis of this name in the same files.
    sharing: Vec<String>,
}

impl AxisPlaces {
    fn find(
        repository: &Repository<'_>,
        manifest: &Manifest,
        NamedValue { program, axis, value: _ }: &NamedValue<'_>,
    ) -> Result<Self, String> {
        let mut found = Self { lines: Vec::new(), sharing: Vec::new() };
        let mut testing = Vec::new();
        for (path, text) in program_files(repository, manifest, program)? {
            let lines = testing_lines(&path, &text, axis);
            if !lines.is_empty() {
                testing.push(path.clone());
            }
            found.lines.extend(lines);
        }
        let others = manifest.programs.iter().filter(|other| other.name != *program);
        for other in others.filter(|other| other.space.axis(axis).is_some()) {
            let files = program_files(repository, manifest, &other.name)?;
            if files.iter().any(|(path, _)| testing.contains(path)) {
                found.sharing.push(other.name.clone());
            }
        }
        Ok(found)
    }

    fn steps(&self, NamedValue { axis, value, .. }: &NamedValue<'_>) -> Vec<String> {
        let mut steps = vec![format!(
            "the effect, `@if({axis} == {value})`, with an import of what it calls (test library::values_have_effect); what a branch uses may have a condition of its own, and an `@else` takes the new value too; these lines test the axis:"
        )];
        steps.extend(self.lines.iter().map(|line| format!("  {line}")));
        steps.push("comments of uniform fields that list values".to_owned());
        steps.extend(self.sharing.iter().map(|other| {
            format!("`{other}` has the axis too, and shares files: cargo xtask new axis-value {other}::{axis}={value}, if it has not the value yet")
        }));
        steps
    }
}

/// The value at the end of the axis's list.
fn in_manifest(text: &str, table: &str, value: &str) -> Result<String, String> {
    let name = table.trim();
    let start = text.find(table).ok_or_else(|| format!("`{MANIFEST}` has no `{name}`"))?;
    let list = text[start..]
        .find("\nvalues = [\"")
        .map(|at| start + at)
        .filter(|at| !text[start + 1..*at].contains("\n["))
        .ok_or_else(|| {
            format!("`{name}` has no list of names: values of a boolean axis are fixed, and a number is added to `values` by hand, with a line in `{LOCK}`")
        })?;
    let end = list + text[list..].find(']').ok_or_else(|| format!("`{name}` has no `]`"))?;
    if text[list..end].contains(&format!("\"{value}\"")) {
        return Err(format!("`{name}` has the value `{value}` already"));
    }
    Ok(format!("{}, \"{value}\"{}", &text[..end], &text[end..]))
}

/// The manifest with a sentence at the end of the axis's description.
fn in_doc(text: &str, table: &str, sentence: &str) -> Result<String, String> {
    let sentence = sentence.trim();
    if sentence.contains(['"', '\\', '\n']) {
        return Err(format!("`{sentence}` must do without quotes and backslashes"));
    }
    let start = text.find(table).map_or(text.len(), |at| at + table.len());
    let (before, after) = text.split_at(start);
    let Some(rest) = after.strip_prefix("doc = \"") else {
        return Ok(format!("{before}doc = \"{sentence}\"\n{after}"));
    };
    let end = rest.find("\"\n").ok_or("the description of the axis does not end in its line")?;
    let (doc, after) = rest.split_at(end);
    Ok(format!("{before}doc = \"{doc} {sentence}{after}"))
}

/// The manifest in which some permutation with the value ships, and how many do. Where no slice has
/// it, one permutation with it is included.
fn shipping(
    text: String,
    program: &str,
    axis: &str,
    value: &str,
) -> Result<(String, String), String> {
    let setting = key::write([(axis, value)]);
    let shipped = shipped_keys(&text, program)?;
    let has = |keys: &[String]| keys.iter().filter(|key| key::has_value(key, axis, value)).count();
    let (all, with) = (shipped.len(), has(&shipped));
    if with > 0 {
        let message = format!(
            "complete; {with} of {all} permutations that ship have `{setting}`, by slices with `*`"
        );
        return Ok((text, message));
    }
    // The setting alone, or else with the other settings of a shipped key that chooses another
    // value of the axis.
    let alike = shipped.iter().filter(|key| key::parts(key).any(|part| part.axis.text == axis));
    let with_value = |key: &String| {
        let others = key::parts(key).filter(|part| part.axis.text != axis);
        key::write(others.map(|part| (part.axis.text, part.chosen())).chain([(axis, value)]))
    };
    let keys = std::iter::once(setting.clone()).chain(alike.map(with_value));
    for key in keys.take(TRIED) {
        let included = in_include(&text, program, &key)?;
        if shipped_keys(&included, program).is_ok_and(|keys| has(&keys) > 0) {
            let message = format!(
                "complete; no slice has `{setting}`, so `include` has `{key}` now; a slice would ship more"
            );
            return Ok((included, message));
        }
    }
    Ok((text, format!("no permutation with `{setting}` ships yet: add it to a slice")))
}

/// The most keys that are tried.
const TRIED: usize = 20;

fn read_manifest(text: &str) -> Result<Manifest, String> {
    let mut sources = SourceSet::default();
    let id = sources.add(MANIFEST, text);
    manifest::parse(&sources, id).map_err(|errors| {
        errors.first().map_or(String::new(), |error| format!("`{MANIFEST}`: {}", error.message))
    })
}

/// The keys of the permutations that ship.
fn shipped_keys(text: &str, program: &str) -> Result<Vec<String>, String> {
    let manifest = read_manifest(text)?;
    let program = manifest.program(program).ok_or_else(|| format!("no program `{program}`"))?;
    let space = &program.space;
    Ok(space.enumerate().iter().map(|point| space.key(point).to_string()).collect())
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

/// Adds a row for the value at the end of a table, with the same right side as the last row.
fn with_row(text: &str, table: &str, value: &str) -> String {
    let start = text.find(table).map_or(text.len(), |at| at + table.len());
    let rows = text[start..].find("\n[").map_or(text.len(), |at| start + at);
    let (before, after) = text.split_at(rows);
    let last = before[start..].trim_end().lines().next_back();
    let given = last.and_then(|row| row.split_once(" = ")).map_or("{}", |(_, given)| given);
    format!("{}\n{value} = {given}\n{after}", before.trim_end())
}
