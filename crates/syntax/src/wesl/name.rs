//! Identifiers as numbers, which are cheap to compare and can index tables.

use std::sync::Arc;

use rustc_hash::FxHashMap;

use crate::words::same_bytes;

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
    UNDERSCORE = "_", ALIAS = "alias", CASE = "case", CONST = "const", CONST_ASSERT = "const_assert", CONTINUING = "continuing",
    DEFAULT = "default", DIAGNOSTIC = "diagnostic", ELSE = "else", ENABLE = "enable", FALSE = "false", FN = "fn", FOR = "for",
    IF = "if", LET = "let", LOOP = "loop", OVERRIDE = "override", REQUIRES = "requires", STRUCT = "struct", SWITCH = "switch",
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
