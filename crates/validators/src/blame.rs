//! Finds the author's lines for which an output was refused.

use std::collections::BTreeSet;
use std::ops::Range;

use super::agreement::AGREEMENT;
use super::{Output, Refusal};
use lamplight_bundle::{Contents, Target};
use lamplight_compose::resolve::Packages;
use lamplight_compose::{Part, PartKind, code_lines};
use lamplight_diagnostic::source::SourceSet;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_generate::{Permutation, ShaderName, permutation};
use lamplight_permute::Manifest;
use lamplight_syntax::words::{begins_word, has_word, words};

/// How many refusals are reported.
const REPORTED: usize = 20;

/// How many lines of a validator's message are shown.
const LINES: usize = 6;

/// What the outputs were made from.
pub struct OutputOrigin<'a> {
    /// Where the sources are.
    pub packages: &'a Packages,
    /// What declares the programs.
    pub manifest: &'a Manifest,
    /// The keys, with the units that they refer to.
    pub contents: &'a Contents,
}

/// Turns refusals into diagnostics about the author's text, each with the first permutation that
/// shows it.
pub fn blame(
    sources: &mut SourceSet,
    made: &OutputOrigin<'_>,
    refusals: &[Refusal],
) -> Diagnostics {
    let mut reported: Diagnostics = Vec::new();
    for refusal in refusals {
        let found = blame_one(sources, made, refusal);
        let is_reported = |error: &Diagnostic| {
            reported
                .iter()
                .any(|known| (&known.message, &known.labels) == (&error.message, &error.labels))
        };
        if !found.iter().any(is_reported) {
            reported.extend(found);
        }
        if reported.len() >= REPORTED {
            break;
        }
    }
    let left = refusals.len().saturating_sub(reported.len());
    if let Some(last) = reported.pop() {
        reported.push(match left {
            0 => last,
            left => last.note(format!("{left} more outputs are refused, most for the same")),
        });
    }
    reported
}

fn blame_one(sources: &mut SourceSet, made: &OutputOrigin<'_>, refusal: &Refusal) -> Diagnostics {
    let error = Diagnostic::error(codes::OUTPUT_REFUSED, refusal_words(refusal));
    let line = refused_line(refusal);
    let words: Vec<&str> = refusal.message.lines().take(LINES).collect();
    let mut error = error.note(words.join("\n"));
    if let (Some(number), Some((_, text))) = (refusal.line, &line) {
        error = error.note(format!("line {number} of the output: `{}`", text.trim()));
    }
    let Some(named) = find_shader(made.contents, &refusal.output) else { return vec![error] };
    match permutation(sources, made.packages, made.manifest, named) {
        Ok(Some(permutation)) => permutation.named(vec![place_error(error, &permutation, line)]),
        // It was composed before, so this cannot happen.
        Ok(None) | Err(_) => {
            vec![error.note(format!("in permutation `{}` of {}", named.key, named.program))]
        }
    }
}

fn refusal_words(refusal: &Refusal) -> String {
    let target = refusal.output.target;
    match refusal.validator {
        AGREEMENT => format!("the output for `{target}` differs from its reflection"),
        validator => format!("{validator} refuses the output for `{target}`"),
    }
}

/// The first shader that has the output, in the order of names and keys.
fn find_shader<'c>(contents: &'c Contents, output: &Output) -> Option<ShaderName<'c>> {
    let languages = contents.programs.iter().flat_map(|(program, contents)| {
        contents.languages.iter().map(move |(language, entries)| (program, language, entries))
    });
    let entries = languages.flat_map(|(program, language, entries)| {
        entries.iter().map(move |(label, entry)| (program, language, label, entry))
    });
    let mut found = entries.filter_map(|(program, language, label, entry)| {
        let (key, _) = entry.keys.iter().find(|(_, unit)| **unit == output.unit)?;
        Some(ShaderName { program, language: *language, label, key })
    });
    found.next()
}

/// The name of the declaration that the line at fault is in, and the text of the line.
type RefusedLine = (Option<String>, String);

fn refused_line(refusal: &Refusal) -> Option<RefusedLine> {
    let number = refusal.line?.checked_sub(1)? as usize;
    let text = refusal.output.text().ok()?;
    let lines: Vec<&str> = text.lines().collect();
    let line = lines.get(number)?;
    let before = lines[..=number].iter().rev();
    let name = before.filter_map(|line| declared_name(line, refusal.output.target)).next();
    Some((name, (*line).to_owned()))
}

/// The name that a line declares. Only lines that begin a declaration are not indented.
fn declared_name(line: &str, target: Target) -> Option<String> {
    if !line.starts_with(begins_word) {
        return None;
    }
    let mut behind = words(line).skip_while(|word| word.text != "struct").skip(1);
    if has_word(line, "struct") {
        return behind.next().map(|word| word.text.to_owned());
    }
    let (head, _) = match target {
        Target::WGSL if !line.starts_with("fn ") => return None,
        _ => line.split_once('(')?,
    };
    words(head).last().map(|word| word.text.to_owned())
}

/// Puts the error at the author's line, or at the entry point.
fn place_error(
    error: Diagnostic,
    permutation: &Permutation,
    line: Option<RefusedLine>,
) -> Diagnostic {
    let composed = &permutation.composed;
    let (name, text) = line.map_or((None, None), |(name, text)| (name, Some(text)));
    let named = name.and_then(|name| find_part(&composed.parts, &name));
    let is_entry = |part: &&Part| part.names.contains(&permutation.entry);
    let Some(part) = named.or_else(|| composed.parts.iter().find(is_entry)) else { return error };
    let place = nearest_line(&composed.text, part, text.as_deref().unwrap_or_default());
    match composed.map.lookup(place) {
        Some(span) => error.at(span, "written from here"),
        None => error,
    }
}

/// The author's declaration of a name to which naga may have appended something.
fn find_part<'p>(parts: &'p [Part], name: &str) -> Option<&'p Part> {
    let plain = name.trim_end_matches('_');
    let bare = plain.trim_end_matches(|c: char| c.is_ascii_digit()).trim_end_matches('_');
    let find = |name: &str| {
        let is_it = |part: &&Part| {
            matches!(part.kind, PartKind::Function | PartKind::Struct)
                && part.names.iter().any(|found| found == name)
        };
        parts.iter().find(is_it)
    };
    find(name).or_else(|| find(plain)).or_else(|| find(bare))
}

/// The line of a declaration that shares most words with a line of the output, since writers keep
/// the author's names. If no line shares a word, the first line with code.
fn nearest_line(text: &str, part: &Part, output: &str) -> Range<usize> {
    let wanted: BTreeSet<&str> = words(output).map(|word| word.text).collect();
    let mut best: Option<(usize, Range<usize>)> = None;
    for line in code_lines(text, part.range.clone()) {
        let words: BTreeSet<&str> = words(&text[line.clone()]).map(|word| word.text).collect();
        let score = words.intersection(&wanted).count();
        if best.as_ref().is_none_or(|(most, _)| score > *most) {
            best = Some((score, line));
        }
    }
    best.map_or(part.range.clone(), |(_, range)| range)
}
