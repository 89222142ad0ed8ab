//! The kinds of lists, and the state of a unit of a list while it is read.

use super::unit::UnitPart;
use lamplight_syntax::words::begins_word;

/// The kind of the units in a list.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UnitKind {
    Declarations,
    Statements,
    Cases,
    Members,
    Parameters,
}

impl UnitKind {
    /// Whether commas separate its units.
    pub fn has_commas(self) -> bool {
        matches!(self, Self::Members | Self::Parameters)
    }

    /// Whether a condition may stand before braces around several of its units.
    pub fn has_blocks(self) -> bool {
        matches!(self, Self::Declarations | Self::Statements)
    }
}

/// A unit that is being read.
pub struct OpenUnit<'a> {
    level: UnitKind,
    pub parts: Vec<UnitPart<'a>>,
    /// Its first word that is not of an attribute.
    pub first: String,
    before: String,
    /// How many `<` are open.
    pub angles: usize,
    has_parameters: bool,
}

impl OpenUnit<'_> {
    pub fn new(level: UnitKind) -> Self {
        let (first, before) = (String::new(), String::new());
        Self { level, parts: Vec::new(), first, before, angles: 0, has_parameters: false }
    }

    pub fn note(&mut self, text: &str) {
        match text {
            "<" => self.angles += 1,
            ">" => self.angles = self.angles.saturating_sub(1),
            _ => {}
        }
        let is_word = text.starts_with(begins_word);
        if self.first.is_empty() && is_word && self.before != "@" {
            text.clone_into(&mut self.first);
        }
        text.clone_into(&mut self.before);
    }

    /// Whether the parenthesis is that of a function's parameters.
    pub fn parameters_follow(&mut self) -> bool {
        let found =
            self.level == UnitKind::Declarations && self.first == "fn" && !self.has_parameters;
        self.has_parameters |= found;
        found
    }

    /// The kind of the units in braces at this place; `None` if braces cannot be here.
    pub fn inner(&self) -> Option<UnitKind> {
        match self.level {
            UnitKind::Declarations if self.first == "struct" => Some(UnitKind::Members),
            UnitKind::Declarations => Some(UnitKind::Statements),
            UnitKind::Statements if self.first == "switch" => Some(UnitKind::Cases),
            UnitKind::Statements | UnitKind::Cases => Some(UnitKind::Statements),
            UnitKind::Members | UnitKind::Parameters => None,
        }
    }
}
