//! Words and signs of a text in MSL, without comments and directives.

use lamplight_syntax::words::piece_at;

/// A word, a number or one sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Token<'t> {
    pub text: &'t str,
    /// First byte in the text.
    pub at: usize,
}

impl Token<'_> {
    /// First byte behind it.
    pub fn end(&self) -> usize {
        self.at + self.text.len()
    }
}

pub fn msl_tokens(text: &str) -> Vec<Token<'_>> {
    let mut found = Vec::new();
    let mut at = 0;
    while let Some(first) = text[at..].chars().next() {
        let rest = &text[at..];
        let length = if rest.starts_with("//") || first == '#' {
            rest.find('\n').unwrap_or(rest.len())
        } else if let Some(comment) = rest.strip_prefix("/*") {
            comment.find("*/").map_or(rest.len(), |end| end + 4)
        } else if first.is_whitespace() {
            first.len_utf8()
        } else {
            let piece = piece_at(text, at).map_or(rest, |piece| piece.text);
            found.push(Token { text: piece, at });
            piece.len()
        };
        at += length;
    }
    found
}
