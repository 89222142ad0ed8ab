//! The white space and comments between two tokens.

/// A piece of a gap.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GapPiece<'t> {
    /// White space and line continuations.
    Space(&'t str),
    /// One comment, `//` without its newline.
    Comment(&'t str),
}

impl GapPiece<'_> {
    /// How many lines a piece of white space ends.
    pub fn newlines(self) -> usize {
        match self {
            Self::Space(text) => count_newlines(text.as_bytes()),
            Self::Comment(_) => 0,
        }
    }
}

/// The pieces of a gap with their offsets, in order.
pub fn gap_pieces(gap: &str) -> impl Iterator<Item = (usize, GapPiece<'_>)> {
    let mut at = 0;
    std::iter::from_fn(move || {
        let rest = gap.get(at..).filter(|rest| !rest.is_empty())?;
        let start = at;
        let piece = first_piece(rest);
        at += match piece {
            GapPiece::Space(text) | GapPiece::Comment(text) => text.len(),
        };
        Some((start, piece))
    })
}

fn first_piece(rest: &str) -> GapPiece<'_> {
    if rest.starts_with("//") {
        return GapPiece::Comment(&rest[..line_comment(rest)]);
    }
    if let Some(inner) = rest.strip_prefix("/*") {
        return GapPiece::Comment(&rest[..inner.find("*/").map_or(rest.len(), |end| end + 4)]);
    }
    let slash = rest.bytes().skip(1).position(|byte| byte == b'/');
    GapPiece::Space(&rest[..slash.map_or(rest.len(), |end| end + 1)])
}

/// Newlines without a `\` before them.
fn count_newlines(space: &[u8]) -> usize {
    let continued = |at: usize| matches!(space[..at], [.., b'\\'] | [.., b'\\', b'\r']);
    (0..space.len()).filter(|at| space[*at] == b'\n' && !continued(*at)).count()
}

/// Length of a `//` comment, line continuations included.
fn line_comment(rest: &str) -> usize {
    let mut end = 0;
    for line in rest.split_inclusive('\n') {
        end += line.len();
        let text = line.trim_end_matches(['\n', '\r']);
        if !text.ends_with('\\') {
            return end - (line.len() - text.len());
        }
    }
    end
}

/// The part of the gap before an item that belongs to the item: the comments without a blank line
/// between them and it. With `after_item` another item ends just before the gap, and the rest of
/// that line belongs to that one.
pub fn attached_part(gap: &str, after_item: bool) -> std::ops::Range<usize> {
    let mut start = None;
    let mut own_line = !after_item;
    for (at, piece) in gap_pieces(gap) {
        match piece {
            GapPiece::Space(_) if piece.newlines() > 1 => {
                start = None;
                own_line = true;
            }
            GapPiece::Space(_) => own_line |= piece.newlines() > 0,
            GapPiece::Comment(_) if own_line => start = start.or(Some(at)),
            GapPiece::Comment(_) => {}
        }
    }
    start.unwrap_or(gap.len())..gap.len()
}

/// The comments of a gap that stand on the line of the token before it.
pub fn trailing_comments(gap: &str) -> std::ops::Range<usize> {
    let mut end = 0;
    for (at, piece) in gap_pieces(gap) {
        match piece {
            GapPiece::Space(_) if piece.newlines() > 0 => break,
            GapPiece::Space(_) => {}
            GapPiece::Comment(text) => end = at + text.len(),
        }
    }
    0..end
}
