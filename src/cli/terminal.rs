//! The one way to standard output and standard error.
//!
//! What commands print holds names, paths and messages from elsewhere: a bundle's programs, a
//! cached message, an argument that is echoed. A terminal obeys control characters, so that such a
//! name could hide lines, move the cursor or turn writing around. Everything printed passes
//! [`Escaping`], whatever its form; bytes that are a result ([`data`]) pass it where the other end
//! is a terminal, and stay as they are in pipes and files. No other file of the command line may
//! name the streams of the standard library: `house::one_way_to_the_terminal` looks.

use std::io::{self, IsTerminal, Write};

use crate::diagnostic::is_obeyed;

/// Text for people or programs, on standard output.
pub fn stdout() -> Escaping<io::Stdout> {
    Escaping::new(io::stdout())
}

/// Text for people or programs, on standard error.
pub fn stderr() -> Escaping<io::Stderr> {
    Escaping::new(io::stderr())
}

/// Text with colours of ours, on standard error.
pub fn coloured() -> Escaping<io::Stderr> {
    Escaping { out: io::stderr(), has_colours: true, cut: Vec::new() }
}

/// Text of somebody else's within text of ours.
pub fn escaped(text: &str) -> String {
    let mut bytes = Vec::new();
    // Writing to memory does not fail.
    let _ = Escaping::new(&mut bytes).write_all(text.as_bytes());
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Whether a person reads standard output.
pub fn is_terminal() -> bool {
    io::stdout().is_terminal()
}

/// Whether a person reads standard error.
pub fn is_person() -> bool {
    io::stderr().is_terminal()
}

/// Writes a result, such as a shader: byte by byte as it is, unless a terminal would obey it.
pub fn data(bytes: &[u8]) -> io::Result<()> {
    match is_terminal() {
        true => stdout().write_all(bytes),
        false => io::stdout().write_all(bytes),
    }
}

/// Sends what was written to standard output on its way.
pub fn flush() -> io::Result<()> {
    io::stdout().flush()
}

/// Writes what a terminal would obey as `\u001b`, which is the same character in JSON.
#[derive(Debug)]
pub struct Escaping<W: Write> {
    out: W,
    /// Whether sequences that choose a colour pass.
    has_colours: bool,
    /// The beginning of a character whose other bytes are not written yet.
    cut: Vec<u8>,
}

impl<W: Write> Escaping<W> {
    pub fn new(out: W) -> Self {
        Self { out, has_colours: false, cut: Vec::new() }
    }

    fn text(&mut self, text: &str) -> io::Result<()> {
        let mut rest = text;
        while let Some(at) = rest.find(is_obeyed) {
            let (before, after) = rest.split_at(at);
            self.out.write_all(before.as_bytes())?;
            let colour = if self.has_colours { colour(after) } else { 0 };
            if colour > 0 {
                self.out.write_all(&after.as_bytes()[..colour])?;
                rest = &after[colour..];
                continue;
            }
            let mut characters = after.chars();
            if let Some(found) = characters.next() {
                write!(self.out, "\\u{:04x}", u32::from(found))?;
            }
            rest = characters.as_str();
        }
        self.out.write_all(rest.as_bytes())
    }
}

/// Bytes of the sequence that chooses a colour, if the text begins with one.
fn colour(text: &str) -> usize {
    let Some(rest) = text.strip_prefix("\u{1b}[") else { return 0 };
    let end = rest.find(|letter: char| !(letter.is_ascii_digit() || letter == ';'));
    end.filter(|end| rest[*end..].starts_with('m')).map_or(0, |end| end + 3)
}

impl<W: Write> Write for Escaping<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let joined = match self.cut.is_empty() {
            true => bytes.to_vec(),
            false => [std::mem::take(&mut self.cut).as_slice(), bytes].concat(),
        };
        let whole = whole(&joined);
        let text = String::from_utf8_lossy(&joined[..whole]).into_owned();
        self.text(&text)?;
        self.cut = joined[whole..].to_vec();
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

/// A character that was cut is written at the latest with the writer's end.
impl<W: Write> Drop for Escaping<W> {
    fn drop(&mut self) {
        let rest = String::from_utf8_lossy(&std::mem::take(&mut self.cut)).into_owned();
        let _ = self.text(&rest);
    }
}

/// Bytes before a character that the end cuts.
fn whole(bytes: &[u8]) -> usize {
    let tail = bytes.len().saturating_sub(3);
    let start = (tail..bytes.len()).rev().find(|at| bytes[*at] & 0xc0 != 0x80);
    match start {
        Some(at) if bytes[at] >= 0xc0 => {
            let length = if bytes[at] >= 0xf0 {
                4
            } else if bytes[at] >= 0xe0 {
                3
            } else {
                2
            };
            if at + length > bytes.len() { at } else { bytes.len() }
        }
        _ => bytes.len(),
    }
}
