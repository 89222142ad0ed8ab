//! Splits texts at their declarations.

use super::spirv::Take;

/// Passes the pieces of a text to `take`. A piece ends after a line that closes what the lines before
/// have opened: one that begins with a brace, an empty one, or one that is not indented and ends with
/// a semicolon. All target languages are written so, with no need to read them. Always returns true.
pub fn split(bytes: &[u8], take: Take<'_>) -> bool {
    let mut from = 0;
    let mut to = 0;
    for line in bytes.split_inclusive(|byte| *byte == b'\n') {
        to += line.len();
        if ends_piece(line) {
            take(&bytes[from..to], &[], &[]);
            from = to;
        }
    }
    if from < to {
        take(&bytes[from..to], &[], &[]);
    }
    true
}

fn ends_piece(line: &[u8]) -> bool {
    let text = line.trim_ascii_end();
    match text.first() {
        None | Some(b'}') => true,
        Some(b' ' | b'\t') => false,
        Some(_) => text.ends_with(b";"),
    }
}
