//! Marks: the names that the author's declarations have while naga writes them.
//!
//! A mark holds the number of a declaration and nothing of its name. No keyword, built-in or name
//! of a writer's own looks like one, so each mark in an output is a reference to one of the
//! author's declarations, and nothing else is. Writers put marks into longer names, such as
//! `ConstructMARK`, and one writer names a variable by the mark of its type in lower case.

use std::fmt::Write;

/// The number for names that no output keeps: those of the local variables of stubs, and of entry
/// points, functions and variables that were added.
pub const SCRATCH: u32 = 0;

/// A mark within a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Mark {
    pub start: usize,
    pub end: usize,
    pub number: u32,
    /// In lower case: a variable that the writer named after the declaration.
    pub small: bool,
}

/// The mark of a declaration. It ends with a letter, since naga appends to names that end with a
/// digit. It has no underscore, since naga removes some of those.
pub fn write_mark(number: u32) -> String {
    let mut mark = "Zq".to_owned();
    for digit in format!("{number:x}").chars() {
        let letter = digit.to_digit(16).and_then(|digit| char::from_digit(digit + 10, 26 + 10));
        let _ = letter.map_or(Ok(()), |letter| mark.write_char(letter));
    }
    mark + "qz"
}

/// The first mark at or after a place.
pub fn find_mark(text: &str, from: usize) -> Option<Mark> {
    let bytes = text.as_bytes();
    let mut at = from;
    while let Some(found) = text.get(at..).and_then(|rest| rest.find("qz")) {
        let end = at + found + 2;
        let is_digit = |byte: &&u8| matches!(byte, b'a'..=b'p');
        let digits = bytes[from..at + found].iter().rev().take_while(is_digit).count();
        let first = (at + found).checked_sub(digits + 2).filter(|first| *first >= from);
        if let (Some(start), 1..=7) = (first, digits)
            && matches!(&bytes[start..start + 2], b"Zq" | b"zq")
        {
            let digit = |number: u32, byte: &u8| number << 4 | u32::from(byte - b'a');
            let number = bytes[start + 2..end - 2].iter().fold(0, digit);
            return Some(Mark { start, end, number, small: bytes[start] == b'z' });
        }
        at += found + 1;
    }
    None
}

/// Whether a text has something that looks like a mark.
pub fn occurs_in(text: &str) -> bool {
    find_mark(text, 0).is_some()
}
