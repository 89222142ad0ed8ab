//! Splits text into words, numbers and punctuation. Every bracket knows its partner. A cursor gives
//! access to tokens by index. Identifiers become numbers, which are cheap to compare and can index
//! tables.

use crate::wesl::advice;
use crate::wesl::balance::balance_brackets;
use crate::wesl::blank::{block_comment, is_blank, line_comment};
use crate::words::{begins_word, number_end, same_bytes, word_end};
use lamplight_diagnostic::source::{LIMITS, SourceId, Span};
use lamplight_diagnostic::{Diagnostic, codes};
use rustc_hash::FxHashMap;
use std::ops::Range;
use std::sync::Arc;

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
    let found = tokenize_damaged(text, source, names)?;
    found.error.map_or(Ok(found.tokens), Err)
}

/// The tokens of a text that may have mistakes.
pub struct DamagedTokens {
    /// All brackets have partners.
    pub tokens: Vec<Token>,
    /// The first mistake: a character or a bracket.
    pub error: Option<Diagnostic>,
}

/// After so many comments that are never closed, the rest of a text is one.
const OPEN_COMMENTS: usize = 16;

/// Splits a text into tokens, going on after mistakes: what cannot be a token is left out, a block
/// comment that is never closed ends with its line, and brackets are balanced.
///
/// # Errors
/// For a text beyond a limit.
pub fn tokenize_damaged(
    text: &str,
    source: SourceId,
    names: &mut Names,
) -> Result<DamagedTokens, Diagnostic> {
    let mut scanner = TokenScanner { text, bytes: text.as_bytes(), at: 0, source, unclosed: 0 };
    let mut tokens: Vec<Token> = Vec::with_capacity(text.len() / 4);
    let mut open: Vec<u32> = Vec::new();
    let mut mistakes = Mistakes::default();
    if text.starts_with('\u{feff}') {
        scanner.at = '\u{feff}'.len_utf8();
    }
    while scanner.next_token(&mut mistakes) {
        let start = scanner.at;
        let kind = match scanner.token(names) {
            Ok(kind) => kind,
            Err(error) => {
                mistakes.add(error);
                scanner.at += scanner.character().map_or(1, char::len_utf8);
                continue;
            }
        };
        let index = tokens.len() as u32;
        tokens.push(Token { kind, start: start as u32, end: scanner.at as u32, partner: index });
        if tokens.len() > LIMITS.tokens {
            return Err(too_many_tokens(scanner.span(start)));
        }
        match kind {
            // From the first wrong bracket on, partners are looked for in the whole text.
            _ if mistakes.is_unbalanced => {}
            TokenKind::Mark(b'(' | b'[' | b'{') => {
                push_bracket(&mut open, index, scanner.span(start))?
            }
            TokenKind::Mark(mark @ (b')' | b']' | b'}')) => {
                let closed = close_bracket(&mut tokens, &mut open, mark, &scanner, start);
                mistakes.is_unbalanced = closed.is_err();
                closed.err().into_iter().for_each(|error| mistakes.add(error));
            }
            _ => {}
        }
    }
    if let Some(index) = open.last().filter(|_| !mistakes.is_unbalanced) {
        mistakes.is_unbalanced = true;
        mistakes.add(unclosed_bracket(&tokens, *index as usize, text, source));
    }
    if mistakes.is_unbalanced {
        tokens = balance_brackets(&tokens, text);
    }
    Ok(DamagedTokens { tokens, error: mistakes.first })
}

fn too_many_tokens(first: Span) -> Diagnostic {
    let message = format!("more than {} tokens in one file", LIMITS.tokens);
    Diagnostic::error(codes::TOO_MANY_TOKENS, message).at(first, "the first one too many")
}

/// What is wrong with a text so far.
#[derive(Default)]
struct Mistakes {
    first: Option<Diagnostic>,
    is_unbalanced: bool,
}

impl Mistakes {
    fn add(&mut self, error: Diagnostic) {
        self.first.get_or_insert(error);
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
    let TokenKind::Mark(opened) = tokens[opener as usize].kind else { return Ok(()) };
    let expected = closer(opened);
    if mark != expected {
        let error = Diagnostic::error(
            codes::UNBALANCED_BRACKET,
            format!("expected `{}`, found `{}`", expected as char, mark as char),
        )
        .at(scanner.span(start), format!("`{}` was expected here", expected as char))
        .at(span_of(&tokens[opener as usize], scanner.source), "to close this");
        let before = span_of(&tokens[index - 1], scanner.source);
        if advice::opens_condition(scanner.text, tokens[opener as usize].start as usize) {
            return Err(error.note("help: write `)` behind the condition"));
        }
        return Err(advice::missing_closer(scanner.text, before, expected as char, error));
    }
    tokens[index].partner = opener;
    tokens[opener as usize].partner = index as u32;
    Ok(())
}

/// The error about a bracket that is open at the end. Where the author's indentation shows another one
/// that is not closed, it is the place.
fn unclosed_bracket(tokens: &[Token], index: usize, text: &str, source: SourceId) -> Diagnostic {
    let token = &tokens[index];
    let mark = if let TokenKind::Mark(mark) = token.kind { mark as char } else { '{' };
    let error = Diagnostic::error(codes::UNBALANCED_BRACKET, format!("`{mark}` is never closed"));
    let closes = |token: &&Token| {
        token.kind == TokenKind::Mark(b'}') && token.partner as usize != tokens.len()
    };
    let pairs = tokens
        .iter()
        .filter(closes)
        .map(|token| (tokens[token.partner as usize].start as usize, token.start as usize));
    match advice::unclosed_by_indentation(text, pairs).filter(|_| mark == '{') {
        Some((open, line)) => error
            .at(
                Span::new(source, open..open + 1),
                "what closes it stands further left than this line",
            )
            .note(format!("help: write `}}` before line {line}")),
        None => error
            .at(span_of(token, source), "opened here")
            .note(format!("help: write `{}` where it ends", closer(mark as u8) as char)),
    }
}

/// The bracket that closes one.
fn closer(mark: u8) -> u8 {
    match mark {
        b'(' => b')',
        b'[' => b']',
        _ => b'}',
    }
}

fn span_of(token: &Token, source: SourceId) -> Span {
    Span { source, start: token.start, end: token.end }
}

struct TokenScanner<'a> {
    text: &'a str,
    bytes: &'a [u8],
    at: usize,
    source: SourceId,
    /// How many block comments were never closed.
    unclosed: usize,
}

impl TokenScanner<'_> {
    /// Goes to the next token, past comments that are never closed; false at the end of the text.
    fn next_token(&mut self, mistakes: &mut Mistakes) -> bool {
        loop {
            match self.skip_blank() {
                Ok(goes_on) => return goes_on,
                Err(error) => mistakes.add(error),
            }
        }
    }

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
        self.unclosed += 1;
        if self.unclosed <= OPEN_COMMENTS {
            self.at = start + line_comment(&self.text[start..]);
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
            '#' => found
                .at(span, "WGSL has no preprocessor")
                .note(advice::directive(self.text, self.at)),
            '?' => found
                .at(span, "WGSL has no `?:`")
                .note("help: `select(otherwise, value, condition)`"),
            '"' | '\'' => match advice::quoted_import(self.text, self.at) {
                Some(help) => found.at(span, "paths stand without quotes").note(help),
                None => found.at(span, "WGSL has no strings").note("help: leave it out"),
            },
            _ => found
                .at(span, "not a character of WGSL")
                .note("help: leave it out: names have letters, digits and `_`"),
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

/// The tokens of a file, with what diagnostics about them need.
#[derive(Clone, Copy)]
pub struct Tokens<'a> {
    pub tokens: &'a [Token],
    pub text: &'a str,
    pub names: &'a Names,
    pub source: SourceId,
}

impl<'a> Tokens<'a> {
    pub fn len(self) -> usize {
        self.tokens.len()
    }

    pub fn is_empty(self) -> bool {
        self.tokens.is_empty()
    }

    pub fn kind(self, at: usize) -> Option<TokenKind> {
        self.tokens.get(at).map(|token| token.kind)
    }

    pub fn is(self, at: usize, mark: u8) -> bool {
        self.kind(at) == Some(TokenKind::Mark(mark))
    }

    pub fn is_word(self, at: usize, name: Name) -> bool {
        self.kind(at) == Some(TokenKind::Word(name))
    }

    /// The word at a token, if it is one.
    pub fn word(self, at: usize) -> Option<Name> {
        match self.kind(at) {
            Some(TokenKind::Word(name)) => Some(name),
            _ => None,
        }
    }

    /// The identifier at a token, or an error that says what was found instead.
    pub fn identifier(self, at: usize, what: &str) -> Result<Name, Diagnostic> {
        match self.word(at) {
            Some(name) if !name.is_keyword() => Ok(name),
            _ => Err(self.expected(at, what)),
        }
    }

    /// The index of the bracket that closes the one at `at`.
    pub fn partner(self, at: usize) -> usize {
        self.tokens[at].partner as usize
    }

    /// The first `mark` in `from..limit` that is outside of brackets.
    pub fn find(self, from: usize, limit: usize, mark: u8) -> Option<usize> {
        let mut at = from;
        while at < limit {
            if self.is(at, mark) {
                return Some(at);
            }
            at = self.partner(at).max(at) + 1;
        }
        None
    }

    /// The bytes of the tokens `from..to`; `to` is after the last one.
    pub fn range(self, from: usize, to: usize) -> Range<u32> {
        self.start(from)..self.tokens[..to].last().map_or(0, |token| token.end)
    }

    /// The first byte of a token, or the end of the text.
    pub fn start(self, at: usize) -> u32 {
        self.tokens.get(at).map_or(self.text.len() as u32, |token| token.start)
    }

    pub fn span(self, at: usize) -> Span {
        match self.tokens.get(at) {
            Some(token) => Span { source: self.source, start: token.start, end: token.end },
            None => Span::new(self.source, self.text.len()..self.text.len()),
        }
    }

    pub fn text(self, at: usize) -> &'a str {
        self.tokens.get(at).map_or("", |token| &self.text[token.start as usize..token.end as usize])
    }

    /// A syntax error at a token.
    pub fn expected(self, at: usize, what: &str) -> Diagnostic {
        let found = if at < self.len() {
            format!("`{}`", self.text(at))
        } else {
            "the end of the file".to_owned()
        };
        let error =
            Diagnostic::error(codes::SYNTAX_ERROR, format!("expected {what}, found {found}"))
                .at(self.span(at), format!("expected {what}"));
        advice::advised(self, at, what, error)
    }

    /// Steps over the token if it is `mark`; otherwise an error.
    pub fn expect(self, at: usize, mark: u8, what: &str) -> Result<usize, Diagnostic> {
        if self.is(at, mark) { Ok(at + 1) } else { Err(self.expected(at, what)) }
    }
}

/// An interned identifier.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Name(pub u32);

/// Words that begin or divide a statement or a declaration, which editors offer.
pub fn keywords() -> impl Iterator<Item = &'static str> {
    const NOT_OFFERED: [&str; 5] = ["_", "diagnostic", "false", "requires", "true"];
    let words = WORDS[..=Name::IMPORT.0 as usize].iter().copied();
    words.filter(|word| !NOT_OFFERED.contains(word))
}

/// Keywords of WGSL and the words WESL gives a meaning, interned first and in this order.
const WORDS: &[&str] = &[
    "_",
    "alias",
    "break",
    "case",
    "const",
    "const_assert",
    "continue",
    "continuing",
    "default",
    "diagnostic",
    "discard",
    "else",
    "enable",
    "false",
    "fn",
    "for",
    "if",
    "let",
    "loop",
    "override",
    "requires",
    "return",
    "struct",
    "switch",
    "true",
    "var",
    "while",
    "import",
    "package",
    "super",
    "as",
    "elif",
    "constants",
];

/// Whether the word is a keyword of WGSL. WESL's own words come after those.
pub fn is_keyword(word: &str) -> bool {
    WORDS[Name::ALIAS.0 as usize..=Name::WHILE.0 as usize].contains(&word)
}

/// Whether the word can be the first name of a path that leads into another package.
pub fn is_path_name(word: &str) -> bool {
    !WORDS.contains(&word) && word != "self"
}

macro_rules! words {
    ($($constant:ident = $text:literal),* $(,)?) => {
        impl Name { $(#[doc = concat!("`", $text, "`.")] pub const $constant: Name = Name(known_position($text));)* }
    };
}

words! {
    UNDERSCORE = "_", ALIAS = "alias", BREAK = "break", CASE = "case", CONST = "const", CONST_ASSERT = "const_assert", CONTINUE = "continue", CONTINUING = "continuing",
    DEFAULT = "default", DIAGNOSTIC = "diagnostic", DISCARD = "discard", ELSE = "else", ENABLE = "enable", FALSE = "false", FN = "fn", FOR = "for",
    IF = "if", LET = "let", LOOP = "loop", OVERRIDE = "override", REQUIRES = "requires", RETURN = "return", STRUCT = "struct", SWITCH = "switch",
    TRUE = "true", VAR = "var", WHILE = "while", IMPORT = "import", PACKAGE = "package", SUPER = "super", AS = "as", ELIF = "elif",
    CONSTANTS = "constants",
}

const fn known_position(word: &str) -> u32 {
    let mut index = 0;
    while index < WORDS.len() {
        if same_bytes(WORDS[index].as_bytes(), word.as_bytes()) {
            return index as u32;
        }
        index += 1;
    }
    u32::MAX
}

impl Name {
    /// Whether the word begins a declaration of the module, and nothing else.
    pub fn begins_item(self) -> bool {
        [Self::FN, Self::STRUCT, Self::OVERRIDE, Self::ALIAS, Self::IMPORT].contains(&self)
    }

    /// Whether the word begins a statement, and is in no expression.
    pub fn begins_statement(self) -> bool {
        [Self::CONST, Self::CONST_ASSERT, Self::IF].contains(&self) || self.begins_block_statement()
    }

    /// Whether the word begins a statement, and no condition.
    pub fn begins_block_statement(self) -> bool {
        let words = [
            Self::BREAK,
            Self::CONTINUE,
            Self::DISCARD,
            Self::FOR,
            Self::LET,
            Self::LOOP,
            Self::RETURN,
            Self::SWITCH,
            Self::VAR,
            Self::WHILE,
        ];
        words.contains(&self)
    }

    /// Whether WGSL forbids the word as an identifier, or WESL does: `import`, `package` and
    /// `super`.
    pub fn is_keyword(self) -> bool {
        self.0 <= Self::SUPER.0
    }
}

/// The identifiers of a graph.
#[derive(Debug, Clone)]
pub struct Names {
    texts: Vec<Arc<str>>,
    // A fast hash without protection against collisions: limits bound the harm that a hostile file
    // can do.
    numbers: FxHashMap<Arc<str>, Name>,
}

impl Default for Names {
    fn default() -> Self {
        let mut names = Self { texts: Vec::new(), numbers: FxHashMap::default() };
        for word in WORDS {
            names.intern(word);
        }
        names
    }
}

impl Names {
    /// The number of an identifier; a new one gets the next number.
    pub fn intern(&mut self, text: &str) -> Name {
        if let Some(name) = self.numbers.get(text) {
            return *name;
        }
        let name = Name(self.texts.len() as u32);
        let text: Arc<str> = text.into();
        self.texts.push(Arc::clone(&text));
        self.numbers.insert(text, name);
        name
    }

    /// The number of an identifier that occurs somewhere.
    pub fn find(&self, text: &str) -> Option<Name> {
        self.numbers.get(text).copied()
    }

    /// The identifier behind a number of this table.
    pub fn text(&self, name: Name) -> &str {
        &self.texts[name.0 as usize]
    }

    /// How many there are; every number is below.
    pub fn len(&self) -> usize {
        self.texts.len()
    }

    /// Always false, since the keywords are there from the start.
    pub fn is_empty(&self) -> bool {
        self.texts.is_empty()
    }
}
