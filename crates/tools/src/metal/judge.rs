//! Judges whether texts in MSL are well formed: attributes by a table, everything else by clang.

use std::fmt::Write as _;

use super::adapt::adapt_text;
use super::attributes;
use super::clang::{Clang, ClangMissing};
use super::token::msl_tokens;
use crate::halve_refused;

/// A text that is not well formed.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct MslRefusal {
    /// Index of the text.
    pub index: usize,
    /// What is wrong with it, as `line:column: error: ...`, a line for each.
    pub errors: String,
}

type Refusals = Result<Vec<MslRefusal>, ClangMissing>;

/// Judges some texts. Each has a number, by which refusals name it.
///
/// # Errors
/// clang cannot be run.
pub fn judge_batch(clang: &Clang, batch: &[IndexedText<'_>]) -> Refusals {
    let (mut refusals, mut sound) = (Vec::new(), Vec::new());
    for (index, text) in batch {
        match before_clang(text) {
            Some(errors) => refusals.push(MslRefusal { index: *index, errors }),
            None => sound.push((*index, *text)),
        }
    }
    refusals.extend(judge_sound(clang, &sound)?);
    Ok(refusals)
}

/// What is wrong with a text that clang would not report in a batch: the header is not included (a
/// batch includes it itself), there is no entry point, or an attribute is wrong.
fn before_clang(text: &str) -> Option<String> {
    if !text.lines().any(|line| line.trim() == "#include <metal_stdlib>") {
        return Some("1:1: error: `metal_stdlib` is not included".to_owned());
    }
    let is_stage = |word: &str| ["vertex", "fragment", "kernel"].contains(&word);
    if !msl_tokens(text).iter().any(|token| is_stage(token.text)) {
        return Some("1:1: error: there is no entry point".to_owned());
    }
    attributes::first_mistake(text)
}

type IndexedText<'t> = (usize, &'t str);

/// Judges a batch. Its halves are judged if it is refused, since a mistake in one text may make
/// others look wrong.
fn judge_sound(clang: &Clang, batch: &[IndexedText<'_>]) -> Refusals {
    let judged = |batch: &[IndexedText<'_>]| clang.compile(&unit_text(batch), &["-fsyntax-only"]);
    let together = |batch: &[IndexedText<'_>]| Ok(judged(batch)?.status.success().then(Vec::new));
    let alone = |one: &IndexedText<'_>| {
        let output = judged(&[*one])?;
        let refusal = || MslRefusal { index: one.0, errors: clang_errors(&output.stderr) };
        Ok((!output.status.success()).then(refusal).into_iter().collect())
    };
    halve_refused(batch, &together, &alone)
}

/// Texts side by side, each in a namespace of its own.
fn unit_text(texts: &[IndexedText<'_>]) -> String {
    let mut unit = "#include <metal_stdlib>\n".to_owned();
    for (number, (_, text)) in texts.iter().enumerate() {
        let _ =
            write!(unit, "namespace text{number} {{\n#line 1 \"text\"\n{}\n}}\n", adapt_text(text));
    }
    unit
}

/// clang's errors about a text, a line for each, with Metal's names of types.
fn clang_errors(stderr: &[u8]) -> String {
    let text = String::from_utf8_lossy(stderr);
    let lines: Vec<&str> = text.lines().collect();
    let errors: Vec<String> =
        (0..lines.len()).filter_map(|at| placed_error(&lines[at..])).collect();
    let errors = if errors.is_empty() { text.trim().to_owned() } else { errors.join("\n") };
    TYPES.iter().fold(errors, |errors, (clang, metal)| errors.replace(clang, metal))
}

/// An error with its place. If that is in the headers, a note tells which place of the text led
/// there.
fn placed_error(lines: &[&str]) -> Option<String> {
    let (place, message) = lines.first()?.split_once(": error: ")?;
    let here = |line: &str| line.strip_prefix("text:").map(str::to_owned);
    let notes = lines[1..].iter().take_while(|line| !line.contains(": error: "));
    let noted = || {
        let mut places = notes.filter_map(|line| here(line.split_once(": note: ")?.0));
        places.next()
    };
    let place = here(place).or_else(noted).unwrap_or_else(|| place.to_owned());
    Some(format!("{place}: error: {message}"))
}

/// What the headers call types, and what Metal calls them.
const TYPES: &[(&str, &str)] = &[
    // Only a comparison of vectors gives clang's own vector of `int`.
    ("'int' values", "'bool' values"),
    ("int __attribute__((ext_vector_type(2)))", "metal::bool2"),
    ("int __attribute__((ext_vector_type(3)))", "metal::bool3"),
    ("int __attribute__((ext_vector_type(4)))", "metal::bool4"),
    ("'wchar_t' values", "'int' values"),
    ("wchar_t", "int"),
    ("__lamplight_", ""),
    ("__lamplight::", "metal::"),
];
