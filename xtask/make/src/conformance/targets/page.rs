//! The page `docs/conformance.md`.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use lamplight::bundle::Target;

use super::probes::{Known, confirm, known_reason};
use super::{Outcome, Project};
use crate::conformance::table::general;
use xtask::CommandFailure;

const HEAD: &str = "# Shaders of other projects

For which targets the plain WGSL files of other projects compile, each file as it is, with all of its
entry points. `cargo xtask conformance targets --record DIR...` writes this page from checkouts whose
folders have the names below; without `--record`, it compares. Nothing of these projects is in the
repository but the names of their files.

A number in the place of `yes` is a reason below.
";

/// The reasons of blanks, without names: with the targets, and the number of files.
type Reasons = BTreeMap<String, (BTreeSet<Target>, BTreeSet<String>)>;

/// The whole page.
pub fn write_page(projects: &[Project]) -> Result<String, CommandFailure> {
    let reasons = reasons_of(projects);
    let mut text = HEAD.to_owned();
    add_summary(&mut text, projects);
    add_reasons(&mut text, &reasons)?;
    for project in projects {
        add_project(&mut text, project, &reasons);
    }
    add_invalid(&mut text, projects);
    Ok(text)
}

/// The parts of a message: a language may lack several things.
pub fn general_reasons(message: &str) -> Vec<String> {
    let message = match message.strip_prefix("target `") {
        Some(rest) => rest.split_once("`: ").map_or(message, |(_, rest)| rest),
        None => message,
    };
    if let Some(list) = message.strip_prefix("the language lacks ") {
        return list.split(", ").map(|one| format!("the language lacks {one}")).collect();
    }
    let message = message.strip_suffix(", which is needed here").unwrap_or(message);
    if message.starts_with("the override ") {
        return vec!["an override has no value".to_owned()];
    }
    match message.split_once("does not have what this needs: ") {
        Some((_, need)) => vec![format!("the target does not have: {need}")],
        None => vec![message.to_owned()],
    }
}

fn reasons_of(projects: &[Project]) -> Reasons {
    let mut reasons = Reasons::new();
    for project in projects {
        for (file, outcome) in &project.files {
            let Outcome::Compiled(blanks) = outcome else { continue };
            for (target, reason) in
                blanks.iter().flat_map(|(target, all)| all.iter().map(move |one| (target, one)))
            {
                let (targets, files) = reasons.entry(reason.clone()).or_default();
                targets.insert(*target);
                files.insert(format!("{}/{file}", project.name));
            }
        }
    }
    reasons
}

fn add_summary(text: &mut String, projects: &[Project]) {
    *text += "\n| project | commit | files | Tint refuses | no entry point | compiled | for all \
              targets | for none |\n|---|---|---|---|---|---|---|---|\n";
    let mut sums = [0; 6];
    for Project { name, commit, files } in projects {
        let is = |test: fn(&Outcome) -> bool| files.iter().filter(|(_, one)| test(one)).count();
        let counts = [
            files.len(),
            is(|one| matches!(one, Outcome::Invalid(_))),
            is(|one| matches!(one, Outcome::NoEntryPoint)),
            is(|one| matches!(one, Outcome::Compiled(_))),
            is(|one| matches!(one, Outcome::Compiled(blanks) if blanks.is_empty())),
            is(|one| matches!(one, Outcome::Compiled(blanks) if blanks.len() == Target::ALL.len())),
        ];
        add_row(text, &format!("{name} | {commit}"), &counts);
        for (sum, count) in sums.iter_mut().zip(counts) {
            *sum += count;
        }
    }
    add_row(text, "all |", &sums);
}

fn add_row(text: &mut String, name: &str, counts: &[usize]) {
    let counts: Vec<String> = counts.iter().map(usize::to_string).collect();
    // Writing to a string does not fail.
    let _ = writeln!(text, "| {name} | {} |", counts.join(" | "));
}

fn add_reasons(text: &mut String, reasons: &Reasons) -> Result<(), CommandFailure> {
    *text += "\n## Reasons\n\n| | reason | targets | files | what it is | confirmed by |\n\
              |---|---|---|---|---|---|\n";
    for (at, (reason, (targets, files))) in reasons.iter().enumerate() {
        let known = known_reason(reason).ok_or_else(|| {
            let example = files.first().map_or("", String::as_str);
            CommandFailure::check(format!("`probes.rs` does not know: {reason} ({example})"))
        })?;
        let confirmed = confirm(known, targets)?;
        let Known { kind, note, .. } = known;
        let targets: Vec<&str> = targets.iter().map(|target| target.name()).collect();
        let (number, targets, files) = (at + 1, targets.join(", "), files.len());
        let what = format!("{}: {note}", kind.words());
        let _ =
            writeln!(text, "| {number} | {reason} | {targets} | {files} | {what} | {confirmed} |");
    }
    Ok(())
}

fn add_project(text: &mut String, project: &Project, reasons: &Reasons) {
    let names: Vec<&str> = Target::ALL.iter().map(|target| target.name()).collect();
    let _ = writeln!(text, "\n## {}\n\n| file | {} |", project.name, names.join(" | "));
    let _ = writeln!(text, "|---|{}", "---|".repeat(names.len()));
    let number = |reason: &String| {
        let at = reasons.keys().position(|known| known == reason).unwrap_or_default();
        (at + 1).to_string()
    };
    let mut alone = Vec::new();
    for (file, outcome) in &project.files {
        let blanks = match outcome {
            Outcome::Invalid(_) => continue,
            Outcome::NoEntryPoint => {
                alone.push(format!("`{file}`"));
                continue;
            }
            Outcome::Compiled(blanks) => blanks,
        };
        let cell = |target: &Target| match blanks.get(target) {
            None => "yes".to_owned(),
            Some(all) => all.iter().map(number).collect::<Vec<_>>().join(", "),
        };
        let cells: Vec<String> = Target::ALL.iter().map(cell).collect();
        let _ = writeln!(text, "| `{file}` | {} |", cells.join(" | "));
    }
    if !alone.is_empty() {
        let _ = writeln!(text, "\nWithout an entry point: {}.", alone.join(", "));
    }
}

fn add_invalid(text: &mut String, projects: &[Project]) {
    *text += "\n## What Tint refuses\n\nParts of shaders, texts that their project still changes, and \
              features that browsers do not have.\n\n| file | Tint says |\n|---|---|\n";
    for Project { name, files, .. } in projects {
        for (file, outcome) in files {
            if let Outcome::Invalid(reason) = outcome {
                let reason = general(&reason.replace('\'', "`")).replace('|', "\\|");
                let _ = writeln!(text, "| `{name}/{file}` | {reason} |");
            }
        }
    }
}
