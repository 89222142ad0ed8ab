//! Splits text into words, numbers and punctuation. Every bracket knows its partner.

use super::blank::{block_comment, is_blank, line_comment};
use super::name::{Name, Names};
use crate::words::{begins_word, number_end, word_end};
use lamplight_diagnostic::source::{LIMITS, SourceId, Span};
use lamplight_diagnostic::{Diagnostic, codes};

/// What a token is. `<` and `>` are always single tokens: `>>` and `>=` are two tokens each. So a
/// `>` that ends a template list needs no special case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TokenKind {
    Word(Name),
    Number,
    /// `::`
    Path,
    /// `->`
    Arrow,
    /// Any other character of WGSL's punctuation.
    Mark(u8),
}

/// A token and its bytes.
#[derive(Debug, Clone, Copy)]
pub struct Token {
    pub kind: TokenKind,
    pub start: u32,
    pub end: u32,
    /// Index of the matching bracket; its own for anything else.
    pub partner: u32,
}

/// Splits a text into tokens. The error is about the first thing that cannot be a token.
pub fn tokenize(text: &str, source: SourceId, names: &mut Names) -> Result<Vec<Token>, Diagnostic> {
    let mut scanner = TokenScanner { text, bytes: text.as_bytes(), at: 0, source };
    let mut tokens: Vec<Token> = Vec::with_capacity(text.len() / 4);
    let mut open: Vec<u32> = Vec::new();
    if text.starts_with('\u{feff}') {
        scanner.at = '\u{feff}'.len_utf8();
    }
    while scanner.skip_blank()? {
        let start = scanner.at;
        let kind = scanner.token(names)?;
        let index = tokens.len() as u32;
        tokens.push(Token { kind, start: start as u32, end: scanner.at as u32, partner: index });
        if tokens.len() > LIMITS.tokens {
            return Err(Diagnostic::error(
                codes::TOO_MANY_TOKENS,
                format!("more than {} tokens in one file", LIMITS.tokens),
            )
            .at(scanner.span(start), "the first one too many"));
        }
        match kind {
            TokenKind::Mark(b'(' | b'[' | b'{') => {
                push_bracket(&mut open, index, scanner.span(start))?
            }
            TokenKind::Mark(mark @ (b')' | b']' | b'}')) => {
                close_bracket(&mut tokens, &mut open, mark, &scanner, start)?
            }
            _ => {}
        }
    }
    match open.last() {
        Some(index) => Err(unclosed_bracket(&tokens[*index as usize], source)),
        None => Ok(tokens),
    }
}

fn push_bracket(open: &mut Vec<u32>, index: u32, span: Span) -> Result<(), Diagnostic> {
    open.push(index);
    if open.len() <= LIMITS.nesting {
        return Ok(());
    }
    Err(Diagnostic::error(
        codes::NESTING_TOO_DEEP,
        format!("brackets nest more than {} deep", LIMITS.nesting),
    )
    .at(span, "here"))
}

fn close_bracket(
    tokens: &mut [Token],
    open: &mut Vec<u32>,
    mark: u8,
    scanner: &TokenScanner<'_>,
    start: usize,
) -> Result<(), Diagnostic> {
    let index = tokens.len() - 1;
    let Some(opener) = open.pop() else {
        return Err(Diagnostic::error(
            codes::UNBALANCED_BRACKET,
            format!("`{}` closes nothing", mark as char),
        )
        .at(scanner.span(start), "no open bracket before this"));
    };
    let expected = match tokens[opener as usize].kind {
        TokenKind::Mark(b'(') => b')',
        TokenKind::Mark(b'[') => b']',
        _ => b'}',
    };
    if mark != expected {
        return Err(Diagnostic::error(
            codes::UNBALANCED_BRACKET,
            format!("expected `{}`, found `{}`", expected as char, mark as char),
        )
        .at(scanner.span(start), format!("`{}` was expected here", expected as char))
        .at(span_of(&tokens[opener as usize], scanner.source), "to close this"));
    }
    tokens[index].partner = opener;
    tokens[opener as usize].partner = index as u32;
    Ok(())
}

fn unclosed_bracket(token: &Token, source: SourceId) -> Diagnostic {
    let mark = if let TokenKind::Mark(mark) = token.kind { mark as char } else { '{' };
    Diagnostic::error(codes::UNBALANCED_BRACKET, format!("`{mark}` is never closed"))
        .at(span_of(token, source), "opened here")
}

fn span_of(token: &Token, source: SourceId) -> Span {
    Span { source, start: token.start, end: token.end }
}

struct TokenScanner<'a> {
    text: &'a str,
    bytes: &'a [u8],
    at: usize,
    source: SourceId,
}

impl TokenScanner<'_> {
    fn span(&self, start: usize) -> Span {
        Span::new(self.source, start..self.at)
    }

    fn peek(&self, ahead: usize) -> u8 {
        self.bytes.get(self.at + ahead).copied().unwrap_or(0)
    }

    /// Goes to the next token; false at the end of the text.
    fn skip_blank(&mut self) -> Result<bool, Diagnostic> {
        while self.at < self.bytes.len() {
            match self.bytes[self.at] {
                b' ' | b'\t'..=b'\r' => self.at += 1,
                b'/' if self.peek(1) == b'/' => self.line_comment(),
                b'/' if self.peek(1) == b'*' => self.block_comment()?,
                0x80.. => match self.character() {
                    Some(blank) if is_blank(blank) => self.at += blank.len_utf8(),
                    _ => return Ok(true),
                },
                _ => return Ok(true),
            }
        }
        Ok(false)
    }

    fn character(&self) -> Option<char> {
        self.text[self.at..].chars().next()
    }

    fn line_comment(&mut self) {
        self.at += line_comment(&self.text[self.at..]);
    }

    fn block_comment(&mut self) -> Result<(), Diagnostic> {
        let start = self.at;
        let (length, is_closed) = block_comment(&self.text[start..]);
        self.at += length;
        if is_closed {
            return Ok(());
        }
        Err(Diagnostic::error(codes::UNTERMINATED_COMMENT, "a block comment is never closed")
            .at(Span::new(self.source, start..start + 2), "opened here")
            .note("block comments nest: each `/*` inside needs a `*/` of its own"))
    }

    fn token(&mut self, names: &mut Names) -> Result<TokenKind, Diagnostic> {
        let start = self.at;
        match self.bytes[start] {
            b'a'..=b'z' | b'A'..=b'Z' | b'_' => Ok(self.word(names)),
            b'0'..=b'9' => Ok(self.number()),
            b'.' if self.peek(1).is_ascii_digit() => Ok(self.number()),
            b':' if self.peek(1) == b':' => Ok(self.two(TokenKind::Path)),
            b'-' if self.peek(1) == b'>' => Ok(self.two(TokenKind::Arrow)),
            mark @ (b'!'
            | b'%'
            | b'&'
            | b'('..=b'/'
            | b':'..=b'>'
            | b'@'
            | b'['
            | b']'
            | b'^'
            | b'{'..=b'~') => {
                self.at += 1;
                Ok(TokenKind::Mark(mark))
            }
            _ => match self.character() {
                Some(letter) if begins_word(letter) => Ok(self.word(names)),
                other => Err(self.stray(other.unwrap_or('\0'))),
            },
        }
    }

    fn two(&mut self, kind: TokenKind) -> TokenKind {
        self.at += 2;
        kind
    }

    fn stray(&self, letter: char) -> Diagnostic {
        let span = Span::new(
            self.source,
            self.at..self.at + letter.len_utf8().min(self.bytes.len() - self.at),
        );
        let found = Diagnostic::error(
            codes::SYNTAX_ERROR,
            format!("unexpected character `{}`", letter.escape_debug()),
        );
        match letter {
            '#' => {
                found.at(span, "WGSL has no preprocessor").note("help: use `import` and `@if(...)`")
            }
            _ => found.at(span, "not a character of WGSL"),
        }
    }

    fn word(&mut self, names: &mut Names) -> TokenKind {
        let start = self.at;
        self.at = word_end(self.text, start);
        TokenKind::Word(names.intern(&self.text[start..self.at]))
    }

    /// A numeric literal. It is not checked here, since naga does that.
    fn number(&mut self) -> TokenKind {
        self.at = number_end(self.text, self.at);
        TokenKind::Number
    }
}
