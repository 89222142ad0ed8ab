//! Reads TOML with spans, by hand, so that every mistake is reported at its place.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use lamplight_diagnostic::source::{SourceId, Span};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};

/// A value of a case file, and its place.
#[derive(Debug, Clone)]
pub struct CaseNode {
    pub value: CaseValue,
    pub span: Span,
}

#[derive(Debug, Clone)]
pub enum CaseValue {
    Bool(bool),
    Number(f64),
    Text(String),
    Array(Vec<CaseNode>),
    Table(Vec<(CaseKey, CaseNode)>),
}

/// A key, and its place.
#[derive(Debug, Clone)]
pub struct CaseKey {
    pub name: String,
    pub span: Span,
}

/// The whole file as a table.
pub fn read_toml(text: &str, source: SourceId) -> Result<CaseNode, Diagnostic> {
    let table = DeTable::parse(text).map_err(|error| {
        let span = Span::new(source, error.span().unwrap_or(0..0));
        Diagnostic::error(codes::CASE_SYNTAX, error.message().to_owned()).at(span, "here")
    })?;
    let span = Span::new(source, table.span());
    Ok(CaseNode { value: self::table_of(table.get_ref(), source), span })
}

fn node_of(value: &Spanned<DeValue<'_>>, source: SourceId) -> CaseNode {
    let span = Span::new(source, value.span());
    let value = match value.get_ref() {
        DeValue::Boolean(value) => CaseValue::Bool(*value),
        DeValue::Integer(value) => i64::from_str_radix(value.as_str(), value.radix())
            .map_or(CaseValue::Number(f64::NAN), |n| CaseValue::Number(n as f64)),
        DeValue::Float(value) => CaseValue::Number(value.as_str().parse().unwrap_or(f64::NAN)),
        DeValue::String(value) => CaseValue::Text(value.to_string()),
        DeValue::Datetime(value) => CaseValue::Text(value.to_string()),
        DeValue::Array(values) => {
            CaseValue::Array(values.iter().map(|value| node_of(value, source)).collect())
        }
        DeValue::Table(values) => table_of(values, source),
    };
    CaseNode { value, span }
}

fn table_of(table: &DeTable<'_>, source: SourceId) -> CaseValue {
    let key = |key: &Spanned<std::borrow::Cow<'_, str>>| CaseKey {
        name: key.get_ref().to_string(),
        span: Span::new(source, key.span()),
    };
    let mut entries: Vec<_> =
        table.iter().map(|(name, value)| (key(name), node_of(value, source))).collect();
    entries.sort_by_key(|(key, _)| key.span.start);
    CaseValue::Table(entries)
}

impl CaseNode {
    /// An error at this place.
    pub fn error(&self, message: impl Into<String>) -> Diagnostic {
        Diagnostic::error(codes::CASE_INVALID, message).at(self.span, "here")
    }

    pub fn entries(&self) -> Result<&[(CaseKey, CaseNode)], Diagnostic> {
        match &self.value {
            CaseValue::Table(entries) => Ok(entries),
            _ => Err(self.error("expected a table")),
        }
    }

    pub fn elements(&self) -> Result<&[CaseNode], Diagnostic> {
        match &self.value {
            CaseValue::Array(elements) => Ok(elements),
            _ => Err(self.error("expected an array")),
        }
    }

    /// An array's elements, or the value itself as the only one.
    pub fn one_or_more(&self) -> &[CaseNode] {
        match &self.value {
            CaseValue::Array(elements) => elements,
            _ => std::slice::from_ref(self),
        }
    }

    pub fn text(&self) -> Result<&str, Diagnostic> {
        match &self.value {
            CaseValue::Text(text) => Ok(text),
            _ => Err(self.error("expected a string")),
        }
    }

    /// A number; true and false are 1 and 0.
    pub fn number(&self) -> Result<f64, Diagnostic> {
        match self.value {
            CaseValue::Number(number) if !number.is_nan() => Ok(number),
            CaseValue::Bool(value) => Ok(f64::from(u8::from(value))),
            _ => Err(self.error("expected a number")),
        }
    }

    /// A whole number from `least` to `most`.
    pub fn count(&self, least: u32, most: u32) -> Result<u32, Diagnostic> {
        let number = self.number()?;
        if number.fract() != 0.0 || number < f64::from(least) || number > f64::from(most) {
            return Err(self.error(format!("expected a whole number from {least} to {most}")));
        }
        Ok(number as u32)
    }

    /// All numbers of an array, with those of arrays within it; or a single number.
    pub fn numbers(&self) -> Result<Vec<f64>, Diagnostic> {
        match &self.value {
            CaseValue::Array(elements) => elements
                .iter()
                .map(Self::numbers)
                .collect::<Result<Vec<_>, _>>()
                .map(|parts| parts.concat()),
            _ => self.number().map(|number| vec![number]),
        }
    }

    /// Two numbers.
    pub fn pair(&self) -> Result<(f64, f64), Diagnostic> {
        match self.numbers()?[..] {
            [low, high] => Ok((low, high)),
            _ => Err(self.error("expected two numbers, `[low, high]`")),
        }
    }

    /// One of several known names.
    pub fn choice<T: Copy>(&self, known: &[(&str, T)]) -> Result<T, Diagnostic> {
        let text = self.text()?;
        known.iter().find(|(name, _)| *name == text).map(|(_, value)| *value).ok_or_else(|| {
            let names: Vec<_> = known.iter().map(|(name, _)| format!("`{name}`")).collect();
            let error = self.error(format!("expected one of {}, found `{text}`", names.join(", ")));
            error.suggest(text, known.iter().map(|(name, _)| *name))
        })
    }

    /// The value of a key, which must be there.
    pub fn required(&self, name: &str) -> Result<&Self, Diagnostic> {
        self.get(name).ok_or_else(|| self.error(format!("`{name}` is missing")))
    }

    /// The value of a key.
    pub fn get(&self, name: &str) -> Option<&Self> {
        match &self.value {
            CaseValue::Table(entries) => {
                entries.iter().find(|(key, _)| key.name == name).map(|(_, node)| node)
            }
            _ => None,
        }
    }

    /// Errors for all keys that are not known.
    pub fn only(&self, known: &[&str]) -> Result<(), Diagnostics> {
        let entries = self.entries().map_err(|error| vec![error])?;
        let errors: Vec<_> = entries
            .iter()
            .filter(|(key, _)| !known.contains(&key.name.as_str()))
            .map(|(key, _)| {
                let error =
                    Diagnostic::error(codes::CASE_INVALID, format!("unknown key `{}`", key.name))
                        .at(key.span, "not known here");
                error
                    .note(format!("known are {}", known.join(", ")))
                    .suggest(&key.name, known.iter().copied())
            })
            .collect();
        if errors.is_empty() { Ok(()) } else { Err(errors) }
    }
}
