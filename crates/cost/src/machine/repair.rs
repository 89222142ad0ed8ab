//! Reads the lines of the text, and those that LLVM's disassembler loses.
//!
//! It refuses some loads into scalar registers that the hardware accepts, prints `(invalid
//! instruction)` and goes on one word later, within the operands. So a few instructions behind it
//! are read wrongly, until a boundary is met by chance. The words stand behind each line: they are
//! split again by the lengths of GFX10's encodings.

use std::collections::BTreeMap;

use super::MachineError;
use super::text::{Instruction, Line, parse_instruction};

/// What stands where the disassembler gives up.
const INVALID: &str = "(invalid instruction)";

/// The lines of a text, without empty ones.
pub fn readable_lines(text: &str) -> Result<Vec<Line>, MachineError> {
    let raw: Vec<&str> = text.lines().filter(|line| !line.trim().is_empty()).collect();
    let mut lines = Vec::new();
    let mut index = 0;
    while let Some(line) = raw.get(index) {
        if line.trim_start().starts_with(INVALID) {
            let (read, next) = lost_instructions(&raw, index)?;
            lines.extend(read.into_iter().map(Line::Instruction));
            index = next;
            continue;
        }
        lines.push(parse_line(line)?);
        index += 1;
    }
    Ok(lines)
}

fn parse_line(line: &str) -> Result<Line, MachineError> {
    let (code, _) = split_words(line);
    if let Some(label) = code.strip_suffix(':') {
        return Ok(Line::Label(label.to_owned()));
    }
    let repeated = code.strip_prefix("(then repeated ").and_then(|rest| rest.split_once(' '));
    if let Some((count, _)) = repeated {
        let count = count.parse::<i64>();
        return count.map(Line::Repeated).map_err(|_| MachineError::Unreadable(code.to_owned()));
    }
    Ok(Line::Instruction(parse_instruction(code)))
}

/// The code of a line, and its words.
fn split_words(line: &str) -> (&str, Vec<u32>) {
    let (code, words) = line.split_once(';').unwrap_or((line, ""));
    let word = |word: &str| u32::from_str_radix(word, 16).ok();
    (code.trim(), words.split_whitespace().filter_map(word).collect())
}

/// The instructions from a line that could not be read on, up to where both ways to split the words
/// meet again; and the index of the line behind them.
fn lost_instructions(
    raw: &[&str],
    first: usize,
) -> Result<(Vec<Instruction>, usize), MachineError> {
    let names = names_by_opcode(raw);
    let mut words = Vec::new();
    let (mut read, mut at, mut next) = (Vec::new(), 0, first);
    while at < words.len() || next == first {
        let line = raw.get(next).copied().unwrap_or_default();
        words.extend(split_words(line).1);
        next += 1;
        while let Some(length) = words.get(at..).and_then(length_of) {
            if at + length > words.len() {
                break;
            }
            read.push(instruction_of(&names, words[at])?);
            at += length;
        }
        let unread = words.get(at..).unwrap_or_default();
        if next >= raw.len() || unread.len() > 4 {
            return Err(MachineError::Unreadable(format!("{words:08x?}")));
        }
    }
    Ok((read, next))
}

/// The words of the instruction at the beginning, by its encoding. Nothing where the encoding is
/// not known, or where the second word, which tells of a literal, is missing.
fn length_of(words: &[u32]) -> Option<usize> {
    let first = *words.first()?;
    let has_literal = |field: u32| field & 0x1ff == 0xff;
    match first >> 26 {
        // Scalar loads, buffers, textures, and exports.
        0b11_1101 | 0b11_1000 | 0b11_1110 => Some(2),
        // Vector instructions with three sources.
        0b11_0101 | 0b11_0011 => {
            let second = *words.get(1)?;
            let literal = [0, 9, 18].iter().any(|shift| has_literal(second >> shift));
            Some(if literal { 3 } else { 2 })
        }
        // Scalar instructions: with a constant of 16 bits, of control, and with one or two sources.
        _ if first >> 28 == 0b1011 && first >> 23 < 0b1_0111_1101 => Some(1),
        _ if first >> 23 == 0b1_0111_1111 => Some(1),
        _ if first >> 30 == 0b10 => {
            let is_single = first >> 23 == 0b1_0111_1101;
            let sources = [first & 0xff, if is_single { 0 } else { first >> 8 & 0xff }];
            Some(if sources.contains(&0xff) { 2 } else { 1 })
        }
        // Vector instructions with one or two sources.
        code if code >> 5 == 0 => Some(if has_literal(first) { 2 } else { 1 }),
        _ => None,
    }
}

/// The part of a first word that distinguishes the instructions of an encoding.
fn opcode_of(word: u32) -> u32 {
    match word >> 26 {
        0b11_1101 => word & 0xfffc_0000,
        // The bits from 16 on, without the modifiers below.
        0b11_0101 | 0b11_0011 => word & 0xffff_0000,
        code if code >> 3 == 0b111 => word & 0xfffc_0000,
        // Scalar instructions: one source, a comparison or control, and all others.
        _ if word >> 23 == 0b1_0111_1101 => word & 0xff80_ff00,
        _ if word >> 24 == 0b1011_1111 => word & 0xffff_0000,
        code if code >> 4 == 0b10 => word & 0xff80_0000,
        // One source, or a comparison.
        0b01_1111 if word >> 25 == 0b11_1111 => word & 0xfe00_01fe,
        0b01_1111 => word & 0xfffe_0000,
        _ => word & 0xfe00_0000,
    }
}

/// The names of what could be read, by opcode. A line behind lost ones may be wrong, so the first
/// one that has an opcode counts.
fn names_by_opcode<'t>(raw: &[&'t str]) -> BTreeMap<u32, &'t str> {
    let mut names = BTreeMap::new();
    for line in raw {
        let (code, words) = split_words(line);
        if let (Some(word), false) = (words.first(), code.starts_with(INVALID)) {
            names.entry(opcode_of(*word)).or_insert(code);
        }
    }
    names
}

fn instruction_of(names: &BTreeMap<u32, &str>, word: u32) -> Result<Instruction, MachineError> {
    // Of some encodings, all instructions have one unit. What the disassembler refuses are loads of
    // four or more scalars.
    let whole = match word >> 26 {
        0b11_1101 => Some("s_buffer_load_dwordx4"),
        0b11_1000 => Some("buffer_load_dword"),
        0b11_1110 => Some("exp"),
        _ => None,
    };
    if let Some(name) = whole {
        return Ok(parse_instruction(name));
    }
    let known = names.get(&opcode_of(word));
    let known = known.ok_or_else(|| MachineError::Unreadable(format!("{word:08x}")))?;
    // The operands are those of another place.
    Ok(Instruction { operands: Vec::new(), ..parse_instruction(known) })
}
