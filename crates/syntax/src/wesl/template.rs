//! Which `<` and `>` are the brackets of template lists, by the algorithm of WGSL's specification
//! ("Template Lists").

/// A token, but no comment, as the algorithm sees it. Every `<` and every `>` is a token of its own;
/// other operators of several characters may be one token or several.
#[derive(Debug, Clone, Copy)]
pub struct Piece<'t> {
    pub text: &'t str,
    /// Its first byte.
    pub start: u32,
    pub is_word: bool,
}

/// The brackets of the template lists: the indices of each `<` and its `>`.
pub fn template_lists(pieces: &[Piece<'_>]) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    // The `<` that may begin a list, with the depth of other brackets there.
    let mut pending: Vec<(usize, usize)> = Vec::new();
    let (mut depth, mut at) = (0_usize, 0);
    while at < pieces.len() {
        let piece = pieces[at];
        let is_next = |mark: &str| {
            let end = piece.start + piece.text.len() as u32;
            pieces.get(at + 1).is_some_and(|next| next.start == end && next.text.starts_with(mark))
        };
        match piece.text {
            "<" if at > 0 && pieces[at - 1].is_word => match is_next("<") || is_next("=") {
                true => at += 1,
                false => pending.push((at, depth)),
            },
            ">" => match pending.last() {
                Some((open, outer)) if *outer == depth => {
                    found.push((*open, at));
                    pending.pop();
                }
                _ if is_next("=") => at += 1,
                _ => {}
            },
            "(" | "[" => depth += 1,
            ")" | "]" => {
                drop_pending(&mut pending, depth);
                depth = depth.saturating_sub(1);
            }
            "!" | "=" if is_next("=") => at += 1,
            "&&" | "||" => drop_pending(&mut pending, depth),
            mark @ ("&" | "|") if is_next(mark) => {
                drop_pending(&mut pending, depth);
                at += 1;
            }
            "=" | "+=" | "-=" | "*=" | "/=" | "%=" | "&=" | "|=" | "^=" | ";" | "{" | ":" => {
                depth = 0;
                pending.clear();
            }
            _ => {}
        }
        at += 1;
    }
    found
}

/// Without the `<` at this depth of brackets or deeper.
fn drop_pending(pending: &mut Vec<(usize, usize)>, depth: usize) {
    while pending.last().is_some_and(|(_, outer)| *outer >= depth) {
        pending.pop();
    }
}
