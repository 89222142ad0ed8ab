//! GLSL files as the preprocessor sees them: runs of text between directives.
//!
//! A file is tokenised once. Which parts of it are active is decided later.

mod directive;
mod lexer;
pub mod words;

use std::ops::Range;
use std::sync::Arc;

pub use lexer::{Symbol, Symbols, known};
pub use lexer::{Token, TokenKind, single_token, tokenize};
pub use lexer::{block_comment_end, line_comment_end};

use lamplight_diagnostic::source::{LIMITS, SourceId, SourceSet, Span};
use lamplight_diagnostic::{Diagnostic, codes};

/// The words that may follow the `#` of a directive.
pub const DIRECTIVES: &[&str] = &[
    "define",
    "elif",
    "else",
    "endif",
    "error",
    "extension",
    "if",
    "ifdef",
    "ifndef",
    "include",
    "line",
    "pragma",
    "undef",
    "version",
];

/// A tokenised file.
#[derive(Debug)]
pub struct Module {
    pub source: SourceId,
    pub text: Arc<str>,
    /// All tokens, those of directives too.
    pub tokens: Vec<Token>,
    /// The runs of text and the directives of the file, in order.
    pub parts: Vec<FilePart>,
    /// Every `#include`, active or not.
    pub includes: Vec<Include>,
    /// Errors that do not depend on which parts are active.
    pub errors: Vec<Diagnostic>,
    line_starts: Vec<u32>,
}

/// A part of a file, in whole lines.
#[derive(Debug)]
pub enum FilePart {
    Text(TextPart),
    Directive(Directive, Span),
}

/// Text between directives.
#[derive(Debug)]
pub struct TextPart {
    /// Indices of its tokens.
    pub tokens: Range<u32>,
    /// Its bytes, comments and white space at both ends included.
    pub bytes: Range<u32>,
}

/// A line that begins with `#`. `next` and `end` are indices of [`Module::parts`]: `next` of the
/// branch or `#endif` that follows, `end` of the `#endif`.
#[derive(Debug)]
pub enum Directive {
    /// Index into [`Module::includes`].
    Include(usize),
    Define(Macro),
    Undef(Symbol),
    If {
        condition: Range<u32>,
        next: usize,
    },
    Ifdef {
        name: Result<Symbol, Box<Diagnostic>>,
        negated: bool,
        next: usize,
    },
    Elif {
        condition: Range<u32>,
        next: usize,
        end: usize,
    },
    Else {
        end: usize,
    },
    Endif,
    /// The author's message.
    Error(Span),
    /// Tokens after `#line`.
    Line(Range<u32>),
    Version {
        number: u32,
        es: bool,
        line: Span,
    },
    Extension {
        name: Symbol,
        line: Span,
    },
    PragmaOnce,
    Pragma(Span),
    /// A `#` alone.
    Empty,
    /// A malformed directive. It is an error only where it is active.
    Invalid(Box<Diagnostic>),
}

/// An `#include`.
#[derive(Debug)]
pub struct Include {
    /// As written between the quotes or angles.
    pub path: String,
    /// `<path>` rather than `"path"`.
    pub angled: bool,
    /// The path with its quotes.
    pub span: Span,
}

/// A `#define`.
#[derive(Debug)]
pub struct Macro {
    pub name: Symbol,
    pub name_span: Span,
    /// How many parameters; `None` for an object-like macro.
    pub parameters: Option<usize>,
    pub body: Vec<BodyToken>,
}

/// A token of a macro's replacement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BodyToken {
    pub symbol: Symbol,
    pub kind: TokenKind,
    pub spaced: bool,
    /// The index of the parameter that it names, if it names one.
    pub parameter: Option<u16>,
    /// Whether a `##` joins it to the next.
    pub pasted: bool,
}

impl Module {
    /// Line, from 1, of a byte.
    pub fn line(&self, byte: u32) -> usize {
        self.line_starts.partition_point(|start| *start <= byte)
    }

    /// The run of text that has the token; `None` for a token of a directive.
    pub fn text_part(&self, token: u32) -> Option<&TextPart> {
        let after = self.parts.partition_point(|part| match part {
            FilePart::Text(text) => text.bytes.start <= self.tokens[token as usize].start,
            FilePart::Directive(_, span) => span.start <= self.tokens[token as usize].start,
        });
        match self.parts.get(after.checked_sub(1)?) {
            Some(FilePart::Text(text)) => Some(text),
            _ => None,
        }
    }
}

/// Tokenises a file and reads its directives.
pub fn parse(sources: &SourceSet, source: SourceId, symbols: &mut Symbols) -> Module {
    let text = sources.get(source).text.clone();
    let mut errors = Vec::new();
    let tokens = lexer::tokenize(&text, symbols, LIMITS.tokens).unwrap_or_else(|error| {
        errors.push(lex_error(source, &text, error));
        Vec::new()
    });
    let line_starts =
        std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at as u32 + 1)).collect();
    let mut module = Module {
        source,
        text,
        tokens,
        parts: Vec::new(),
        includes: Vec::new(),
        errors,
        line_starts,
    };
    split_parts(&mut module, symbols);
    directive::link_branches(&mut module);
    module
}

fn lex_error(source: SourceId, text: &str, error: lexer::LexError) -> Diagnostic {
    match error {
        lexer::LexError::OpenComment(at) => {
            Diagnostic::error(codes::UNTERMINATED_COMMENT, "a comment is never closed")
                .at(Span::new(source, at..at + 2), "opened here, without a `*/` after it")
        }
        lexer::LexError::TooMany(at) => {
            let end = at + text[at..].chars().next().map_or(0, char::len_utf8);
            Diagnostic::error(
                codes::TOO_MANY_TOKENS,
                format!("a file has more than {} tokens", LIMITS.tokens),
            )
            .at(Span::new(source, at..end), "the first one too many")
        }
    }
}

/// Cuts the tokens into text and directives.
fn split_parts(module: &mut Module, symbols: &Symbols) {
    let (mut token, mut byte) = (0, 0);
    while token < module.tokens.len() {
        let hash = find_from(&module.tokens, token, |token| {
            token.first_of_line && token.symbol == known::HASH
        });
        let start = module.tokens.get(hash).map_or(module.text.len(), |token| token.start as usize);
        push_text(module, token..hash, byte..start);
        if hash == module.tokens.len() {
            return;
        }
        module.tokens[hash].first_of_part = true;
        let end = find_from(&module.tokens, hash + 1, |token| token.first_of_line);
        directive::push_directive(module, hash, end, symbols);
        byte = lexer::line_end(&module.text, module.tokens[end - 1].end as usize);
        token = end;
    }
}

/// The index of the first token from `start` on for which `is_sought` holds, or the number of
/// tokens.
fn find_from(tokens: &[Token], start: usize, is_sought: impl Fn(&Token) -> bool) -> usize {
    tokens[start..].iter().position(is_sought).map_or(tokens.len(), |offset| start + offset)
}

fn push_text(module: &mut Module, tokens: Range<usize>, bytes: Range<usize>) {
    if tokens.is_empty() {
        return;
    }
    module.tokens[tokens.start].clean = false;
    module.tokens[tokens.start].first_of_part = true;
    let bytes = bytes.start as u32..bytes.end as u32;
    module
        .parts
        .push(FilePart::Text(TextPart { tokens: tokens.start as u32..tokens.end as u32, bytes }));
}
