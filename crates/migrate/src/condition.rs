//! What `#ifdef` and `#if` ask for.

use std::collections::BTreeMap;

use super::Migrated;
use super::tree::{ByteRange, Scanned};
use lamplight_diagnostic::source::{SourceId, Span};
use lamplight_diagnostic::{Diagnostic, codes};

/// A test of a shader def: whether it is defined, or how its number compares.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct ShaderDefTest {
    pub question: DefQuestion,
    pub negated: bool,
}

#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct DefQuestion {
    pub name: String,
    /// Operator and number.
    pub compared: Option<(String, String)>,
}

impl ShaderDefTest {
    /// `#ifdef NAME`.
    pub fn defined(name: &str) -> Self {
        let question = DefQuestion { name: name.to_owned(), compared: None };
        Self { question, negated: false }
    }

    pub fn not(mut self) -> Self {
        self.negated = !self.negated;
        self
    }

    /// `#if NAME OPERATOR VALUE`; `None` if the operator or the value has no meaning there.
    pub fn compared(name: &str, operator: &str, value: &str) -> Option<Self> {
        let defined = Self::defined(name);
        match (operator, value) {
            ("==", "true") | ("!=", "false") => Some(defined),
            ("==", "false") | ("!=", "true") => Some(defined.not()),
            ("==" | "!=" | "<" | "<=" | ">" | ">=", _) if value.parse::<i64>().is_ok() => {
                let compared = Some((operator.to_owned(), value.to_owned()));
                let question = DefQuestion { name: name.to_owned(), compared };
                Some(Self { question, negated: false })
            }
            _ => None,
        }
    }

    /// Whether no shader def can have that name.
    pub fn is_never(&self) -> bool {
        self.question.name.starts_with(|first: char| first.is_ascii_digit())
    }

    pub fn text(&self) -> String {
        let name = &self.question.name;
        match &self.question.compared {
            _ if self.is_never() => self.negated.to_string(),
            None if self.negated => format!("!{name}"),
            None => name.clone(),
            Some((operator, value)) => {
                let operator = if self.negated { opposite_operator(operator) } else { operator };
                format!("{name} {operator} {value}")
            }
        }
    }
}

fn opposite_operator(operator: &str) -> &str {
    match operator {
        "==" => "!=",
        "!=" => "==",
        "<" => ">=",
        "<=" => ">",
        ">" => "<=",
        _ => "<",
    }
}

/// All conditions joined with `&&`, each once, as in `@if(...)`.
pub fn joined_conditions(conditions: &[ShaderDefTest]) -> String {
    let mut texts: Vec<String> = Vec::new();
    for text in conditions.iter().map(ShaderDefTest::text) {
        if !texts.contains(&text) {
            texts.push(text);
        }
    }
    texts.join(" && ")
}

/// What is known of shader defs at a place.
#[derive(Debug, Clone, Default)]
pub struct Facts(BTreeMap<DefQuestion, bool>);

impl Facts {
    pub fn holds(&self, condition: &ShaderDefTest) -> Option<bool> {
        self.0.get(&condition.question).map(|known| *known != condition.negated)
    }

    pub fn with(&self, conditions: &[ShaderDefTest]) -> Self {
        let mut facts = self.clone();
        for condition in conditions {
            facts.0.insert(condition.question.clone(), !condition.negated);
        }
        facts
    }
}

/// Shader defs of a file, each with its first place.
#[derive(Debug, Default)]
pub struct ShaderDefs {
    pub features: BTreeMap<String, Span>,
    pub numbers: BTreeMap<String, Span>,
    pub constants: BTreeMap<String, Span>,
}

impl ShaderDefs {
    pub fn note(&mut self, condition: &ShaderDefTest, source: SourceId, place: &ByteRange) {
        let found = match condition.question.compared {
            Some(_) => &mut self.numbers,
            None => &mut self.features,
        };
        let span = Span::new(source, place.clone());
        found.entry(condition.question.name.clone()).or_insert(span);
    }

    pub fn add_to(&self, migrated: &mut Migrated) {
        migrated.features.extend(self.features.keys().cloned());
        migrated.numbers.extend(self.numbers.keys().cloned());
        migrated.constants.extend(self.constants.keys().cloned());
    }
}

/// An error for each name that is both compared with a number and tested with `#ifdef`.
pub fn used_both_ways<'a>(files: impl Iterator<Item = &'a Scanned>) -> Vec<Diagnostic> {
    let (mut features, mut numbers) = (BTreeMap::new(), BTreeMap::new());
    for file in files {
        file.defs.features.iter().for_each(|(name, span)| {
            features.entry(name).or_insert(*span);
        });
        file.defs.numbers.iter().for_each(|(name, span)| {
            numbers.entry(name).or_insert(*span);
        });
    }
    let both = numbers.into_iter().filter_map(|(name, number)| {
        let feature = features.get(name)?;
        let message = format!("`{name}` is compared with a number, and tested with `#ifdef`");
        Some(
            Diagnostic::error(codes::NOT_MIGRATED, message)
                .at(number, "a number here")
                .at(*feature, "on or off here")
                .note("help: use two names"),
        )
    });
    both.collect()
}
