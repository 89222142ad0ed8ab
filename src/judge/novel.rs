//! Finds texts that have something in them which no text before them had.

use std::collections::HashSet;

use super::Output;
use crate::parse::words::{LexemeKind, pieces};

/// The outputs with two neighbouring tokens that no output before them had next to each other. If a
/// compiler cannot handle some construct in texts of this kind, it fails on one of these outputs
/// too, since operations, types and their operands are neighbours.
pub fn novel_outputs<'o>(outputs: &[&'o Output]) -> Result<Vec<&'o Output>, String> {
    let (mut lines, mut pairs) = (HashSet::new(), HashSet::new());
    let mut found = Vec::new();
    for output in outputs {
        let text = output.text()?;
        let mut is_new = false;
        // Most lines also occur in other outputs.
        for line in text.lines().map(str::trim) {
            if !lines.contains(line) {
                lines.insert(line.to_owned());
                is_new |= add_pairs(line, &mut pairs);
            }
        }
        if is_new {
            found.push(*output);
        }
    }
    Ok(found)
}

/// Adds the pairs of a line. Returns whether one of them is new.
fn add_pairs(line: &str, pairs: &mut HashSet<(String, String)>) -> bool {
    let tokens = line_tokens(line);
    let ends = [""].into_iter().chain(tokens.iter().copied());
    let (mut before, mut is_new) = (String::new(), false);
    for token in ends.skip(1).chain([""]) {
        is_new |= pairs.insert((before, token.to_owned()));
        before = token.to_owned();
    }
    is_new
}

/// The tokens of a line: words, other characters, and a common token for all numbers.
fn line_tokens(line: &str) -> Vec<&str> {
    let solid = pieces(line).filter(|piece| piece.kind != LexemeKind::Blank);
    solid.map(|piece| if piece.kind == LexemeKind::Number { "0" } else { piece.text }).collect()
}
