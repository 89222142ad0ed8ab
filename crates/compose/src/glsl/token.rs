//! Tokens after preprocessing.

use lamplight_diagnostic::source::Span;
use lamplight_syntax::glsl::{Module, Symbol, Token, TokenKind};

/// In `before` and `after` of a [`Tok`]: no token.
pub const NONE: u32 = u32::MAX;

/// In `setting` of a [`Tok`]: no setting.
pub const NO_SETTING: u16 = u16::MAX;

/// A token of the result, or one that is still being expanded.
#[derive(Debug, Clone, Copy)]
pub struct Tok {
    pub symbol: Symbol,
    /// Its bytes in the author's file. A token from a macro has those of the macro's use.
    pub start: u32,
    pub end: u32,
    /// Index of the module that has these bytes.
    pub module: u32,
    /// The author's token whose leading space and comments precede this one; `NONE` inside
    /// expansions.
    pub before: u32,
    /// The author's token whose trailing comments follow this one.
    pub after: u32,
    /// The setting whose value this token is, if it is one.
    pub setting: u16,
    pub kind: TokenKind,
    pub spaced: bool,
    /// Never to be expanded again.
    pub painted: bool,
    /// Made by a macro rather than copied.
    pub expanded: bool,
}

impl Tok {
    /// A copy of token `index` of a module.
    pub fn copy(module: u32, index: u32, token: &Token) -> Self {
        Self {
            symbol: token.symbol,
            start: token.start,
            end: token.end,
            module,
            before: index,
            after: index,
            setting: NO_SETTING,
            kind: token.kind,
            spaced: token.spaced,
            painted: false,
            expanded: false,
        }
    }

    /// The author's text behind it.
    pub fn span(&self, modules: &[Module]) -> Span {
        Span { source: modules[self.module as usize].source, start: self.start, end: self.end }
    }

    /// Whether it stands in the result just as its author wrote it.
    pub fn is_plain(&self) -> bool {
        !self.expanded && self.before != NONE && self.before == self.after
    }
}
