//! Writes trees.

use std::collections::BTreeMap;

use serde_json::Value;

use super::{
    FALSE, HEADER_WORDS, KIND_BITS, LARGE, LIST, MOST, NATURAL, NEGATIVE, NULL, RECORD, SIMPLE,
    TEXT, TRUE,
};
use crate::Error;

/// Collects values, of which equal parts are kept once.
#[derive(Default)]
pub struct TreeBuilder {
    roots: Vec<u32>,
    texts: Vec<String>,
    text_numbers: BTreeMap<String, u32>,
    words: Vec<u32>,
    /// Where each list and record is, by its kind and words.
    known: BTreeMap<(u32, Vec<u32>), u32>,
}

impl TreeBuilder {
    /// Adds a value and returns its number.
    pub fn add(&mut self, value: &Value) -> Result<u32, Error> {
        let root = self.value(value)?;
        self.roots.push(root);
        bounded(self.roots.len() - 1)
    }

    fn value(&mut self, value: &Value) -> Result<u32, Error> {
        let (kind, rest) = match value {
            Value::Null => (SIMPLE, NULL),
            Value::Bool(false) => (SIMPLE, FALSE),
            Value::Bool(true) => (SIMPLE, TRUE),
            Value::Number(number) => self.number(number)?,
            Value::String(text) => (TEXT, self.text(text)?),
            Value::Array(items) => {
                let mut words = vec![bounded(items.len())?];
                for item in items {
                    words.push(self.value(item)?);
                }
                (LIST, self.node(LIST, words)?)
            }
            Value::Object(members) => {
                let mut words = vec![bounded(members.len())?];
                let sorted: BTreeMap<&String, &Value> = members.iter().collect();
                for (name, member) in sorted {
                    words.extend([self.text(name)?, self.value(member)?]);
                }
                (RECORD, self.node(RECORD, words)?)
            }
        };
        Ok(kind | rest << KIND_BITS)
    }

    fn number(&mut self, number: &serde_json::Number) -> Result<(u32, u32), Error> {
        let fits = |value: u64| u32::try_from(value).ok().filter(|value| *value < MOST);
        if let Some(value) = number.as_u64().and_then(fits) {
            return Ok((NATURAL, value));
        }
        let below = number.as_i64().filter(|value| *value < 0).map(|value| !value as u64);
        match below.and_then(fits) {
            Some(value) => Ok((NEGATIVE, value)),
            None => Ok((LARGE, self.text(&number.to_string())?)),
        }
    }

    fn text(&mut self, text: &str) -> Result<u32, Error> {
        if let Some(number) = self.text_numbers.get(text) {
            return Ok(*number);
        }
        let number = bounded(self.texts.len())?;
        self.texts.push(text.to_owned());
        self.text_numbers.insert(text.to_owned(), number);
        Ok(number)
    }

    fn node(&mut self, kind: u32, words: Vec<u32>) -> Result<u32, Error> {
        let next = bounded(self.words.len())?;
        let at = *self.known.entry((kind, words.clone())).or_insert(next);
        if at == next {
            self.words.extend(words);
        }
        Ok(at)
    }

    /// The bytes of all values.
    pub fn finish(&self) -> Result<Vec<u8>, Error> {
        let Self { roots, texts, text_numbers: _, words, known: _ } = self;
        let length = texts.iter().map(|text| text.len() + 1).sum::<usize>();
        let counts = [roots.len(), texts.len(), words.len(), length];
        let mut all = Vec::with_capacity(HEADER_WORDS + roots.len() + words.len());
        for count in counts {
            all.push(bounded(count)?);
        }
        all.extend(roots);
        let mut at = 0;
        for text in texts {
            all.extend([bounded(at)?, bounded(text.len())?]);
            at += text.len() + 1;
        }
        all.extend(words);
        let mut bytes: Vec<u8> = all.into_iter().flat_map(u32::to_le_bytes).collect();
        for text in texts {
            bytes.extend_from_slice(text.as_bytes());
            bytes.push(0);
        }
        Ok(bytes)
    }
}

/// A number that fits into a value.
fn bounded(value: usize) -> Result<u32, Error> {
    u32::try_from(value)
        .ok()
        .filter(|value| *value < MOST)
        .ok_or_else(|| Error::Io("a table of the bundle outgrows 29 bits".to_owned()))
}
