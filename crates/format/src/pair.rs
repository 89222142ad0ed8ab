//! Finds the partner of each bracket. Where brackets do not match, the lines of the item around
//! them become one token, which is kept as it is.
//!
//! A branch of the preprocessor may open a bracket that another branch opens too, and that is
//! closed once behind both. Of such branches the first one is formatted, and the others are kept.

use lamplight_bundle::Language;

use crate::token::{Kind, Token};

/// Why lines are kept as they are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Trouble {
    /// A bracket that nothing closes.
    Open,
    /// A bracket that closes nothing, or another kind of bracket.
    Closer,
    /// Brackets nest deeper than [`NESTING`].
    Deep,
}

/// A bracket that does not match, by its bytes.
#[derive(Debug, Clone, Copy)]
pub struct Unpaired {
    pub trouble: Trouble,
    pub start: u32,
    pub end: u32,
}

/// How deep brackets may nest.
pub const NESTING: usize = 200;
/// How deep branches are compared with each other.
const BRANCHES: usize = 16;
/// After so many brackets that are never closed, the rest of a text is kept as it is.
const OPEN_ITEMS: usize = 64;

/// Tokens whose brackets have partners.
pub struct Paired {
    pub tokens: Vec<Token>,
    pub unpaired: Vec<Unpaired>,
}

pub fn pair_brackets(text: &str, tokens: Vec<Token>, language: Language) -> Paired {
    let mut tokens = merge_kept(text, &tokens, &repeated_branches(text, &tokens));
    let mut pairing = Pairing { text, language, open: Vec::new(), unpaired: Vec::new() };
    let mut kept = vec![false; tokens.len()];
    let (mut at, mut first) = (0, 0);
    while let Some((trouble, bracket)) = pairing.advance(&mut tokens, &mut at) {
        let outermost = pairing.open.first().copied().unwrap_or(bracket);
        let start = pairing.item_start(&tokens, outermost, first);
        let after = if trouble == Trouble::Open { outermost } else { bracket };
        let is_lost = pairing.unpaired.len() >= OPEN_ITEMS;
        let end = if is_lost { tokens.len() } else { pairing.next_item(&tokens, after + 1) };
        let (trouble, blamed) = pairing.blamed(&tokens, trouble, bracket);
        let Token { start: from, end: to, .. } = tokens[blamed];
        pairing.unpaired.push(Unpaired { trouble, start: from, end: to });
        pairing.open.clear();
        kept[start..end].fill(true);
        (at, first) = (end, end);
    }
    let unpaired = pairing.unpaired;
    if !unpaired.is_empty() {
        tokens = merge_kept(text, &tokens, &kept);
    }
    Paired { tokens, unpaired }
}

struct Pairing<'t> {
    text: &'t str,
    language: Language,
    open: Vec<usize>,
    unpaired: Vec<Unpaired>,
}

impl Pairing<'_> {
    /// Goes on to the first bracket that does not match.
    fn advance(&mut self, tokens: &mut [Token], at: &mut usize) -> Option<(Trouble, usize)> {
        while *at < tokens.len() {
            let index = *at;
            *at += 1;
            match bracket_of(&tokens[index], self.text) {
                Some((_, true)) if self.open.len() == NESTING => {
                    return Some((Trouble::Deep, index));
                }
                Some((_, true)) => self.open.push(index),
                Some((shape, false)) => match self.open.last().copied() {
                    Some(opener)
                        if bracket_of(&tokens[opener], self.text) == Some((shape, true)) =>
                    {
                        self.open.pop();
                        tokens[opener].partner = index as u32;
                        tokens[index].partner = opener as u32;
                    }
                    _ => return Some((Trouble::Closer, index)),
                },
                None => {}
            }
        }
        self.open.last().map(|index| (Trouble::Open, *index))
    }

    /// The bracket to show for a trouble. If a bracket closes one further out, what is open within was
    /// forgotten: `{ (1; }`.
    fn blamed(&self, tokens: &[Token], trouble: Trouble, bracket: usize) -> (Trouble, usize) {
        let closed = bracket_of(&tokens[bracket], self.text).map(|(shape, _)| (shape, true));
        let is_closed = |opener: &usize| bracket_of(&tokens[*opener], self.text) == closed;
        match self.open.last() {
            Some(inner) if trouble == Trouble::Closer && self.open.iter().any(is_closed) => {
                (Trouble::Open, *inner)
            }
            _ => (trouble, bracket),
        }
    }

    /// The first token of the item that a token outside of brackets belongs to.
    fn item_start(&self, tokens: &[Token], of: usize, first: usize) -> usize {
        let ends = |token: &Token| {
            token.ends_line() || token.is_comment() || matches!(token.text(self.text), ";" | "}")
        };
        let mut at = of;
        while at > first && !ends(&tokens[at - 1]) {
            at = (tokens[at - 1].partner as usize).clamp(first, at - 1);
        }
        at
    }

    /// The next token that by its place in column 0 begins an item.
    fn next_item(&self, tokens: &[Token], from: usize) -> usize {
        let begins = |at: usize| {
            let word = tokens[at].text(self.text);
            let is_item = match tokens[at].kind {
                Kind::Word => self.language == Language::Wesl && ITEMS.contains(&word),
                Kind::Mark => word == "@",
                _ => false,
            };
            let before = &tokens[at - 1];
            let is_after = before.ends_line() || matches!(before.text(self.text), "}" | ";");
            tokens[at].is_margin && (is_item || (tokens[at].kind == Kind::Word && is_after))
        };
        (from.max(1)..tokens.len()).find(|at| begins(*at)).unwrap_or(tokens.len())
    }
}

/// Words that begin an item of WESL.
const ITEMS: [&str; 10] = [
    "fn",
    "struct",
    "const",
    "var",
    "override",
    "alias",
    "import",
    "enable",
    "requires",
    "const_assert",
];

/// The shape of a bracket, and whether it opens.
fn bracket_of(token: &Token, text: &str) -> Option<(u8, bool)> {
    match token.kind {
        Kind::TemplateOpen => Some((b'<', true)),
        Kind::TemplateClose => Some((b'<', false)),
        Kind::Mark => match token.text(text) {
            "(" => Some((b'(', true)),
            ")" => Some((b'(', false)),
            "[" => Some((b'[', true)),
            "]" => Some((b'[', false)),
            "{" => Some((b'{', true)),
            "}" => Some((b'{', false)),
            _ => None,
        },
        _ => None,
    }
}

/// Tokens in a row that are kept become one.
fn merge_kept(text: &str, tokens: &[Token], kept: &[bool]) -> Vec<Token> {
    let mut merged: Vec<Token> = Vec::with_capacity(tokens.len());
    let mut moved = vec![0_u32; tokens.len()];
    for (index, token) in tokens.iter().enumerate() {
        if kept[index] && index > 0 && kept[index - 1] {
            if let Some(last) = merged.last_mut() {
                last.end = token.end;
            }
            continue;
        }
        moved[index] = merged.len() as u32;
        merged.push(*token);
        if kept[index] {
            let start = token.start as usize;
            let line = text[..start].rfind('\n').map_or(0, |at| at + 1);
            let is_first = text[line..start].trim().is_empty();
            let raw = &mut merged[moved[index] as usize];
            raw.kind = Kind::Raw;
            raw.start = if is_first { line as u32 } else { token.start };
            raw.partner = index as u32;
        }
    }
    for token in &mut merged {
        token.partner = moved[token.partner as usize];
    }
    merged
}

/// A part of a conditional of the preprocessor: `#if`, a branch, or `#endif`.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Conditional {
    If,
    Branch,
    End,
}

fn conditional_of(token: &Token, text: &str) -> Option<Conditional> {
    if token.kind != Kind::Directive {
        return None;
    }
    let rest = token.text(text)[1..].trim_start_matches([' ', '\t']);
    match lamplight_syntax::words::leading_word(rest) {
        "if" | "ifdef" | "ifndef" => Some(Conditional::If),
        "else" | "elif" | "elseif" | "elifdef" | "elifndef" => Some(Conditional::Branch),
        "endif" => Some(Conditional::End),
        _ => None,
    }
}

/// The tokens of branches that are kept, since the first branch leaves brackets open or closes
/// such.
fn repeated_branches(text: &str, tokens: &[Token]) -> Vec<bool> {
    let mut kept = vec![false; tokens.len()];
    // For each conditional that is open, its lines.
    let mut open: Vec<Vec<usize>> = Vec::new();
    for (index, token) in tokens.iter().enumerate() {
        match conditional_of(token, text) {
            Some(Conditional::If) => open.push(vec![index]),
            Some(Conditional::Branch) => {
                if let Some(lines) = open.last_mut() {
                    lines.push(index);
                }
            }
            Some(Conditional::End) => {
                let Some(mut lines) = open.pop() else { continue };
                lines.push(index);
                if open.len() < BRANCHES && lines.len() > 2 {
                    keep_branches(text, tokens, &lines, &mut kept);
                }
            }
            None => {}
        }
    }
    kept
}

fn keep_branches(text: &str, tokens: &[Token], lines: &[usize], kept: &mut [bool]) {
    let mut branches = lines.windows(2).map(|pair| pair[0] + 1..pair[1]);
    let is_even =
        |range: std::ops::Range<usize>, kept: &[bool]| leaves_even(text, tokens, range, kept);
    if branches.clone().all(|range| is_even(range, kept)) {
        return;
    }
    branches.next();
    for range in branches {
        kept[range].fill(true);
    }
}

/// Whether every bracket of a range has its partner there.
fn leaves_even(text: &str, tokens: &[Token], range: std::ops::Range<usize>, kept: &[bool]) -> bool {
    let mut open: Vec<u8> = Vec::new();
    for index in range.filter(|index| !kept[*index]) {
        match bracket_of(&tokens[index], text) {
            Some((shape, true)) => open.push(shape),
            Some((shape, false)) if open.pop() != Some(shape) => return false,
            _ => {}
        }
    }
    open.is_empty()
}
