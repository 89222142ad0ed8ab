//! The tokens of a GLSL text, with the brackets paired.

use std::ops::Range;

use lamplight_diagnostic::source::LIMITS;
use lamplight_syntax::glsl::{Symbols, TokenKind, tokenize};

/// A token, and the index of the bracket that it opens or closes with; its own index otherwise.
#[derive(Clone, Copy)]
struct PairedToken<'t> {
    text: &'t str,
    at: usize,
    pair: usize,
    is_word: bool,
}

/// The tokens of a text, without its directives.
pub struct Tokens<'t> {
    list: Vec<PairedToken<'t>>,
}

impl<'t> Tokens<'t> {
    /// Reads a composed text. `None` if it cannot be split into tokens, or a bracket has no pair:
    /// then naga reports the error.
    pub fn read(text: &'t str) -> Option<Self> {
        let tokens = tokenize(text, &mut Symbols::default(), LIMITS.tokens).ok()?;
        let (mut list, mut open, mut in_directive) =
            (Vec::with_capacity(tokens.len()), vec![], false);
        for token in &tokens {
            let word = &text[token.range()];
            in_directive = if token.first_of_line { word == "#" } else { in_directive };
            if in_directive {
                continue;
            }
            let mut pair = list.len();
            match word {
                "(" | "[" | "{" => open.push(pair),
                ")" | "]" | "}" => {
                    pair = open.pop()?;
                    let close = list.len();
                    let first: &mut PairedToken<'_> = list.get_mut(pair)?;
                    if !matches!((first.text, word), ("(", ")") | ("[", "]") | ("{", "}")) {
                        return None;
                    }
                    first.pair = close;
                }
                _ => {}
            }
            let is_word = token.kind == TokenKind::Identifier;
            list.push(PairedToken { text: word, at: token.start as usize, pair, is_word });
        }
        open.is_empty().then_some(Self { list })
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// The text of a token; empty behind the last one.
    pub fn text(&self, index: usize) -> &'t str {
        self.list.get(index).map_or("", |token| token.text)
    }

    /// Whether it is an identifier or a keyword.
    pub fn is_word(&self, index: usize) -> bool {
        self.list.get(index).is_some_and(|token| token.is_word)
    }

    /// The index of the bracket that belongs to the one at `index`.
    pub fn pair(&self, index: usize) -> usize {
        self.list.get(index).map_or(index, |token| token.pair)
    }

    /// The bytes from one token to another, both included.
    pub fn bytes(&self, first: usize, last: usize) -> Range<usize> {
        let start = self.list.get(first).map_or(0, |token| token.at);
        start..self.list.get(last).map_or(start, |token| token.at + token.text.len())
    }

    /// The index of the first token from `at` on that is one of `stops`, outside of brackets; the
    /// index of a closing bracket or of `end` if there is none.
    pub fn find(&self, mut at: usize, end: usize, stops: &[&str]) -> usize {
        while at < end
            && !stops.contains(&self.text(at))
            && !matches!(self.text(at), ")" | "]" | "}")
        {
            at = self.pair(at) + 1;
        }
        at.min(end)
    }

    /// The first index behind the pairs of `[` and `]` from `at` on, and how many pairs these are.
    pub fn skip_dimensions(&self, mut at: usize) -> (usize, usize) {
        let mut count = 0;
        while self.text(at) == "[" {
            at = self.pair(at) + 1;
            count += 1;
        }
        (at, count)
    }

    /// The parts of a list in brackets between commas, as ranges of tokens.
    pub fn parts(&self, open: usize) -> Vec<Range<usize>> {
        let (mut at, close, mut parts) = (open + 1, self.pair(open), Vec::new());
        while at < close {
            let end = self.find(at, close, &[","]);
            parts.push(at..end);
            at = end + 1;
        }
        parts
    }
}
