//! The macros that are defined at one point of a composition.

use std::collections::HashMap;

use lamplight_syntax::glsl::{Macro, Symbol, Symbols, known};

/// What a name expands to.
#[derive(Debug, Clone, Copy)]
pub enum MacroMeaning<'g> {
    /// The author's macro, and whether it is being expanded now.
    User {
        definition: &'g Macro,
        active: bool,
    },
    /// The value of a setting, by its number in [`Reads`](super::reads::Reads).
    Setting(u16),
    /// A fixed number.
    Number(Symbol),
    Line,
    File,
}

/// The spellings of the graph, and those made while composing.
pub struct Spellings<'g> {
    base: &'g Symbols,
    added: Vec<Box<str>>,
    index: HashMap<Box<str>, Symbol>,
}

impl<'g> Spellings<'g> {
    /// The spellings of the graph.
    pub fn new(base: &'g Symbols) -> Self {
        Self { base, added: Vec::new(), index: HashMap::new() }
    }

    /// The number of a spelling, new if need be.
    pub fn intern(&mut self, text: &str) -> Symbol {
        if let Some(symbol) = self.find(text) {
            return symbol;
        }
        let symbol = Symbol(self.count() as u32);
        self.added.push(text.into());
        self.index.insert(text.into(), symbol);
        symbol
    }

    /// The number of a spelling that was met before.
    pub fn find(&self, text: &str) -> Option<Symbol> {
        self.base.find(text).or_else(|| self.index.get(text).copied())
    }

    /// The spelling behind a number.
    pub fn text(&self, symbol: Symbol) -> &str {
        match symbol.index().checked_sub(self.base.count()) {
            Some(index) => &self.added[index],
            None => self.base.text(symbol),
        }
    }

    /// How many spellings there are.
    pub fn count(&self) -> usize {
        self.base.count() + self.added.len()
    }
}

/// Definitions by name.
pub struct MacroTable<'g> {
    pub spellings: Spellings<'g>,
    by_symbol: Vec<u32>,
    meanings: Vec<MacroMeaning<'g>>,
}

/// In `by_symbol`: the name is not defined.
const UNDEFINED: u32 = 0;

impl<'g> MacroTable<'g> {
    /// The predefined macros of a language version.
    pub fn new(symbols: &'g Symbols, version: u32, es: bool) -> Self {
        let spellings = Spellings::new(symbols);
        let mut table =
            Self { spellings, by_symbol: vec![UNDEFINED; symbols.count()], meanings: Vec::new() };
        table.set(known::MACRO_LINE, MacroMeaning::Line);
        table.set(known::MACRO_FILE, MacroMeaning::File);
        table.number("__VERSION__", i64::from(version));
        table.number("GL_GOOGLE_include_directive", 1);
        if es {
            table.number("GL_ES", 1);
        } else {
            table.number("GL_core_profile", 1);
        }
        // The version of Vulkan's semantics (GL_KHR_vulkan_glsl). They are assumed from `#version
        // 440` on.
        if !es && version >= 440 {
            table.number("VULKAN", 100);
        }
        table
    }

    /// Defines a name as a fixed number.
    pub fn number(&mut self, name: &str, value: i64) {
        let name = self.spellings.intern(name);
        let value = self.spellings.intern(&value.to_string());
        self.set(name, MacroMeaning::Number(value));
    }

    /// What a name means now.
    pub fn get(&self, name: Symbol) -> Option<MacroMeaning<'g>> {
        match self.by_symbol.get(name.index()) {
            None | Some(&UNDEFINED) => None,
            Some(index) => Some(self.meanings[*index as usize - 1]),
        }
    }

    /// Whether a name is a macro. This is the fast path over text without macros.
    pub fn has(&self, name: Symbol) -> bool {
        self.by_symbol.get(name.index()).is_some_and(|index| *index != UNDEFINED)
    }

    /// Defines a name, whatever it meant before.
    pub fn set(&mut self, name: Symbol, meaning: MacroMeaning<'g>) {
        if name.index() >= self.by_symbol.len() {
            self.by_symbol.resize(self.spellings.count(), UNDEFINED);
        }
        self.meanings.push(meaning);
        self.by_symbol[name.index()] = self.meanings.len() as u32;
    }

    /// Forgets a name.
    pub fn unset(&mut self, name: Symbol) {
        if let Some(index) = self.by_symbol.get_mut(name.index()) {
            *index = UNDEFINED;
        }
    }

    /// Whether a name is an author's macro inside its own expansion.
    pub fn is_active(&self, name: Symbol) -> bool {
        matches!(self.get(name), Some(MacroMeaning::User { active: true, .. }))
    }

    /// Enters or leaves the expansion of an author's macro.
    pub fn set_active(&mut self, name: Symbol, now: bool) {
        let index = self.by_symbol.get(name.index()).copied().unwrap_or(UNDEFINED);
        if let Some(MacroMeaning::User { active, .. }) =
            (index as usize).checked_sub(1).and_then(|index| self.meanings.get_mut(index))
        {
            *active = now;
        }
    }

    /// Whether `defined` holds for a name.
    pub fn is_defined(&self, name: Symbol) -> bool {
        self.get(name).is_some()
    }

    /// Every defined name.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        let symbols = (0..self.by_symbol.len()).map(|symbol| Symbol(symbol as u32));
        let defined = symbols.filter(|symbol| self.is_defined(*symbol));
        defined.map(|symbol| self.spellings.text(symbol))
    }
}
