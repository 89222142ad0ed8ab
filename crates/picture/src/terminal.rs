//! Pictures as a terminal shows them.
//!
//! Terminals do not say in a common way what they can show. Their names are in the environment, and
//! those that are known for a protocol get it. All others get half blocks in 24-bit colour.

use std::fmt::Write as _;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use crate::Picture;

/// How a terminal takes a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TerminalForm {
    /// The graphics protocol of kitty: a PNG in base64, in parts.
    Kitty,
    /// The inline images of iTerm2: a file in base64.
    Iterm,
    /// DEC's sixels, with 216 colours.
    Sixel,
    /// Two pixels in each character cell.
    Blocks,
}

impl TerminalForm {
    /// Their names as an option's value.
    pub const NAMES: &'static [(&'static str, Self)] = &[
        ("kitty", Self::Kitty),
        ("iterm", Self::Iterm),
        ("sixel", Self::Sixel),
        ("blocks", Self::Blocks),
    ];

    /// What the terminal can show, by the variables of its environment.
    pub fn of_environment(variable: &dyn Fn(&str) -> Option<String>) -> Self {
        let is = |name: &str, values: &[&str]| {
            variable(name).is_some_and(|value| values.iter().any(|known| value.starts_with(known)))
        };
        // A multiplexer shows its own cells, whatever the terminal around it can show.
        if is("TERM", &["screen", "tmux"]) {
            return Self::Blocks;
        }
        if is("KITTY_WINDOW_ID", &[""]) || is("TERM", &["xterm-kitty", "xterm-ghostty"]) {
            return Self::Kitty;
        }
        if is("TERM_PROGRAM", &["iTerm.app", "WezTerm", "mintty"]) || is("LC_TERMINAL", &["iTerm2"])
        {
            return Self::Iterm;
        }
        if is("TERM", &["foot", "mlterm", "contour", "yaft"]) {
            return Self::Sixel;
        }
        Self::Blocks
    }
}

/// The bytes that show a picture in a terminal with so many columns.
///
/// # Errors
/// A message, if the picture cannot be encoded.
pub fn terminal_text(
    picture: &Picture,
    form: TerminalForm,
    columns: u32,
) -> Result<String, String> {
    Ok(match form {
        TerminalForm::Kitty => kitty_text(&STANDARD.encode(picture.png()?)),
        TerminalForm::Iterm => {
            let bytes = picture.png()?;
            let (size, text) = (bytes.len(), STANDARD.encode(&bytes));
            format!("\x1b]1337;File=inline=1;size={size}:{text}\x07\n")
        }
        TerminalForm::Sixel => sixel_text(picture),
        TerminalForm::Blocks => {
            blocks_text(&picture.shrunk(picture.width.div_ceil(columns.max(1))))
        }
    })
}

/// The most bytes of a part.
const PART: usize = 4096;

fn kitty_text(encoded: &str) -> String {
    let parts: Vec<&[u8]> = encoded.as_bytes().chunks(PART).collect();
    let mut text = String::new();
    for (index, part) in parts.iter().enumerate() {
        let head = if index == 0 { "a=T,f=100," } else { "" };
        let more = u8::from(index + 1 < parts.len());
        let part = String::from_utf8_lossy(part);
        let _ = write!(text, "\x1b_G{head}m={more};{part}\x1b\\");
    }
    text.push('\n');
    text
}

/// Upper half blocks: the character has the colour of the upper pixel, and its background that of the
/// lower.
fn blocks_text(picture: &Picture) -> String {
    let mut text = String::new();
    for row in (0..picture.height).step_by(2) {
        for column in 0..picture.width {
            let [r, g, b] = picture.pixel([column, row]);
            let [u, v, w] = picture.pixel([column, row + 1]);
            let _ = write!(text, "\x1b[38;2;{r};{g};{b}m\x1b[48;2;{u};{v};{w}m\u{2580}");
        }
        text.push_str("\x1b[0m\n");
    }
    text
}

/// Steps of each of red, green and blue.
const STEPS: u32 = 6;
/// Rows of a band.
const BAND: u32 = 6;
/// Bayer's matrix of ordered dithering.
const BAYER: [[u32; 4]; 4] = [[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]];

fn sixel_text(picture: &Picture) -> String {
    let mut text = format!("\x1bPq\"1;1;{};{}", picture.width, picture.height);
    for color in 0..STEPS.pow(3) {
        let part = |place: u32| color / STEPS.pow(place) % STEPS * 100 / (STEPS - 1);
        let _ = write!(text, "#{color};2;{};{};{}", part(2), part(1), part(0));
    }
    for top in (0..picture.height).step_by(BAND as usize) {
        let rows: Vec<Vec<u32>> = (top..(top + BAND).min(picture.height))
            .map(|y| (0..picture.width).map(|x| palette_color(picture, x, y)).collect())
            .collect();
        let mut colors: Vec<u32> = rows.iter().flatten().copied().collect();
        colors.sort_unstable();
        colors.dedup();
        for color in colors {
            let _ = write!(text, "#{color}");
            write_band(&mut text, &rows, color);
            text.push('$');
        }
        text.push('-');
    }
    text.push_str("\x1b\\\n");
    text
}

/// The dithered colour of a pixel.
fn palette_color(picture: &Picture, x: u32, y: u32) -> u32 {
    let shift = BAYER[(y % 4) as usize][(x % 4) as usize];
    let step = |part: u8| (u32::from(part) * (STEPS - 1) * 16 + shift * 255) / (255 * 16);
    let [r, g, b] = picture.pixel([x, y]).map(|part| step(part).min(STEPS - 1));
    (r * STEPS + g) * STEPS + b
}

/// The pixels of a colour in a band: a character for each column, with a bit for each row.
fn write_band(text: &mut String, rows: &[Vec<u32>], color: u32) {
    let width = rows.first().map_or(0, Vec::len);
    let bits = |x: usize| {
        rows.iter().enumerate().fold(0_u8, |bits, (y, row)| bits | (u8::from(row[x] == color) << y))
    };
    let mut from = 0;
    while from < width {
        let value = bits(from);
        let length = (from..width).take_while(|x| bits(*x) == value).count();
        let letter = char::from(b'?' + value);
        match length {
            1..=3 => text.extend(std::iter::repeat_n(letter, length)),
            _ => {
                let _ = write!(text, "!{length}{letter}");
            }
        }
        from += length;
    }
}

#[cfg(test)]
mod tests {
    use super::{PART, TerminalForm, kitty_text, terminal_text};
    use crate::Picture;

    fn two_rows() -> Picture {
        let mut picture = Picture::filled(1, 2, [255, 0, 0]);
        picture.set([0, 1], [0, 0, 255]);
        picture
    }

    #[test]
    fn cells_of_two_pixels() -> Result<(), String> {
        let text = terminal_text(&two_rows(), TerminalForm::Blocks, 80)?;
        assert_eq!(text, "\x1b[38;2;255;0;0m\x1b[48;2;0;0;255m\u{2580}\x1b[0m\n");
        let wide = Picture::filled(100, 4, [1, 2, 3]);
        let text = terminal_text(&wide, TerminalForm::Blocks, 50)?;
        assert_eq!(
            text.lines().map(|line| line.matches('\u{2580}').count()).collect::<Vec<_>>(),
            [50]
        );
        Ok(())
    }

    /// Red is the colour 5 * 36, in the first row (bit 0, `@`); blue is 5, in the second (bit 1, `A`).
    #[test]
    fn sixels_of_two_rows() -> Result<(), String> {
        let text = terminal_text(&two_rows(), TerminalForm::Sixel, 80)?;
        assert!(text.starts_with("\x1bPq\"1;1;1;2#0;2;0;0;0#1;2;0;0;20"), "{text}");
        assert!(text.ends_with("#5A$#180@$-\x1b\\\n"), "{text}");
        Ok(())
    }

    #[test]
    fn files_in_parts() -> Result<(), String> {
        let text = terminal_text(&two_rows(), TerminalForm::Kitty, 80)?;
        assert!(text.starts_with("\x1b_Ga=T,f=100,m=0;iVBORw0KGgo"), "{text}");
        let whole = "A".repeat(PART);
        let expected = format!("\x1b_Ga=T,f=100,m=1;{whole}\x1b\\\x1b_Gm=0;B\x1b\\\n");
        assert_eq!(kitty_text(&format!("{whole}B")), expected);
        let text = terminal_text(&two_rows(), TerminalForm::Iterm, 80)?;
        assert!(text.starts_with("\x1b]1337;File=inline=1;size="), "{text}");
        Ok(())
    }

    #[test]
    fn forms_by_environment() {
        for (name, value, expected) in [
            ("TERM", "xterm-256color", TerminalForm::Blocks),
            ("TERM", "xterm-kitty", TerminalForm::Kitty),
            ("KITTY_WINDOW_ID", "1", TerminalForm::Kitty),
            ("TERM_PROGRAM", "WezTerm", TerminalForm::Iterm),
            ("TERM", "foot-extra", TerminalForm::Sixel),
        ] {
            let variable = |asked: &str| (asked == name).then(|| value.to_owned());
            assert_eq!(TerminalForm::of_environment(&variable), expected, "{name}={value}");
        }
        let in_multiplexer =
            |asked: &str| Some(if asked == "TERM" { "tmux-256color" } else { "1" }.to_owned());
        assert_eq!(TerminalForm::of_environment(&in_multiplexer), TerminalForm::Blocks);
    }
}
