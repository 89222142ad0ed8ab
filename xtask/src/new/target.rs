//! An output language, made after one that exists: most new ones are another version of it.

use super::renumber::Renaming;
use super::{Kind, Made, Repository, check_name};

pub const KIND: Kind =
    Kind { name: "target", example: &["essl310"], rest: "[TARGET THAT IT IS LIKE]", make };

const TARGETS: &str = "src/emit/targets";
const EXECUTORS: &str = "src/execute/executors";
const GUIDE: &str = "docs/guide/targets.md";
/// What versions of GLSL lack: a line of Rust for each, with the first versions that have it.
const LACKS: &str = "src/emit/lacks.rs";

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
    let lacking = lacking_of(&repository.read(LACKS)?, name);
    let next = vec![
        format!(
            "{file}: its head comment and the version, `about` and the judge's rules, where they are still those of `{like}` (trials house::described, emit, judges)"
        ),
        format!("{own_executor}: likewise (trials harness::executor::{name}, frames/shipped)"),
        format!(
            "{GUIDE}: what `{name}` does unlike `{like}`, in a column of its own (trials conventions::guide, guide lists are whole)"
        ),
        format!(
            "{GUIDE}, \"{}\": rows that hold for `{name}`: {lacking}",
            LACKING.trim_start_matches("## ")
        ),
        "cargo xtask record; read the difference".to_owned(),
    ];
    let target = with_numbers(without_older_rules(own_ending(&target, name), name), name);
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

/// The target's text without the judge's rules that name a version, such as `310 es`, if the
/// target's own version is at least that one.
fn without_older_rules(text: String, name: &str) -> String {
    let number = |text: &str| -> Option<u32> {
        text.trim_matches(|letter: char| !letter.is_ascii_digit()).parse().ok()
    };
    let Some((before, rest)) = text.split_once("rules: &[") else { return text };
    let Some((rules, after)) = rest.split_once(']') else { return text };
    let is_older = |rule: &&str| {
        rule.starts_with("\"") && number(rule) <= number(name) && number(rule).is_some()
    };
    let kept: Vec<&str> = rules.split(", ").filter(|rule| !is_older(rule)).collect();
    format!("{before}rules: &[{}]{after}", kept.join(", "))
}

/// The version of GLSL in a target's name, and whether it is one of GLSL ES.
fn glsl_version(name: &str) -> Option<(u32, bool)> {
    let number = |kind: &str| name.strip_prefix(kind)?.parse::<u32>().ok();
    number("glsl").map(|number| (number, false)).or(number("essl").map(|number| (number, true)))
}

/// The target's text with numbered bindings if its version of GLSL can state them, or else with
/// bindings that have names only.
fn with_numbers(text: String, name: &str) -> String {
    let has_numbers = glsl_version(name)
        .is_some_and(|(number, is_embedded)| number >= if is_embedded { 310 } else { 420 });
    let (other, own) = match has_numbers {
        true => ("Numbering::Named", "Numbering::Explicit"),
        false => ("Numbering::Explicit", "Numbering::Named"),
    };
    text.replace(other, own)
}

/// What a version lacks, by the table of the first versions that have it.
fn lacking_of(table: &str, name: &str) -> String {
    let Some((number, is_embedded)) = glsl_version(name) else {
        return "none, since it is not GLSL".to_owned();
    };
    let lacks = |line: &str| -> Option<String> {
        let (what, versions) = line.split_once("Later::since(\"")?.1.split_once("\", ")?;
        let (desktop, embedded) = versions.trim_end_matches(");").split_once(", ")?;
        let first =
            if is_embedded { embedded.trim_matches(|one| "Some()".contains(one)) } else { desktop };
        let is_there = first.parse::<u32>().is_ok_and(|first| number >= first);
        (!is_there).then(|| what.to_owned())
    };
    let found: Vec<String> = table.lines().filter_map(lacks).collect();
    let always = "matrices of two rows, and depth textures without a comparison, in every GLSL";
    match found.is_empty() {
        true => always.to_owned(),
        false => format!("{}; {always}", found.join(", ")),
    }
}

/// The section about what a version lacks. A new version may lack less.
const LACKING: &str = "## What GLSL does not have";

/// Adds the new name after each `like` in backticks, in all Markdown tables but the one below
/// [`LACKING`].
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
