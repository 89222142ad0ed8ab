//! Finds texts that have something in them which no text before them had.

use std::collections::HashSet;

use super::Output;
use lamplight_syntax::words::{LexemeKind, pieces};

/// The outputs with two neighbouring tokens that no output before them had next to each other. If a
/// compiler cannot handle some construct in texts of this kind, it fails on one of these outputs
/// too, since operations, types and their operands are neighbours.
pub fn novel_outputs<'o>(outputs: &[&'o Output]) -> Result<Vec<&'o Output>, String> {
    let (mut seen, mut found) = (SeenText::default(), Vec::new());
    for output in outputs {
        if seen.add(&output.text()?).pair {
            found.push(*output);
        }
    }
    Ok(found)
}

/// The lines and the pairs of neighbouring tokens of all texts so far. Lines that differ only in
/// the numbers of generated names (`_e12`, `color_3`) count as the same.
#[derive(Debug, Default)]
pub struct SeenText {
    /// Lines as they are. Most lines of a text also occur in other texts.
    known: HashSet<String>,
    /// Lines with 0 for these numbers.
    lines: HashSet<String>,
    pairs: HashSet<(String, String)>,
}

/// What a text has that no text before it had.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
pub struct Novelty {
    /// A line.
    pub line: bool,
    /// Two neighbouring tokens.
    pub pair: bool,
}

impl SeenText {
    /// Adds a text, and says what of it is new.
    pub fn add(&mut self, text: &str) -> Novelty {
        let mut novelty = Novelty::default();
        for line in text.lines().map(str::trim) {
            if self.known.contains(line) {
                continue;
            }
            self.known.insert(line.to_owned());
            let line = without_numbers(line);
            if self.lines.insert(line.clone()) {
                novelty = Novelty { line: true, pair: self.add_pairs(&line) || novelty.pair };
            }
        }
        novelty
    }

    /// Adds the pairs of a line. Returns whether one of them is new.
    fn add_pairs(&mut self, line: &str) -> bool {
        let tokens = line_tokens(line);
        let ends = [""].into_iter().chain(tokens.iter().copied());
        let (mut before, mut is_new) = (String::new(), false);
        for token in ends.skip(1).chain([""]) {
            is_new |= self.pairs.insert((before, token.to_owned()));
            before = token.to_owned();
        }
        is_new
    }
}

/// The line with 0 for the number of each generated name: digits at the end of a word, after `_` or
/// `_e`. Names of types end otherwise: `vec3`, `float4x4`.
pub fn without_numbers(line: &str) -> String {
    let (mut to, mut done) = (String::with_capacity(line.len()), 0);
    for word in pieces(line).filter(|piece| piece.kind == LexemeKind::Word) {
        let stem = word.text.trim_end_matches(|last: char| last.is_ascii_digit());
        if stem.len() < word.text.len() && (stem.ends_with('_') || stem.ends_with("_e")) {
            to += &line[done..word.at + stem.len()];
            to += "0";
            done = word.end();
        }
    }
    to + &line[done..]
}

/// The tokens of a line: words, other characters, and a common token for all numbers.
fn line_tokens(line: &str) -> Vec<&str> {
    let solid = pieces(line).filter(|piece| piece.kind != LexemeKind::Blank);
    solid.map(|piece| if piece.kind == LexemeKind::Number { "0" } else { piece.text }).collect()
}
