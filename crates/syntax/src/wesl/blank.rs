//! What stands between the tokens of WGSL: blanks and comments. WGSL has no strings, so `//` and
//! `/*` begin a comment everywhere but in the paths of files that `#import` has in quotes.

/// Whether the character is one of WGSL's line breaks. Each of them ends a line comment.
pub fn is_line_break(letter: char) -> bool {
    matches!(letter, '\n'..='\r' | '\u{85}' | '\u{2028}' | '\u{2029}')
}

/// Whether the character is blankspace in WGSL: spaces, tabs, line breaks and marks of direction.
pub fn is_blank(letter: char) -> bool {
    matches!(letter, ' ' | '\t' | '\u{200e}' | '\u{200f}') || is_line_break(letter)
}

/// Bytes of the line comment that the text begins with, without its line break.
pub fn line_comment(text: &str) -> usize {
    // The ASCII text at the start is searched byte by byte, which is faster.
    let first = text
        .bytes()
        .position(|byte| matches!(byte, b'\n'..=b'\r') || !byte.is_ascii())
        .unwrap_or(text.len());
    text[first..].find(is_line_break).map_or(text.len(), |more| first + more)
}

/// Bytes of the block comment that the text begins with, and whether it is closed. Block comments
/// nest.
pub fn block_comment(text: &str) -> (usize, bool) {
    let bytes = text.as_bytes();
    let (mut depth, mut at) = (0_usize, 0);
    while at < bytes.len() {
        match (bytes[at], bytes.get(at + 1)) {
            (b'/', Some(b'*')) => depth += 1,
            (b'*', Some(b'/')) => depth -= 1,
            _ => {
                at += 1;
                continue;
            }
        }
        at += 2;
        if depth == 0 {
            return (at, true);
        }
    }
    (at, false)
}

/// Bytes of the comment that the text begins with; 0 if it begins with none.
pub fn comment_length(text: &str) -> usize {
    match text.as_bytes() {
        [b'/', b'/', ..] => line_comment(text),
        [b'/', b'*', ..] => block_comment(text).0,
        _ => 0,
    }
}

/// The text with each byte of its comments replaced by a space, so that all else keeps its offset.
/// Quotes end at the end of their line.
pub fn without_comments(text: &str) -> String {
    let mut bare = String::with_capacity(text.len());
    let mut is_quoted = false;
    while let Some(next) = text[bare.len()..].chars().next() {
        let comment = if is_quoted { 0 } else { comment_length(&text[bare.len()..]) };
        if comment > 0 {
            bare.extend(std::iter::repeat_n(' ', comment));
            continue;
        }
        is_quoted = if is_quoted { !matches!(next, '"' | '\n') } else { next == '"' };
        bare.push(next);
    }
    bare
}
