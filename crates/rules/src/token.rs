//! Splits WGSL into tokens, with operators of several characters as one token, and finds the
//! template lists.

use lamplight_syntax::wesl::blank::{block_comment, is_blank, line_comment};
use lamplight_syntax::wesl::{Piece, template_lists};
use lamplight_syntax::words::{begins_word, number_end, word_end};

use super::Place;

/// What a token is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Word,
    Number,
    /// Punctuation. [`Token::text`] says which.
    Mark,
    /// The `<` and the `>` of a template list.
    TemplateStart,
    TemplateEnd,
    End,
}

#[derive(Debug, Clone, Copy)]
pub struct Token<'t> {
    pub kind: Kind,
    pub text: &'t str,
    pub place: Place,
}

/// Operators of several characters, longest first.
const LONG: [&str; 21] = [
    "<<=", ">>=", "->", "&&", "||", "==", "!=", "<=", ">=", "<<", ">>", "++", "--", "+=", "-=",
    "*=", "/=", "%=", "&=", "|=", "^=",
];

/// The tokens of a text, with one of the kind [`Kind::End`] after them. `None` where the text has
/// something that is no token: naga says so.
pub fn tokenize(text: &str) -> Option<Vec<Token<'_>>> {
    let mut tokens = single_tokens(text)?;
    mark_templates(&mut tokens);
    let mut joined: Vec<Token<'_>> = Vec::with_capacity(tokens.len() + 1);
    let mut at = 0;
    while at < tokens.len() {
        let token = tokens[at];
        let long = match token.kind {
            Kind::Mark if has_neighbour(&tokens[at..]) => {
                LONG.iter().find(|long| is_joined(text, &tokens[at..], long))
            }
            _ => None,
        };
        let length = long.map_or(1, |long| long.len());
        let place = Place { start: token.place.start, end: tokens[at + length - 1].place.end };
        joined.push(Token { text: &text[place.range()], place, kind: token.kind });
        at += length;
    }
    let end = text.len() as u32;
    joined.push(Token { kind: Kind::End, text: "", place: Place { start: end, end } });
    Some(joined)
}

/// Whether a mark comes right after the first one.
fn has_neighbour(tokens: &[Token<'_>]) -> bool {
    match tokens {
        [first, second, ..] => second.kind == Kind::Mark && second.place.start == first.place.end,
        _ => false,
    }
}

/// Whether the text goes on with an operator none of whose characters belongs to a template list.
fn is_joined(text: &str, tokens: &[Token<'_>], long: &str) -> bool {
    text[tokens[0].place.start as usize..].starts_with(long)
        && tokens.get(..long.len()).is_some_and(|own| own.iter().all(|one| one.kind == Kind::Mark))
}

/// The tokens with every mark a token of its own.
fn single_tokens(text: &str) -> Option<Vec<Token<'_>>> {
    let mut tokens = Vec::with_capacity(text.len() / 4);
    let mut at = 0;
    while let Some(letter) = text[at..].chars().next() {
        let rest = &text[at..];
        if is_blank(letter) {
            at += letter.len_utf8();
            continue;
        }
        if rest.starts_with("//") {
            at += line_comment(rest);
            continue;
        }
        if rest.starts_with("/*") {
            let (length, is_closed) = block_comment(rest);
            is_closed.then_some(())?;
            at += length;
            continue;
        }
        let is_fraction =
            letter == '.' && rest[1..].starts_with(|next: char| next.is_ascii_digit());
        let (kind, end) = if begins_word(letter) {
            (Kind::Word, word_end(text, at))
        } else if letter.is_ascii_digit() || is_fraction {
            (Kind::Number, number_end(text, at))
        } else if letter.is_ascii_punctuation() {
            (Kind::Mark, at + 1)
        } else {
            return None;
        };
        let place = Place { start: at as u32, end: end as u32 };
        tokens.push(Token { kind, text: &text[at..end], place });
        at = end;
    }
    Some(tokens)
}

/// Marks the brackets of template lists.
fn mark_templates(tokens: &mut [Token<'_>]) {
    let pieces: Vec<Piece<'_>> = tokens
        .iter()
        .map(|token| Piece {
            text: token.text,
            start: token.place.start,
            is_word: token.kind == Kind::Word,
        })
        .collect();
    for (open, close) in template_lists(&pieces) {
        tokens[open].kind = Kind::TemplateStart;
        tokens[close].kind = Kind::TemplateEnd;
    }
}
