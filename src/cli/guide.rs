//! Where the guide explains what a command is about: a line at the end of help and of errors.

use std::collections::BTreeSet;

use clap::Command;

use super::terminal::is_person;
use crate::diagnostic::{Diagnostic, Severity, guide};

/// The page of each command, by its title.
const PAGES: &[(&str, &str)] = &[
    ("list", "First shader in five minutes"),
    ("show", "First shader in five minutes"),
    ("compose", "Conditions and constants"),
    ("compile", "A package of your own"),
    ("gen", "Axes, constraints and the manifest"),
    ("merge", "Many machines"),
    ("variants", "Axes, constraints and the manifest"),
    ("watch", "Hot reload"),
    ("bundle", "Bundles"),
    ("keys", "In an engine"),
    ("eval", "First shader in five minutes"),
    ("check", "Numeric cases"),
    ("catalogue", "First shader in five minutes"),
    ("render", "First shader in five minutes"),
    ("mutate", "Numeric cases"),
    ("export", "WESL without this tool"),
    ("cost", "Cost on GPUs"),
    ("explain", "Troubleshooting by diagnostic"),
];

/// Codes that one line names.
const CODES: usize = 3;

/// Adds the page of each command to its help.
pub fn in_help(command: Command) -> Command {
    command.mut_subcommands(|command| {
        let page = PAGES.iter().find(|(name, _)| *name == command.get_name());
        page.map_or(command.clone(), |(_, page)| with_page(command, page))
    })
}

fn with_page(command: Command, page: &str) -> Command {
    let line = |before: Option<&clap::builder::StyledStr>| match before {
        Some(text) => format!("{text}\n\nGuide: {page}"),
        None => format!("Guide: {page}"),
    };
    let short = line(command.get_after_help());
    let long = line(command.get_after_long_help().or(command.get_after_help()));
    command.after_help(short).after_long_help(long)
}

/// What to read about the errors, for a person at a terminal; nothing for a program.
pub fn after_errors(diagnostics: &[Diagnostic]) -> Option<String> {
    is_person().then(|| reading(diagnostics)).flatten()
}

fn reading(diagnostics: &[Diagnostic]) -> Option<String> {
    let errors = diagnostics.iter().filter(|error| error.severity == Severity::Error);
    let mut seen = BTreeSet::new();
    let codes: Vec<_> =
        errors.map(|error| error.code).filter(|code| seen.insert(code.name)).take(CODES).collect();
    let (first, rest) = codes.split_first()?;
    let others: String = rest.iter().map(|code| format!(", {}", code.name)).collect();
    let page =
        guide::page_of(first).map_or(String::new(), |page| format!("; guide: {}", page.title));
    Some(format!("more: lamplight explain {}{others}{page}\n", first.name))
}
