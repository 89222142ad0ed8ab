//! Lists of keys that engines asked for, as a bundle's loader records them.

use std::collections::BTreeSet;

use super::axis::ValueSet;
use super::key::parse;
use super::lint;
use super::manifest::Program;
use super::quoted::Quoted;
use super::space::{Slice, SliceLists, Space};
use lamplight_bundle::usage_lines;
use lamplight_diagnostic::source::{SourceId, SourceSet, Span};
use lamplight_diagnostic::{Diagnostic, Diagnostics, Severity, codes};

/// Narrows what is wanted of a program to the keys that a list has for it, and to `include`. A key
/// that is no longer a permutation gets a warning and not an error, since lists come from engines
/// that may be older than the manifest.
///
/// # Errors
/// `usage-syntax` for lines that are no program and key.
pub fn narrow_to_list(
    program: &mut Program,
    sources: &mut SourceSet,
    list: SourceId,
) -> Result<Vec<Diagnostic>, Diagnostics> {
    let keys = listed_keys(&program.name, sources, list)?;
    let mut warnings = Vec::new();
    let mut include = program.space.lists().include.clone();
    for key in keys {
        match parse(&program.space, &key) {
            Ok(point) if program.space.is_valid(&point) => include.push(point),
            Ok(_) => warnings.push(key_is_gone(&key, "a constraint excludes it")),
            Err(problems) => warnings.push(key_is_gone(&key, &joined_messages(&problems))),
        }
    }
    include.sort();
    include.dedup();
    let axes = program.space.axes();
    let everything = Slice {
        values: axes.iter().map(|axis| ValueSet::full(axis.values.len())).collect(),
        span: program.span,
    };
    let lists = SliceLists { only: Vec::new(), exclude: vec![everything], include };
    let undeclared = program.space.undeclared;
    let features = program.space.features.clone();
    program.space = Space::new(axes.to_vec(), program.space.constraints().to_vec(), lists)
        .map_err(|_| {
            let message =
                format!("the usage list of program `{}` is too long to count", program.name);
            vec![
                Diagnostic::error(codes::SPACE_TOO_COMPLEX, message)
                    .at(program.span, "declared here"),
            ]
        })?;
    program.space.undeclared = undeclared;
    program.space.features = features;
    let what = format!("program `{}`", program.name);
    let Some(error) = lint::nothing_wanted(&program.space, &what, program.span) else {
        return Ok(warnings);
    };
    warnings.push(error.note("the usage list has no key of it that is still valid"));
    Err(warnings)
}

fn joined_messages(problems: &[Diagnostic]) -> String {
    let messages: Vec<&str> = problems.iter().map(|problem| problem.message.as_str()).collect();
    messages.join("; ")
}

/// A warning for each program that a list names and the manifest does not declare, once.
pub fn unknown_programs(
    programs: &[Program],
    sources: &SourceSet,
    list: SourceId,
) -> Vec<Diagnostic> {
    let known = || programs.iter().map(|program| program.name.as_str());
    let mut seen = BTreeSet::new();
    let of_line = |(span, text): (Span, &str)| {
        let (name, _) = text.split_once(char::is_whitespace)?;
        if known().any(|known| known == name) || !seen.insert(name.to_owned()) {
            return None;
        }
        let message = format!("the manifest declares no program `{name}`");
        let place = Span { end: span.start + name.len() as u32, ..span };
        let warning = Diagnostic::warning(codes::UNKNOWN_PROGRAM, message).at(place, "left out");
        Some(warning.suggest(name, known()))
    };
    list_lines(sources, list).filter_map(of_line).collect()
}

/// The lines of a list that are neither blank nor comments, each with its place.
fn list_lines(sources: &SourceSet, list: SourceId) -> impl Iterator<Item = (Span, &str)> {
    let lines = usage_lines(&sources.get(list).text);
    lines.map(move |(_, at, text)| (Span::new(list, at..at + text.len()), text))
}

/// The keys that the list has for the program, each with its place.
fn listed_keys(
    program: &str,
    sources: &SourceSet,
    list: SourceId,
) -> Result<Vec<Quoted>, Diagnostics> {
    let (mut keys, mut problems) = (Vec::new(), Vec::new());
    for (span, text) in list_lines(sources, list) {
        match text.split_once(char::is_whitespace) {
            Some((found, key)) if found == program => {
                keys.push(Quoted::plain(
                    sources,
                    Span { start: span.end - key.trim_start().len() as u32, ..span },
                ));
            }
            Some(_) => {}
            None => problems.push(
                Diagnostic::error(codes::USAGE_SYNTAX, "expected `PROGRAM KEY`")
                    .at(span, "only one word"),
            ),
        }
    }
    if problems.is_empty() { Ok(keys) } else { Err(problems) }
}

fn key_is_gone(key: &Quoted, reason: &str) -> Diagnostic {
    let message = format!("`{}` is not a permutation: {reason}", key.text);
    Diagnostic {
        severity: Severity::Warning,
        ..Diagnostic::error(codes::INVALID_PERMUTATION, message).at(key.span, "left out")
    }
}
