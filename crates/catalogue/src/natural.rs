//! Sorts names with numbers as people do: `7_2` before `7_10`.

use std::cmp::Ordering;

/// Compares names part by part, numbers by their value.
pub fn natural_order(a: &str, b: &str) -> Ordering {
    name_parts(a).cmp(&name_parts(b)).then_with(|| a.cmp(b))
}

/// A part of a name: numbers come before words.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
enum NamePart<'t> {
    Number(u64),
    Word(&'t str),
}

fn name_parts(text: &str) -> Vec<NamePart<'_>> {
    let pieces = text.split(['_', '-', '.']).filter(|piece| !piece.is_empty());
    pieces.map(|piece| piece.parse().map_or(NamePart::Word(piece), NamePart::Number)).collect()
}
