//! Turns naga's errors into diagnostics about the author's text.

use std::ops::Range;

use naga::Module;
use naga::front::wgsl;
use naga::valid::ValidationError;

use super::advice::convert::with_short_types;
use super::advice::{self, Mistake};
use super::foreign::native_text;
use super::hints::{enclosing_call, last_word};
use super::locate::place_of_error;
use super::{halves, hints, parse_wgsl, uses, words};
use lamplight_bundle::Language;
use lamplight_compose::{Composed, Part};
use lamplight_diagnostic::source::Span;
use lamplight_diagnostic::{Code, Diagnostic, codes};
use lamplight_syntax::words::is_word;

/// An error of the WGSL parser, with all its labels and notes.
///
/// naga does not publish the kinds of these errors, so its sentences are used, in our style.
pub fn wgsl_error(composed: &Composed, error: &wgsl::ParseError) -> Diagnostic {
    let message = match error.message() {
        // What follows are types as naga writes them for its developers.
        message if message.starts_with(advice::OPERANDS) => {
            "these operands do not go together".to_owned()
        }
        message => as_sentence(message),
    };
    let labels =
        error.labels().filter_map(|(span, label)| Some((span.to_range()?, as_sentence(label))));
    let notes = error.notes().map(|note| {
        as_sentence(&about_parameter(composed, error, note).unwrap_or(note.to_owned()))
    });
    let mut mistake =
        Mistake { message: message.clone(), labels: labels.collect(), notes: notes.collect() };
    let place = mistake.labels.first().map(|(range, _)| range.clone());
    advice::advise_parsed(&composed.text, &mut mistake);
    let mut diagnostic = mistaken(composed, codes::WGSL_ERROR, mistake);
    if diagnostic.labels.is_empty() {
        let message = |text: &str| Some(parse_wgsl(text).err()?.message().to_owned());
        if let Some(range) = place_of_error(&composed.text, &message) {
            let compared =
                advice::advise_compared(&composed.text, error.message(), &range, &message);
            diagnostic = match compared {
                Some(compared) => mistaken(composed, codes::WGSL_ERROR, compared),
                None => label_or_note(diagnostic, composed, Some(range), "in this part"),
            };
        }
    }
    if let Some(name) = quoted_after(UNKNOWN, &message) {
        hints::hint_unknown(diagnostic, composed, name, place)
    } else if let Some(name) = quoted_after(NO_MEMBER, &message) {
        hints::hint_member(diagnostic, composed, name)
    } else {
        advised(diagnostic, composed, &message, place)
    }
}

/// An error with the types of the author, at the author's places.
fn mistaken(composed: &Composed, code: &'static Code, mistake: Mistake) -> Diagnostic {
    let Mistake { message, labels, notes } = mistake;
    let worded = |text: &str| with_short_types(text, &composed.text);
    let mut diagnostic = Diagnostic::error(code, worded(&message));
    for (range, label) in labels {
        diagnostic = label_or_note(diagnostic, composed, Some(range), &worded(&label));
    }
    notes.iter().fold(diagnostic, |diagnostic, note| diagnostic.note(worded(note)))
}

/// What a matrix is made of, for one that was made of something else.
fn matrix_advice(message: &str) -> Option<String> {
    let ty = message.strip_prefix("type `")?.strip_suffix("` is not constructible")?;
    let [columns @ b'2'..=b'4', b'x', rows @ b'2'..=b'4', ..] = ty.strip_prefix("mat")?.as_bytes()
    else {
        return None;
    };
    let (columns, rows) = (columns - b'0', rows - b'0');
    Some(format!("help: `{ty}` takes {columns} columns, or {} numbers", columns * rows))
}

/// What to do about a parameter that is assigned to, where naga's note takes it for a `let`.
fn about_parameter(composed: &Composed, error: &wgsl::ParseError, note: &str) -> Option<String> {
    let name = note.strip_prefix("consider declaring `")?.split('`').next()?;
    let is_parameter = error.labels().any(|(span, _)| {
        let range = span.to_range().unwrap_or_default();
        let before = composed.text.get(..range.start).unwrap_or_default().trim_end();
        composed.text.get(range) == Some(name) && before.ends_with(['(', ',', ')'])
    });
    is_parameter
        .then(|| format!("help: a parameter cannot change; copy it: `var changed = {name};`"))
}

/// How naga's sentence begins about a member that there is not.
const NO_MEMBER: &[&str] = &["invalid field accessor `"];

/// Adds advice to naga's sentences that say what is wrong and not what is right.
fn advised(
    diagnostic: Diagnostic,
    composed: &Composed,
    message: &str,
    place: Option<Range<usize>>,
) -> Diagnostic {
    if halves::is_about_exponent(message) {
        return diagnostic.note(halves::ADVICE);
    }
    let Some(place) = place else { return diagnostic };
    let before = composed.text.get(..place.start).unwrap_or_default().trim_end();
    if message.starts_with("expected assignment or increment/decrement") {
        let (ty, name) = (last_word(before), composed.text.get(place).unwrap_or_default());
        return match is_word(ty) && is_word(name) {
            true => diagnostic.note(format!(
                "help: WGSL declares with a keyword: `let {name} = ...;`, or `var {name}: {} = ...;` \
                 if it changes",
                native_text(Language::Wesl, ty).unwrap_or_else(|| ty.to_owned())
            )),
            false => diagnostic,
        };
    }
    if let Some(advice) = matrix_advice(message) {
        return diagnostic.note(advice);
    }
    if message.starts_with("automatic conversions cannot convert") {
        return match enclosing_call(before) {
            Some(name) => hints::note_signatures(diagnostic, composed, name),
            None => diagnostic,
        };
    }
    diagnostic
}

/// How naga's sentences begin before a name that nothing declares.
const UNKNOWN: &[&str] =
    &["no definition in scope for identifier: `", "unknown type: `", "unknown identifier: `"];

/// What stands in backticks at the end of a sentence that begins in one of these ways.
fn quoted_after<'m>(starts: &[&str], message: &'m str) -> Option<&'m str> {
    let rest = starts.iter().find_map(|start| message.strip_prefix(start))?;
    rest.strip_suffix('`')
}

/// An error of the validator as a diagnostic, with its spans as labels.
pub fn validation_error(
    composed: &Composed,
    module: &Module,
    error: &naga::WithSpan<ValidationError>,
) -> Diagnostic {
    // The shortest span is the most precise, so it becomes the place of the diagnostic. The span of
    // a type comes last: it is where the type was first written, which may be anywhere.
    let mut spans: Vec<_> =
        error.spans().map(|(span, context)| (span.to_range(), span_kind(context))).collect();
    spans.sort_by_key(|(range, words)| {
        (*words == TYPE, range.as_ref().map_or(usize::MAX, ExactSizeIterator::len))
    });
    let sentence = words::validation_words(module, error.as_inner());
    let code = sentence.code.unwrap_or(codes::WGSL_ERROR);
    let own = sentence_labels(&sentence, &spans);
    let mut mistake = Mistake { message: sentence.message, labels: own, notes: Vec::new() };
    if let Some(wrong) = &sentence.wrong {
        advice::advise_typed(&composed.text, wrong, &mut mistake);
    }
    // What the function is, its name tells.
    if mistake.labels.len() > 1 {
        let whole = mistake.labels.iter().map(|(_, label)| label == FUNCTION).collect::<Vec<_>>();
        let mut whole = whole.iter();
        mistake.labels.retain(|_| whole.next() != Some(&true));
    }
    let diagnostic = mistaken(composed, code, mistake);
    let diagnostic = label_use(diagnostic, composed, module, error.as_inner());
    let diagnostic = label_named(diagnostic, composed, error.as_inner());
    sentence.notes.into_iter().fold(diagnostic, |diagnostic, note| {
        diagnostic.note(with_short_types(&note, &composed.text))
    })
}

/// The places of an error of the validator, the most precise one first.
fn sentence_labels(
    sentence: &words::Sentence,
    spans: &[(Option<Range<usize>>, &'static str)],
) -> Vec<(Range<usize>, String)> {
    // A value within the statement is the better place.
    let is_within = |statement: &Range<usize>| {
        spans.iter().any(|(range, words)| {
            *words == VALUE
                && range.as_ref().is_some_and(|range| {
                    statement.start <= range.start && range.end <= statement.end
                })
        })
    };
    let statement = sentence.statement.and_then(|span| span.to_range());
    let statement = statement.filter(|statement| !is_within(statement));
    let of_statement = statement.into_iter().map(|range| (range, "this statement".to_owned()));
    let of_spans =
        spans.iter().filter_map(|(range, words)| Some((range.clone()?, (*words).to_owned())));
    let beside = sentence.beside.iter();
    let of_beside = beside.filter_map(|(span, words)| Some((span.to_range()?, words.clone())));
    of_statement.chain(of_spans).chain(of_beside).collect()
}

/// Adds a label to a diagnostic about a type without a name: where it is first used.
fn label_use(
    diagnostic: Diagnostic,
    composed: &Composed,
    module: &Module,
    error: &ValidationError,
) -> Diagnostic {
    let ValidationError::Type { handle, name, source: _ } = error else { return diagnostic };
    if !diagnostic.labels.is_empty() || !name.is_empty() {
        return diagnostic;
    }
    let span = match module.types[*handle].inner.scalar() {
        Some(scalar) => uses::first_scalar(module, scalar),
        None => uses::first_use(module, &|ty| ty == *handle),
    };
    match span.to_range().and_then(|range| composed.map.lookup(range)) {
        Some(place) => diagnostic.at(place, "it is used here"),
        None => diagnostic,
    }
}

/// Adds a label to a diagnostic that has none: at what naga names in the error, or else at the first
/// declaration that an author wrote.
fn label_named(diagnostic: Diagnostic, composed: &Composed, error: &ValidationError) -> Diagnostic {
    if !diagnostic.labels.is_empty() {
        return diagnostic;
    }
    let (name, words) = match error {
        ValidationError::EntryPoint { name, .. } => (name.as_str(), "this entry point"),
        ValidationError::Function { name, .. } => (name.as_str(), "this function"),
        ValidationError::GlobalVariable { name, .. } => (name.as_str(), "this variable"),
        ValidationError::Constant { name, .. } => (name.as_str(), "this constant"),
        ValidationError::Override { name, .. } => (name.as_str(), "this override"),
        ValidationError::Type { name, .. } => (name.as_str(), TYPE),
        ValidationError::InvalidHandle(_)
        | ValidationError::Corrupted
        | ValidationError::Layouter(_)
        | ValidationError::ConstExpression { .. }
        | ValidationError::ArraySizeError { .. } => ("", "in this module"),
    };
    match (name_place(composed, name), first_place(composed)) {
        (Some(span), _) => diagnostic.at(span, words),
        (None, Some(span)) => diagnostic.at(span, "in this module"),
        (None, None) => diagnostic,
    }
}

/// Where an author wrote the name in its declaration.
fn name_place(composed: &Composed, name: &str) -> Option<Span> {
    if name.is_empty() {
        return None;
    }
    let declares = |part: &&Part| part.names.iter().any(|found| found == name);
    let range = match composed.parts.iter().find(declares) {
        Some(part) => part.range.clone(),
        None => 0..composed.text.len(),
    };
    let text = composed.text.get(range.clone())?;
    let found: Vec<usize> = text
        .match_indices(name)
        .map(|(at, _)| at)
        .filter(|at| !continues(&text[..*at]) && !starts_word(&text[at + name.len()..]))
        .collect();
    // Comments before the declaration may have the name too.
    let is_declared = |at: &&usize| {
        let before = text[..**at].trim_end();
        let keyword = DECLARING.iter().find_map(|keyword| before.strip_suffix(keyword));
        before.ends_with('>') || keyword.is_some_and(|rest| !continues(rest))
    };
    let start = range.start + found.iter().find(is_declared).or(found.last())?;
    composed.map.lookup(start..start + name.len())
}

/// What comes before a declared name.
const DECLARING: [&str; 7] = ["fn", "var", "const", "override", "struct", "alias", "void"];

/// Whether a word that ends a text could go on.
fn continues(text: &str) -> bool {
    text.chars().next_back().is_some_and(|last| last == '_' || last.is_alphanumeric())
}

fn starts_word(text: &str) -> bool {
    text.chars().next().is_some_and(|first| first == '_' || first.is_alphanumeric())
}

/// The first declaration that comes from an author's file.
fn first_place(composed: &Composed) -> Option<Span> {
    let mut parts = composed.parts.iter();
    parts
        .find_map(|part| composed.map.lookup(part.range.clone()))
        .or_else(|| composed.map.lookup(0..1))
}

/// Adds a label if the range comes from an author's file, else a note that quotes the composed
/// text.
fn label_or_note(
    diagnostic: Diagnostic,
    composed: &Composed,
    range: Option<Range<usize>>,
    label: &str,
) -> Diagnostic {
    let Some(range) = range else {
        return if label.is_empty() || label == "here" {
            diagnostic
        } else {
            diagnostic.note(label)
        };
    };
    if let Some(span) = composed.map.lookup(range.clone()) {
        return diagnostic.at(span, label);
    }
    let quoted = composed.text.get(range).and_then(|text| text.lines().next()).unwrap_or_default();
    diagnostic.note(format!("{label}: in text the composer wrote, `{quoted}`"))
}

/// The label for a value.
const VALUE: &str = "this expression";

/// The label for a function.
const FUNCTION: &str = "this function";

/// The label for a type.
const TYPE: &str = "this type";

/// What a span of the validator is, since naga names the Rust type of the arena.
fn span_kind(context: &str) -> &'static str {
    const KINDS: [(&str, &str); 8] = [
        ("::GlobalVariable", "this variable"),
        ("::LocalVariable", "this variable"),
        ("::Expression", VALUE),
        ("::Function", FUNCTION),
        ("::Constant", "this constant"),
        ("::Override", "this override"),
        ("::EntryPoint", "this entry point"),
        ("::Type", TYPE),
    ];
    KINDS.iter().find(|(name, _)| context.contains(name)).map_or("here", |(_, words)| words)
}

/// naga's message in our style: it starts in lower case, unless with a name, and quotes the
/// shader's text in backticks.
fn as_sentence(message: &str) -> String {
    let message = message.trim().replace(['"', '\''], "`");
    // Types that only constants have.
    let message =
        message.replace("{AbstractFloat}", "AbstractFloat").replace("{AbstractInt}", "AbstractInt");
    // An apostrophe is not a quote.
    let message =
        APOSTROPHES.iter().fold(message, |message, (wrong, right)| message.replace(wrong, right));
    let first_word = message.split(|c: char| !c.is_alphanumeric()).next().unwrap_or_default();
    let is_name = first_word.chars().skip(1).any(char::is_uppercase);
    match message.chars().next() {
        Some(first) if !is_name && first.is_uppercase() => {
            first.to_lowercase().chain(message.chars().skip(1)).collect()
        }
        _ => message,
    }
}

const APOSTROPHES: &[(&str, &str)] =
    &[("n`t ", "n't "), ("`s ", "'s "), ("s` ", "s' "), ("`re ", "'re "), ("`ll ", "'ll ")];
