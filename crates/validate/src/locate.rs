//! Finds the place of an error that naga reports without one: the first part of the text without
//! which the error is another one.

use std::ops::Range;

use lamplight_rules::{Place, parts};

/// How many parts a text may have, and how long it may be: it is parsed for each function and each
/// value.
const MOST_PARTS: usize = 512;
const LONGEST: usize = 1 << 16;

/// The statement, or the value or the type of a declaration, that gives an error. `message` gives the
/// error of a text.
pub fn place_of_error(
    text: &str,
    message: &dyn Fn(&str) -> Option<String>,
) -> Option<Range<usize>> {
    let parts = parts(text).filter(|_| text.len() <= LONGEST)?;
    let declared = parts.values.len() + parts.types.len();
    let count = declared + parts.statements.iter().map(Vec::len).sum::<usize>();
    let expected = without_numbers(&message(text).filter(|_| count <= MOST_PARTS)?);
    let is_same = |text: &str| message(text).is_some_and(|one| without_numbers(&one) == expected);
    for statements in parts.statements.iter().filter(|one| !one.is_empty()) {
        if is_same(&blanked(text, statements)) {
            continue;
        }
        // naga reads statements in their order: with those up to the wrong one it is there.
        let kept: Vec<usize> = (1..=statements.len()).collect();
        let fine = kept.partition_point(|kept| !is_same(&blanked(text, &statements[*kept..])));
        return statements.get(fine).map(|statement| statement.range());
    }
    let values = parts.values.iter().map(|place| (place, "0"));
    let mut all = values.chain(parts.types.iter().map(|place| (place, "f32")));
    let found = all.find(|(place, plain)| !is_same(&with_plain(text, **place, plain)));
    found.map(|(place, _)| place.range())
}

/// Handles of naga differ between the texts.
fn without_numbers(message: &str) -> String {
    message.chars().filter(|letter| !letter.is_ascii_digit()).collect()
}

fn blanked(text: &str, places: &[Place]) -> String {
    let mut blank = text.to_owned();
    for place in places {
        let range = place.range();
        blank.replace_range(range.clone(), &" ".repeat(range.len()));
    }
    blank
}

/// The text with something plain in a place.
fn with_plain(text: &str, place: Place, plain: &str) -> String {
    let range = place.range();
    let mut changed = text.to_owned();
    changed.replace_range(range.clone(), &format!("{plain:<width$}", width = range.len()));
    changed
}

#[cfg(test)]
mod tests {
    use super::place_of_error;

    /// An error of texts that hold a word, wherever it is.
    fn place(text: &str) -> Option<&str> {
        let error = |text: &str| text.contains("wrong").then(|| "error 7".to_owned());
        place_of_error(text, &error).map(|range| &text[range])
    }

    #[test]
    fn the_first_part_that_gives_the_error_is_found() {
        let text = "fn a() { let x = 1; } fn b() { let y = 2; let z = wrong; let w = wrong; }";
        assert_eq!(place(text), Some("let z = wrong;"));
        assert_eq!(place("const a = 1; const b = wrong; fn c() { let x = b; }"), Some("wrong"));
        assert_eq!(place("alias A = wrong; var<private> a: A;"), Some("wrong"));
        assert_eq!(place("struct S { a: u32, b: array<wrong, 4> }"), Some("array<wrong, 4>"));
        assert_eq!(place("fn a() { let x = 1; }"), None);
    }
}
