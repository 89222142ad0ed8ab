//! An output language, made after one that exists: most new ones are another version of it.

use super::renumber::Renaming;
use super::{Kind, Made, Repository, check_name};

pub const KIND: Kind =
    Kind { name: "target", example: &["essl310"], rest: "[TARGET THAT IT IS LIKE]", make };

const TARGETS: &str = "src/emit/targets";
const EXECUTORS: &str = "src/execute/executors";
const GUIDE: &str = "docs/guide/targets.md";

fn make(repository: &Repository<'_>, name: &str, rest: &[&str]) -> Result<Made, String> {
    check_name(name, '_')?;
    let file = format!("{TARGETS}/{name}.rs");
    let own_executor = format!("{EXECUTORS}/{name}.rs");
    repository.refuse_existing(&file)?;
    repository.refuse_existing(&own_executor)?;
    let known = repository.stems(TARGETS)?;
    let like = match rest {
        [] => most_alike(name, &known).ok_or_else(|| {
            format!("no target is like `{name}`: name one of {}", known.join(", "))
        })?,
        [like] if known.iter().any(|known| known == like) => *like,
        _ => return Err(format!("name one target of {}", known.join(", "))),
    };
    let renaming = Renaming::new(like, name);
    let target = renaming.apply(&repository.read(&format!("{TARGETS}/{like}.rs"))?);
    let (executor, text) = executor_of(repository, like)?;
    let text =
        renaming.apply(&text.replace(&format!("name: {executor:?}"), &format!("name: {name:?}")));
    let guide = in_tables(&repository.read(GUIDE)?, like, name);
    let next = vec![
        format!(
            "{file}: the version, `about` and the judge's rules, where they are still those of `{like}` (trials house::described, emit, judges)"
        ),
        format!("{own_executor}: likewise (trials harness::executor::{name}, frames/shipped)"),
        format!(
            "{GUIDE}: what `{name}` does unlike `{like}`, in a column of its own (trials conventions::guide, guide lists are whole)"
        ),
        format!(
            "{GUIDE}, \"{}\": rows that hold for `{name}`; src/emit/lacks.rs has the versions",
            LACKING.trim_start_matches("## ")
        ),
        "cargo xtask record; read the difference".to_owned(),
    ];
    let target = without_older_rules(own_ending(&target, name), name);
    Ok(Made { files: vec![(file, target), (own_executor, text), (GUIDE.to_owned(), guide)], next })
}

/// The target with the same letters before its number, and the nearest number.
fn most_alike<'k>(name: &str, known: &'k [String]) -> Option<&'k str> {
    let parts = |name: &str| -> (String, i64) {
        let letters = name.trim_end_matches(|letter: char| letter.is_ascii_digit());
        (letters.to_owned(), name[letters.len()..].parse().unwrap_or_default())
    };
    let (letters, number) = parts(name);
    let alike = known.iter().filter(|known| parts(known).0 == letters);
    alike.min_by_key(|known| (parts(known).1 - number).abs()).map(String::as_str)
}

/// The name and the text of an executor that runs a target's files as they are.
fn executor_of(repository: &Repository<'_>, target: &str) -> Result<(String, String), String> {
    let ships = format!("target: Target::{}", target.to_uppercase());
    for name in repository.stems(EXECUTORS)? {
        let text = repository.read(&format!("{EXECUTORS}/{name}.rs"))?;
        if text.contains(&ships) {
            return Ok((name, text));
        }
    }
    Err(format!("no file of {EXECUTORS} has `{ships}`"))
}

/// The ending of a target's files is its own, so that outputs for all targets fit into one folder.
fn own_ending(text: &str, name: &str) -> String {
    let Some((before, rest)) = text.split_once("extension: \"") else { return text.to_owned() };
    match rest.starts_with(name) {
        true => text.to_owned(),
        false => format!("{before}extension: \"{name}.{rest}"),
    }
}

/// The target without rules of a later version, if its own version is not below that.
fn without_older_rules(text: String, name: &str) -> String {
    let number = |text: &str| -> Option<u32> {
        text.trim_matches(|letter: char| !letter.is_ascii_digit()).parse().ok()
    };
    let rules = text.split_once(", GlslRules::Later(").and_then(|(before, rest)| {
        let (later, after) = rest.split_once(')')?;
        (number(later)? <= number(name)?).then(|| format!("{before}{after}"))
    });
    rules.unwrap_or(text)
}

/// The section about what a version lacks. A new version may lack less.
const LACKING: &str = "## What GLSL does not have";

/// The text with the new name after the other, in each cell of a table that has it.
fn in_tables(text: &str, like: &str, name: &str) -> String {
    let quoted = format!("`{like}`");
    let both = format!("{quoted}, `{name}`");
    let mut section = "";
    let line = |line| {
        if str::starts_with(line, "## ") {
            section = line.trim_end();
        }
        match line.starts_with('|') && section != LACKING {
            true => line.replace(&quoted, &both),
            false => line.to_owned(),
        }
    };
    text.split_inclusive('\n').map(line).collect()
}
