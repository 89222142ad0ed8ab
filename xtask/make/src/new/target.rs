//! An output language, made after one that exists: most new ones are another version of it.

use super::renumber::Renaming;
use super::{NewFiles, Repository, TaskKind, check_name};

pub const KIND: TaskKind =
    TaskKind { name: "target", example: &["essl310"], rest: "[TARGET THAT IT IS LIKE]", make };

const TARGETS: &str = "crates/emit/src/targets";
const EXECUTORS: &str = "crates/execute/src/executors";
const GUIDE: &str = "docs/guide/targets.md";
/// What versions of GLSL lack: a line of Rust for each, with the first versions that have it.
const LACKS: &str = "crates/emit/src/lacks.rs";

fn make(repository: &Repository<'_>, name: &str, rest: &[&str]) -> Result<NewFiles, String> {
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
    let numbered_alike = numbered_alike(repository, &known, like, name)?;
    let guide = in_tables(&repository.read(GUIDE)?, like, &numbered_alike, name);
    let lacking = lacking_of(&repository.read(LACKS)?, name);
    let next = vec![
        format!(
            "{file}: its head comment and the version, `about` and the validator's rules, where they are still those of `{like}`; glslang knows `own` (the output's own version), `vulkan`, `hlsl`, or a version such as `320 es` (tests house::described, emit, validators)"
        ),
        format!("{own_executor}: likewise (tests harness::executor::{name}, frames/shipped)"),
        format!(
            "{GUIDE}: what `{name}` does unlike `{like}`, in each row that `git diff` shows, that of the validator included; the first table has it beside `{numbered_alike}`, whose bindings are like its own (tests conventions::guide, guide lists are whole)"
        ),
        format!(
            "{GUIDE}, \"{}\": rows that hold for `{name}`: {lacking}",
            LACKING.trim_start_matches("## ")
        ),
        "cargo xtask record; read the difference; cargo xtask docs".to_owned(),
    ];
    let target = without_older_rules(own_ending(&target, name), name);
    let like_numbers = repository.read(&format!("{TARGETS}/{numbered_alike}.rs"))?;
    let target = with_numbers(&target, &like_numbers, name);
    // Only GLSL ES 3.00 is a language of WebGL.
    let target = target.replace(" and WebGL 2", "");
    Ok(NewFiles {
        files: vec![(file, target), (own_executor, text), (GUIDE.to_owned(), guide)],
        next,
    })
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

/// The target's text without the validator's rules that name a version, such as `310 es`, if the
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

/// How a version of GLSL binds resources: by numbers if the language can state them, or else by
/// names only.
fn numbering_of(name: &str) -> &'static str {
    let has_numbers = glsl_version(name)
        .is_some_and(|(number, is_embedded)| number >= if is_embedded { 310 } else { 420 });
    if has_numbers { "Numbering::Explicit" } else { "Numbering::Named" }
}

/// The target that the new one is like, or another version of GLSL if that one has other bindings.
fn numbered_alike(
    repository: &Repository<'_>,
    known: &[String],
    like: &str,
    name: &str,
) -> Result<String, String> {
    let first = [like.to_owned()];
    for other in first.iter().chain(known) {
        let text = repository.read(&format!("{TARGETS}/{other}.rs"))?;
        if !text.contains("Numbering::") || text.contains(numbering_of(name)) {
            return Ok(other.clone());
        }
    }
    Ok(like.to_owned())
}

/// The target's text with the bindings of its version of GLSL, and with what the head comment of
/// another target says about them.
fn with_numbers(text: &str, like: &str, name: &str) -> String {
    let own = numbering_of(name);
    let text = ["Numbering::Named", "Numbering::Explicit"]
        .iter()
        .fold(text.to_owned(), |text, other| text.replace(other, own));
    let bindings = |text: &str| -> Option<String> {
        Some(text.split_once("//!\n")?.1.split_once("\n\n")?.0.to_owned())
    };
    match (bindings(&text), bindings(like)) {
        (Some(old), Some(new)) if text.contains(own) => text.replace(&old, &new),
        _ => text,
    }
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
/// [`LACKING`]. In headers, it is added after `column`.
fn in_tables(text: &str, like: &str, column: &str, name: &str) -> String {
    let lines: Vec<&str> = text.split_inclusive('\n').collect();
    let mut section = "";
    let line = |(index, line): (usize, &&str)| {
        if line.starts_with("## ") {
            section = lines[index].trim_end();
        }
        let is_header = lines.get(index + 1).is_some_and(|next| next.starts_with("|---"));
        let after = format!("`{}`", if is_header { column } else { like });
        match line.starts_with('|') && section != LACKING {
            true => line.replace(&after, &format!("{after}, `{name}`")),
            false => (*line).to_owned(),
        }
    };
    lines.iter().enumerate().map(line).collect()
}
