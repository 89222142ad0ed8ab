//! Spellings as numbers, so that tokens are small and cheap to compare.

use std::collections::HashMap;
use std::sync::Arc;

use crate::words::same_bytes;

/// Index of a spelling in its [`Symbols`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Symbol(pub u32);

impl Symbol {
    /// As an index into tables by symbol.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

macro_rules! known {
    ($($name:ident $text:literal)*) => {
        /// Spellings that the composer itself uses. They have the same numbers in every
        /// [`Symbols`].
        pub mod known {
            use super::{Symbol, known_position};
            $(#[doc = $text] pub const $name: Symbol = known_position($text);)*
        }

        const KNOWN: &[&str] = &[$($text),*];
    };
}

known! {
    HASH "#" PASTE "##" OPEN "(" CLOSE ")" COMMA "," SEMICOLON ";" DOT "." ASSIGN "="
    OPEN_BRACE "{" CLOSE_BRACE "}" OPEN_BRACKET "[" CLOSE_BRACKET "]"
    PLUS "+" MINUS "-" STAR "*" SLASH "/" PERCENT "%" NOT "!" TILDE "~"
    LESS "<" GREATER ">" LESS_EQUAL "<=" GREATER_EQUAL ">=" EQUAL "==" NOT_EQUAL "!=" SHIFT_LEFT "<<" SHIFT_RIGHT ">>"
    AND "&" OR "|" XOR "^" AND_AND "&&" OR_OR "||" XOR_XOR "^^"
    DEFINED "defined" INCLUDE "include" DEFINE "define" UNDEF "undef"
    IF "if" IFDEF "ifdef" IFNDEF "ifndef" ELIF "elif" ELSE "else" ENDIF "endif"
    ERROR "error" LINE "line" VERSION "version" EXTENSION "extension" PRAGMA "pragma" ONCE "once"
    MACRO_LINE "__LINE__" MACRO_FILE "__FILE__" MACRO_VERSION "__VERSION__"
    MAIN "main" STRUCT "struct" LAYOUT "layout" PRECISION "precision" INVARIANT "invariant" PRECISE "precise"
    IN "in" OUT "out" UNIFORM "uniform" BUFFER "buffer" CONST "const"
    INT "int" PER_VERTEX "gl_PerVertex"
}

/// The number of one of the spellings in `KNOWN`. Any other text is an error at compile time.
const fn known_position(text: &str) -> Symbol {
    let mut index = 0;
    while !same_bytes(KNOWN[index].as_bytes(), text.as_bytes()) {
        index += 1;
    }
    Symbol(index as u32)
}

/// A table of spellings and their numbers.
#[derive(Debug, Clone)]
pub struct Symbols {
    texts: Vec<Arc<str>>,
    index: HashMap<Arc<str>, Symbol>,
}

impl Default for Symbols {
    fn default() -> Self {
        let mut symbols = Self { texts: Vec::new(), index: HashMap::new() };
        for text in KNOWN {
            symbols.intern(text);
        }
        symbols
    }
}

impl Symbols {
    /// The number of a spelling; a new one gets the next number.
    pub fn intern(&mut self, text: &str) -> Symbol {
        if let Some(symbol) = self.find(text) {
            return symbol;
        }
        let symbol = Symbol(self.texts.len() as u32);
        let text: Arc<str> = text.into();
        self.texts.push(text.clone());
        self.index.insert(text, symbol);
        symbol
    }

    /// The number of a spelling that was met before.
    pub fn find(&self, text: &str) -> Option<Symbol> {
        self.index.get(text).copied()
    }

    /// The spelling behind a number of this set.
    pub fn text(&self, symbol: Symbol) -> &str {
        &self.texts[symbol.index()]
    }

    /// How many spellings there are.
    pub fn count(&self) -> usize {
        self.texts.len()
    }
}
