//! Typed access to TOML. Whatever is not as expected is reported at its exact place.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeArray, DeString, DeTable, DeValue};

use crate::Setting;
use crate::quoted::Quoted;
use lamplight_diagnostic::source::{SourceId, SourceSet, Span};
use lamplight_diagnostic::{Code, Diagnostic, codes};

pub type TomlValue<'t> = Spanned<DeValue<'t>>;
pub type TomlName<'t> = Spanned<DeString<'t>>;

/// How much of a manifest is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Depth {
    /// All of it.
    Whole,
    /// Without what decides which permutations there are: lists, lints and limits.
    Outline,
}

/// The manifest being read and what was found wrong with it.
pub struct ManifestReader<'s> {
    pub sources: &'s SourceSet,
    pub id: SourceId,
    pub depth: Depth,
    pub problems: Vec<Diagnostic>,
}

impl<'s> ManifestReader<'s> {
    pub fn new(sources: &'s SourceSet, id: SourceId) -> Self {
        Self { sources, id, depth: Depth::Whole, problems: Vec::new() }
    }

    /// A range of the manifest.
    pub fn span(&self, range: Range<usize>) -> Span {
        Span::new(self.id, range)
    }

    /// Reports the keys of a table that are not known.
    pub fn check_keys(&mut self, table: &DeTable, known: &[&str], what: &str) {
        for (key, _) in table.iter().filter(|(key, _)| !known.contains(&key.get_ref().as_ref())) {
            let name = key.get_ref();
            let unknown =
                Diagnostic::error(codes::UNKNOWN_KEY, format!("{what} has no key `{name}`"));
            let unknown = unknown
                .at(self.span(key.span()), "unknown key")
                .suggest(name, known.iter().copied());
            self.problems.push(unknown.note(format!("known keys: {}", known.join(", "))));
        }
    }

    /// The value of a key that must be there. If it is missing, the error is at `place`.
    pub fn required<'t, 'v>(
        &mut self,
        table: &'v DeTable<'t>,
        key: &str,
        what: &str,
        place: Span,
    ) -> Option<&'v TomlValue<'t>> {
        let found = table.get(key);
        if found.is_none() {
            self.problems.push(
                Diagnostic::error(codes::MISSING_KEY, format!("{what} lacks `{key}`"))
                    .at(place, format!("needs `{key}`")),
            );
        }
        found
    }

    pub fn table<'t, 'v>(
        &mut self,
        value: &'v TomlValue<'t>,
        what: &str,
    ) -> Option<&'v DeTable<'t>> {
        let found = value.get_ref().as_table();
        self.expect(found, value, what, "a table")
    }

    pub fn array<'t, 'v>(
        &mut self,
        value: &'v TomlValue<'t>,
        what: &str,
    ) -> Option<&'v DeArray<'t>> {
        let found = value.get_ref().as_array();
        self.expect(found, value, what, "an array")
    }

    pub fn string(&mut self, value: &TomlValue, what: &str) -> Option<Quoted> {
        let found = value
            .get_ref()
            .as_str()
            .map(|text| Quoted::toml(self.sources, self.span(value.span()), text));
        self.expect(found, value, what, "a string")
    }

    /// One of the known words. For another, `unknown` has the code, the beginning of the message,
    /// the label, and what the words are.
    pub fn choice<T: Copy>(
        &mut self,
        value: &TomlValue,
        what: &str,
        known: impl Iterator<Item = (&'static str, T)> + Clone,
        (code, [message, label, words]): (&'static Code, [&str; 3]),
    ) -> Option<T> {
        let text = self.string(value, what)?;
        let found = known.clone().find(|(name, _)| *name == text.text);
        if found.is_none() {
            let names = || known.clone().map(|(name, _)| name);
            let listed = format!("{words}: {}", names().collect::<Vec<_>>().join(", "));
            let error = Diagnostic::error(code, format!("{message} `{}`", text.text));
            let error = error.at(text.span, label).suggest(&text.text, names());
            self.problems.push(error.note(listed));
        }
        found.map(|(_, choice)| choice)
    }

    pub fn boolean(&mut self, value: &TomlValue, what: &str) -> Option<bool> {
        self.expect(value.get_ref().as_bool(), value, what, "a boolean")
    }

    pub fn integer(&mut self, value: &TomlValue, what: &str) -> Option<i64> {
        let found = integer_value(value.get_ref());
        self.expect(found, value, what, "an integer of 64 bits")
    }

    /// The table of an axis. A list alone, which other tools take, gets a help.
    pub fn axis_table<'t, 'v>(
        &mut self,
        value: &'v TomlValue<'t>,
        what: &str,
    ) -> Option<&'v DeTable<'t>> {
        let table = self.table(value, what);
        if value.get_ref().as_array().is_some()
            && let Some(problem) = self.problems.pop()
        {
            let text = &self.sources.get(self.id).text;
            let list = text.get(value.span()).unwrap_or("[...]");
            self.problems.push(problem.note(format!("help: write `{{ values = {list} }}`")));
        }
        table
    }

    /// A value of an axis.
    pub fn setting(&mut self, value: &TomlValue, what: &str) -> Option<Setting> {
        let found = match value.get_ref() {
            DeValue::Boolean(value) => Some(Setting::Bool(*value)),
            DeValue::String(value) => Some(Setting::Name(value.clone().into_owned())),
            other => integer_value(other).map(Setting::Int),
        };
        self.expect(found, value, what, "a boolean, an integer of 64 bits or a string")
    }

    /// Optional text under a key.
    pub fn doc(&mut self, table: &DeTable) -> Option<String> {
        let value = table.get("doc")?;
        Some(self.string(value, "`doc`")?.text)
    }

    fn expect<T>(
        &mut self,
        found: Option<T>,
        value: &TomlValue,
        what: &str,
        expected: &str,
    ) -> Option<T> {
        if found.is_none() {
            let kind = value.get_ref().type_str();
            let message = format!("{what} is {expected}, and this is of type {kind}");
            self.problems.push(
                Diagnostic::error(codes::WRONG_TYPE, message)
                    .at(self.span(value.span()), format!("expected {expected}")),
            );
        }
        found
    }
}

fn integer_value(value: &DeValue) -> Option<i64> {
    let integer = value.as_integer()?;
    i64::from_str_radix(integer.as_str(), integer.radix()).ok()
}
