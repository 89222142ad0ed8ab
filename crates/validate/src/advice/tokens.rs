//! Advice about the grammar, where naga expects another token.

use std::ops::Range;

use lamplight_bundle::Language;
use lamplight_syntax::words::is_word;

use super::{Mistake, Source};
use crate::foreign::native_text;
use crate::hints::last_word;

/// The advice for a token that is not expected.
pub fn expected(source: &Source<'_>, wanted: &str, mistake: &mut Mistake) {
    let at = mistake.labels.first().map_or(0..0, |(range, _)| range.clone());
    let found = source.slice(&at).to_owned();
    let before = source.text.get(..at.start).unwrap_or_default().trim_end();
    let line = before.rsplit('\n').next().unwrap_or_default();
    let is_next_line = source.slice(&(before.len()..at.start)).contains('\n');
    if operators(&found, line, mistake) || numbers(source, &at, mistake) {
        return;
    }
    match (wanted, found.as_str()) {
        ("{", "=") => mistake.help("`=` assigns: write `==` to compare"),
        ("{", ":") => mistake.help("write `->` before the type of the result"),
        (",", ";") => mistake.help("members end with `,`: write it for each `;`"),
        (";", "[") => array(line, mistake),
        (";", "(") if line.contains('.') => method(line, mistake),
        (";", name) if is_word(name) && line.ends_with(')') && !is_next_line => {
            cast(line, name, mistake);
        }
        _ if wanted == ";" && before.len() < source.text.len() => {
            mistake.missing_semicolon(source.text, before.len(), &at);
        }
        _ => {}
    }
}

fn operators(found: &str, line: &str, mistake: &mut Mistake) -> bool {
    match found {
        "++" | "--" => {
            let name = last_word(line);
            let message = format!("`{found}` is a statement of its own, without a value");
            mistake.message = message;
            match is_word(name) && !line.trim_end().ends_with(';') && !name.is_empty() {
                true => mistake.help(format!(
                    "write `{name}` here, and `{name}{found};` as the next statement"
                )),
                false => mistake.help(format!("write `i{found};`")),
            }
        }
        "and" => mistake.write("&&"),
        "or" => mistake.write("||"),
        "not" => mistake.write("!"),
        _ => return false,
    }
    true
}

/// What follows a number belongs to it.
fn numbers(source: &Source<'_>, at: &Range<usize>, mistake: &mut Mistake) -> bool {
    let before = source.text.get(..at.start).unwrap_or_default();
    let starts = |one: char| one.is_ascii_digit() || matches!(one, '.' | 'f' | 'u' | 'h' | 'i');
    let start = before.rfind(|one| !starts(one)).map_or(0, |at| at + 1);
    let number = &before[start..];
    let digits = number.split('.').next().unwrap_or_default();
    let is_number = number.len() > 1 && digits.bytes().all(|byte| byte.is_ascii_digit());
    if !is_number || digits.is_empty() {
        return false;
    }
    let found = source.slice(at);
    mistake.message = format!("`{number}{found}` is not a number");
    match found {
        "u" | "i" => mistake
            .help(format!("write `{digits}{found}` for an integer, or `{digits}.0` for a float")),
        _ => mistake.write(format!("{digits}.0")),
    }
    true
}

/// `f32[3]` as a type.
fn array(line: &str, mistake: &mut Mistake) {
    let name = last_word(line);
    let of = native_text(Language::Wesl, name).unwrap_or_else(|| name.to_owned());
    mistake.message = "a length stands in the type of an array".to_owned();
    mistake.help(format!("write `array<{of}, N>` with its length for `N`"));
}

/// `v.length()`.
fn method(line: &str, mistake: &mut Mistake) {
    let name = last_word(line);
    let object = line.strip_suffix(name).and_then(|rest| rest.strip_suffix('.'));
    let Some(object) = object.map(last_word) else { return };
    mistake.message = format!("WGSL has no methods, and `{name}` is called like one");
    mistake.write(format!("{name}({object})"));
}

/// `(f32)n`.
fn cast(line: &str, name: &str, mistake: &mut Mistake) {
    let inside = line.trim_end_matches(')');
    let of = last_word(inside);
    if inside.ends_with(&format!("({of}")) && !of.is_empty() {
        let of = native_text(Language::Wesl, of).unwrap_or_else(|| of.to_owned());
        mistake.message = "a conversion is written like a call".to_owned();
        mistake.write(format!("{of}({name})"));
    }
}
