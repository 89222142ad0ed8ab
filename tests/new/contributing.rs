//! The list of common tasks in `CONTRIBUTING.md`.

use std::collections::BTreeSet;
use std::fs;

use super::{Outcome, made};
use crate::snapshot::root;

/// The most lines of a task.
const LINES: usize = 6;

/// There are at least so many tasks.
const TASKS: usize = 15;

/// Each task is short, each command of the list can be run, each kind has a task, and each file that
/// is named exists, or is written by a command of the list.
pub fn is_true() -> Outcome {
    let text = fs::read_to_string(root().join("CONTRIBUTING.md"))?;
    let (_, list) = text.split_once("## Common tasks").ok_or("no common tasks")?;
    let (list, _) = list.split_once("\n## ").ok_or("nothing follows the common tasks")?;
    let mut problems: Vec<String> = Vec::new();
    let tasks: Vec<&str> = list.split("\n### ").skip(1).collect();
    if tasks.len() < TASKS {
        problems.push(format!("{} tasks were found, less than {TASKS}", tasks.len()));
    }
    for task in tasks {
        let (title, steps) = task.split_once('\n').unwrap_or((task, ""));
        let lines = steps.trim().lines().count();
        if lines > LINES || lines == 0 {
            problems.push(format!("`{title}` has {lines} lines, allowed are 1 to {LINES}"));
        }
    }
    let (mut kinds, mut written) = (BTreeSet::new(), BTreeSet::new());
    let quoted: Vec<&str> = list.split('`').skip(1).step_by(2).collect();
    for command in quoted.iter().filter_map(|text| text.strip_prefix("cargo xtask new ")) {
        let words = shell_words(command);
        let [kind, name, rest @ ..] = &words[..] else {
            problems.push(format!("`{command}` has no name"));
            continue;
        };
        kinds.insert(kind.clone());
        // A word in capitals stands for another.
        if name.chars().any(|letter| letter.is_ascii_uppercase()) {
            continue;
        }
        let rest: Vec<&str> = rest.iter().map(String::as_str).collect();
        match made::make(&root(), kind, name, &rest) {
            Ok(made) => written.extend(made.files.into_iter().map(|(path, _)| path)),
            // Somebody may have followed the example.
            Err(problem) if problem.contains("already") => {}
            Err(problem) => problems.push(format!("`{command}`: {problem}")),
        }
    }
    let lost = made::KINDS.iter().filter(|kind| !kinds.contains(kind.name));
    problems.extend(lost.map(|kind| format!("no task says `cargo xtask new {}`", kind.name)));
    let named = quoted.iter().filter(|text| is_path(text));
    let lost = named.filter(|path| !root().join(path).exists() && !written.contains(**path));
    problems.extend(lost.map(|path| format!("there is no `{path}`")));
    match problems.is_empty() {
        true => Ok(()),
        false => Err(format!("CONTRIBUTING.md:\n{}", problems.join("\n")).into()),
    }
}

/// Whether a quoted text is the path of one file or folder of the repository.
fn is_path(text: &str) -> bool {
    let folders = ["src/", "crates/", "tests/", "shaderlib/", "docs/", "xtask/", "snapshots/"];
    let is_literal = text.chars().all(|one| one.is_ascii_alphanumeric() || "/._-".contains(one));
    let has_place_holder = text.contains("CODE");
    folders.iter().any(|folder| text.starts_with(folder)) && is_literal && !has_place_holder
}

/// The words of a command, of which some are in single quotes.
fn shell_words(command: &str) -> Vec<String> {
    let mut words = Vec::new();
    for (index, part) in command.split('\'').enumerate() {
        match index % 2 {
            0 => words.extend(part.split_whitespace().map(str::to_owned)),
            _ => words.push(part.to_owned()),
        }
    }
    words
}
