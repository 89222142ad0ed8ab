//! Which comments and blanks belong to an item. They are kept, moved and removed together with it.

use std::ops::Range;

use super::blank::comment_length;

/// Where an item's text starts: at the comments above it, if no blank line stands between.
///
/// `from` is where the item before ended, its own trailing comment included.
pub fn leading_start(text: &str, from: u32, start: u32) -> u32 {
    let bytes = text.as_bytes();
    let (mut at, end) = (from as usize, start as usize);
    let mut attached = None;
    let mut newlines = 0;
    while at < end {
        match bytes[at] {
            b'/' => {
                attached = if newlines > 1 { Some(at) } else { attached.or(Some(at)) };
                newlines = 0;
                at += comment_length(&text[at..end]).max(1);
            }
            byte => {
                newlines += usize::from(byte == b'\n');
                at += 1;
            }
        }
    }
    attached.filter(|_| newlines <= 1).map_or(start, |at| at as u32)
}

/// Where an item's text ends: after a comment on the same line, if nothing else follows there.
pub fn trailing_end(text: &str, end: u32, limit: u32) -> u32 {
    let rest = &text[end as usize..limit as usize];
    let line = &rest[..rest.find(['\n', '\r']).unwrap_or(rest.len())];
    let comment = line.trim_start_matches([' ', '\t']);
    if comment.starts_with("//") { end + line.trim_end().len() as u32 } else { end }
}

/// The text that is removed with a node: its whole lines, if nothing else is on them, and the `//`
/// lines above.
///
/// `before` is the end of the token before the node, and `after` is the start of the token behind
/// it.
pub fn removed_lines(text: &str, before: u32, node: Range<u32>, after: u32) -> Range<u32> {
    let head = &text[before as usize..node.start as usize];
    let end = trailing_end(text, node.end, after);
    let tail = &text[end as usize..after as usize];
    let indent = head.len() - head.trim_end_matches([' ', '\t']).len();
    let starts_line = head[..head.len() - indent].ends_with('\n');
    let blank = tail.len() - tail.trim_start_matches([' ', '\t', '\r']).len();
    match (starts_line, tail[blank..].starts_with('\n')) {
        (true, true) => {
            let start = node.start - indent as u32;
            comment_lines(text, before, start)..end + blank as u32 + 1
        }
        // At the end of a line the blanks before it are removed too; elsewhere those after it, as
        // in `f(@if(a) x, y)`.
        (false, true) => node.start - indent as u32..end,
        (_, false) => {
            node.start..end + (tail.len() - tail.trim_start_matches([' ', '\t']).len()) as u32
        }
    }
}

/// The index after the blanks that follow a removed attribute.
pub fn skip_blank(text: &str, end: u32) -> u32 {
    let rest = &text[end as usize..];
    end + (rest.len() - rest.trim_start_matches([' ', '\t', '\r', '\n']).len()) as u32
}

/// The start of the `//` lines that are directly above the line starting at `start`.
fn comment_lines(text: &str, before: u32, start: u32) -> u32 {
    let head = &text[before as usize..start as usize];
    if head.contains("/*") {
        return start;
    }
    let mut at = head.len();
    while let Some(line) = head[..at].strip_suffix('\n') {
        let Some(newline) = line.rfind('\n') else { break };
        if !line[newline + 1..].trim_start().starts_with("//") {
            break;
        }
        at = newline + 1;
    }
    before + at as u32
}
