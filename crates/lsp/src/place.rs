//! Places as editors name them: lines and UTF-16 units of a file's address.

use std::ops::Range;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use lamplight_syntax::words::word_around;

/// The address of a file.
pub fn file_address(path: &Path) -> String {
    let mut text = "file://".to_owned();
    for byte in path.to_string_lossy().replace('\\', "/").bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'/' | b'-' | b'_' | b'.' | b'~' => {
                text.push(byte as char);
            }
            _ => text += &format!("%{byte:02X}"),
        }
    }
    text
}

/// The file of an address; nothing for other kinds of addresses.
pub fn path_of_address(address: &str) -> Option<PathBuf> {
    let text = address.strip_prefix("file://")?;
    let mut bytes = Vec::new();
    let mut rest = text.bytes();
    while let Some(byte) = rest.next() {
        if byte != b'%' {
            bytes.push(byte);
            continue;
        }
        let digits = [rest.next()?, rest.next()?];
        bytes.push(u8::from_str_radix(std::str::from_utf8(&digits).ok()?, 16).ok()?);
    }
    let path = PathBuf::from(String::from_utf8(bytes).ok()?);
    // WebAssembly has no files, but addresses that begin at a root.
    (path.is_absolute() || cfg!(target_family = "wasm") && path.has_root()).then_some(path)
}

/// The byte of a position; the end of the line or the text where it is beyond.
pub fn byte_of_position(text: &str, position: &Value) -> Option<usize> {
    let line = usize::try_from(position.get("line")?.as_u64()?).ok()?;
    let units = usize::try_from(position.get("character")?.as_u64()?).ok()?;
    let mut start = 0;
    for _ in 0..line {
        match text[start..].find('\n') {
            Some(end) => start += end + 1,
            None => return Some(text.len()),
        }
    }
    let line = &text[start..];
    let line = &line[..line.find('\n').unwrap_or(line.len())];
    let mut seen = 0;
    for (at, letter) in line.char_indices() {
        if seen >= units {
            return Some(start + at);
        }
        seen += letter.len_utf16();
    }
    Some(start + line.len())
}

/// Bytes between two of [`Lines::marks`].
const STEP: usize = 256;

/// Lines of a text, so that many positions cost little, in long lines too.
pub struct Lines<'t> {
    text: &'t str,
    starts: Vec<usize>,
    /// For each step of the text, the character that it begins in, and the UTF-16 units before that
    /// character. None in a text of ASCII, where each byte is a unit.
    marks: Vec<(usize, usize)>,
}

impl<'t> Lines<'t> {
    pub fn new(text: &'t str) -> Self {
        let starts = std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1));
        let marks = if text.is_ascii() { Vec::new() } else { unit_marks(text) };
        Self { text, starts: starts.collect(), marks }
    }

    /// Line and UTF-16 unit of a byte.
    pub fn units(&self, byte: usize) -> (usize, usize) {
        let byte = self.text.floor_char_boundary(byte.min(self.text.len()));
        let line = self.starts.partition_point(|start| *start <= byte) - 1;
        (line, self.units_before(byte) - self.units_before(self.starts[line]))
    }

    /// The UTF-16 units before a character of the text.
    fn units_before(&self, byte: usize) -> usize {
        match self.marks.get(byte / STEP) {
            Some((at, units)) => units + self.text[*at..byte].encode_utf16().count(),
            None => byte,
        }
    }

    pub fn position(&self, byte: usize) -> Value {
        let (line, character) = self.units(byte);
        json!({ "line": line, "character": character })
    }

    pub fn range(&self, range: Range<usize>) -> Value {
        json!({ "start": self.position(range.start), "end": self.position(range.end) })
    }
}

/// A mark for each step of a text.
fn unit_marks(text: &str) -> Vec<(usize, usize)> {
    let (mut last, mut units) = (0, 0);
    let mark = |step: usize| {
        let at = text.floor_char_boundary(step);
        units += text[last..at].encode_utf16().count();
        last = at;
        (at, units)
    };
    (0..=text.len()).step_by(STEP).map(mark).collect()
}

/// The identifier around a byte.
pub fn word_at_byte(text: &str, byte: usize) -> Range<usize> {
    let byte = text.floor_char_boundary(byte.min(text.len()));
    word_around(text, byte..byte)
}
