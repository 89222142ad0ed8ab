//! A text without its comments: the same program in a third of the bytes.
//!
//! To naga comments are blank, so that what it makes of a lean text differs in its spans only,
//! and nothing that is written has spans. Two texts that differ in comments alone are compiled
//! once, and an edited comment compiles nothing.

use crate::compose::{Composed, Language, SourceMap};

/// The text to compile. It leads nowhere: for errors, validate the whole text.
pub fn lean(composed: &Composed) -> Composed {
    let text = match composed.language {
        Language::Wesl => without_comments(&composed.text),
        // In GLSL a backslash continues a line comment, and directives end with their line.
        Language::Glsl => composed.text.clone(),
    };
    Composed { text, map: SourceMap::default(), reads: Vec::new(), warnings: Vec::new(), decisions: Vec::new(), ..*composed }
}

/// WGSL has no strings: `//` and `/*` always begin a comment, and block comments nest.
fn without_comments(text: &str) -> String {
    let mut lean = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(start) = rest.find('/') {
        let (before, comment) = rest.split_at(start);
        let length = length(comment);
        // A comment separates what stands on its sides, so a blank takes its place.
        lean.push_str(if length.is_some() { before.trim_end_matches(' ') } else { before });
        lean.push(if length.is_some() { ' ' } else { '/' });
        rest = &comment[length.unwrap_or(1)..];
    }
    lean.push_str(rest);
    lean
}

/// Bytes of the comment that the text begins with.
fn length(text: &str) -> Option<usize> {
    match text.as_bytes().get(1)? {
        // Each of WGSL's line breaks ends the comment.
        b'/' => Some(text.find(['\n', '\r', '\u{b}', '\u{c}', '\u{85}', '\u{2028}', '\u{2029}']).unwrap_or(text.len())),
        b'*' => Some(block(text)),
        _ => None,
    }
}

fn block(text: &str) -> usize {
    let bytes = text.as_bytes();
    let (mut depth, mut at) = (0, 0);
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
            break;
        }
    }
    at
}

#[cfg(test)]
mod tests {
    use super::without_comments;

    #[test]
    fn comments_go_and_nothing_else() {
        for (text, expected) in [
            ("a / b;", "a / b;"),
            ("a // b\nc", "a \nc"),
            ("a /* b /* c */ d */ e", "a  e"),
            ("a/**/b/*/ */c", "a b c"),
            ("a//", "a "),
            ("a /* open", "a "),
            ("a /", "a /"),
            ("é // é\u{2028}b", "é \u{2028}b"),
            ("a //* b\n*/c", "a \n*/c"),
        ] {
            assert_eq!(without_comments(text), expected, "{text}");
        }
    }
}
