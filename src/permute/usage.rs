//! Lists of keys that engines asked for, as a bundle's loader records them.

use super::axis::ValueSet;
use super::key::parse;
use super::manifest::Program;
use super::quoted::Quoted;
use super::space::{Lists, Slice, Space};
use crate::diagnostic::{Diagnostic, Diagnostics, Severity, codes};
use crate::source::{SourceId, SourceSet, Span};

/// Narrows what is wanted of a program to the keys that a list has for it, and to `include`.
/// Gives a warning for each that is no permutation any more: engines outlive axes.
///
/// # Errors
/// `usage-syntax` for lines that are no program and key.
pub fn narrow(
    program: &mut Program,
    sources: &mut SourceSet,
    list: SourceId,
) -> Result<Vec<Diagnostic>, Diagnostics> {
    let keys = keys(&program.name, sources, list)?;
    let mut warnings = Vec::new();
    let mut include = program.space.lists().include.clone();
    for key in keys {
        match parse(&program.space, &key) {
            Ok(point) if program.space.is_valid(&point) => include.push(point),
            Ok(_) => warnings.push(gone(&key, "a constraint excludes it")),
            Err(problems) => warnings.push(gone(
                &key,
                &problems
                    .iter()
                    .map(|problem| problem.message.clone())
                    .collect::<Vec<_>>()
                    .join("; "),
            )),
        }
    }
    include.sort();
    include.dedup();
    let axes = program.space.axes();
    let everything = Slice {
        values: axes.iter().map(|axis| ValueSet::full(axis.values.len())).collect(),
        span: program.span,
    };
    let lists = Lists { only: Vec::new(), exclude: vec![everything], include };
    program.space = Space::new(axes.to_vec(), program.space.constraints().to_vec(), lists)
        .map_err(|_| {
            let message =
                format!("the usage list of program `{}` is too long to count", program.name);
            vec![
                Diagnostic::error(codes::SPACE_TOO_COMPLEX, message)
                    .at(program.span, "declared here"),
            ]
        })?;
    Ok(warnings)
}

/// The keys that the list has for the program, each with its place.
fn keys(program: &str, sources: &SourceSet, list: SourceId) -> Result<Vec<Quoted>, Diagnostics> {
    let (mut keys, mut problems, mut start) = (Vec::new(), Vec::new(), 0);
    for line in sources.get(list).text.split_inclusive('\n') {
        let text = line.trim();
        let at = start + line.len() - line.trim_start().len();
        start += line.len();
        if text.is_empty() || text.starts_with('#') {
            continue;
        }
        let span = Span::new(list, at..at + text.len());
        match text.split_once(char::is_whitespace) {
            Some((found, key)) if found == program => {
                keys.push(Quoted::plain(
                    sources,
                    Span { start: span.end - key.trim_start().len() as u32, ..span },
                ));
            }
            Some(_) => {}
            None => problems.push(
                Diagnostic::error(codes::USAGE_SYNTAX, "a line is a program and a key")
                    .at(span, "only one word"),
            ),
        }
    }
    if problems.is_empty() { Ok(keys) } else { Err(problems) }
}

fn gone(key: &Quoted, reason: &str) -> Diagnostic {
    let message = format!("`{}` is no permutation: {reason}", key.text);
    Diagnostic {
        severity: Severity::Warning,
        ..Diagnostic::error(codes::INVALID_PERMUTATION, message).at(key.span, "left out")
    }
}
