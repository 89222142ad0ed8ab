//! The one way to standard output and standard error.
//!
//! What commands print holds names, paths and messages from elsewhere: a bundle's programs, a
//! cached message, an argument that is echoed. A terminal obeys control characters, so such a name
//! could hide lines, move the cursor or reverse the writing direction. Everything that is printed
//! goes through [`Escaping`]. Bytes that are a result ([`write_data`]) do so only on a terminal,
//! and are unchanged in pipes and files. No other file of the command line may name the streams of
//! the standard library; `house::one_way_to_the_terminal` checks that.

use std::io::{self, IsTerminal, Write};

use crate::diagnostic::{escape_controls, needs_escape};

/// Standard output, for text.
pub fn stdout() -> Escaping<io::Stdout> {
    Escaping::new(io::stdout())
}

/// Standard error, for text.
pub fn stderr() -> Escaping<io::Stderr> {
    Escaping::new(io::stderr())
}

/// Standard error, for text with colours of our own.
pub fn colored_stderr() -> Escaping<io::Stderr> {
    Escaping { out: io::stderr(), has_colors: true, cut: Vec::new() }
}

/// Whether standard output is a terminal.
pub fn is_terminal() -> bool {
    io::stdout().is_terminal()
}

/// Whether standard error is a terminal.
pub fn is_person() -> bool {
    io::stderr().is_terminal()
}

/// Writes a result, such as a shader, byte by byte. If standard output is a terminal, it is
/// escaped.
pub fn write_data(bytes: &[u8]) -> io::Result<()> {
    match is_terminal() {
        true => stdout().write_all(bytes),
        false => io::stdout().write_all(bytes),
    }
}

/// Writes a picture in the form of a terminal, with its control characters. Only what
/// `picture::terminal` made of pixels is written here.
pub fn write_picture(text: &str) -> io::Result<()> {
    let mut out = io::stdout();
    out.write_all(text.as_bytes())?;
    out.flush()
}

/// How many columns the terminal has; 80 if nothing says so.
pub fn columns() -> u32 {
    const USUAL: u32 = 80;
    let given = std::env::var("COLUMNS").ok().and_then(|columns| columns.parse().ok());
    given.filter(|columns| *columns > 0).or_else(terminal_columns).unwrap_or(USUAL)
}

#[cfg(target_os = "linux")]
fn terminal_columns() -> Option<u32> {
    let size = rustix::termios::tcgetwinsize(io::stdout()).ok()?;
    Some(u32::from(size.ws_col)).filter(|columns| *columns > 0)
}

#[cfg(not(target_os = "linux"))]
fn terminal_columns() -> Option<u32> {
    None
}

/// Flushes standard output.
pub fn flush_stdout() -> io::Result<()> {
    io::stdout().flush()
}

/// Writes control characters as `\u001b` and the like, which mean the same
/// characters in JSON.
#[derive(Debug)]
pub struct Escaping<W: Write> {
    out: W,
    /// Whether sequences that choose a colour are kept.
    has_colors: bool,
    /// The first bytes of a character whose other bytes were not written yet.
    cut: Vec<u8>,
}

impl<W: Write> Escaping<W> {
    pub fn new(out: W) -> Self {
        Self { out, has_colors: false, cut: Vec::new() }
    }

    fn text(&mut self, text: &str) -> io::Result<()> {
        let mut rest = text;
        while let Some(at) = rest.find(needs_escape) {
            let color = if self.has_colors { color_length(&rest[at..]) } else { 0 };
            // A control character has at least one byte, and so has a colour of our own.
            let length = rest[at..].chars().next().map_or(0, char::len_utf8).max(color);
            let (before, found) = rest[..at + length].split_at(at);
            self.out.write_all(before.as_bytes())?;
            match color {
                0 => self.out.write_all(escape_controls(found).as_bytes())?,
                _ => self.out.write_all(found.as_bytes())?,
            }
            rest = &rest[at + length..];
        }
        self.out.write_all(rest.as_bytes())
    }
}

/// Length of the sequence that chooses a colour, if the text begins with one.
fn color_length(text: &str) -> usize {
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
        let whole = whole_length(&joined);
        let text = String::from_utf8_lossy(&joined[..whole]).into_owned();
        self.text(&text)?;
        self.cut = joined[whole..].to_vec();
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

/// A character that was cut is written when the writer is dropped.
impl<W: Write> Drop for Escaping<W> {
    fn drop(&mut self) {
        let rest = String::from_utf8_lossy(&std::mem::take(&mut self.cut)).into_owned();
        let _ = self.text(&rest);
    }
}

/// Length of the bytes before a character that is cut at the end.
fn whole_length(bytes: &[u8]) -> usize {
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
