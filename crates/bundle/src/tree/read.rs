//! Reads trees.

use std::cell::Cell;
use std::collections::BTreeMap;
use std::fmt;

use serde::de::value::{MapDeserializer, SeqDeserializer};
use serde::de::{self, DeserializeOwned, Deserializer, IntoDeserializer, Visitor};
use serde::forward_to_deserialize_any;

use super::{
    FALSE, HEADER_WORDS, KIND_BITS, LARGE, LIST, NATURAL, NEGATIVE, NULL, RECORD, SIMPLE, TEXT,
    TRUE,
};
use crate::Error;
use crate::layout::{slice_at, u32_at};
use lamplight_files::limits::{BUNDLE_NESTING, BUNDLE_VALUES};

/// A tree in memory. Positions are checked where they are used.
#[derive(Clone, Copy)]
pub struct Tree<'a> {
    part: &'static str,
    roots: &'a [u8],
    texts: &'a [u8],
    words: &'a [u8],
    bytes: &'a [u8],
}

impl<'a> Tree<'a> {
    /// The tree that `bytes` are. `part` is shown in errors.
    pub fn new(bytes: &'a [u8], part: &'static str) -> Result<Self, Error> {
        let count = |index: usize| u32_at(bytes, index * 4, part).map(|count| count as usize);
        let width = |index, width| Ok::<_, Error>(count(index)?.saturating_mul(width));
        let lengths = [width(0, 4)?, width(1, 8)?, width(2, 4)?, count(3)?];
        let mut at = HEADER_WORDS * 4;
        let mut parts = [&bytes[..0]; 4];
        for (found, length) in parts.iter_mut().zip(lengths) {
            *found = slice_at(bytes, at, length, part)?;
            at += length;
        }
        if at != bytes.len() {
            return Err(Error::corrupt(part, "bytes follow the last text"));
        }
        let [roots, texts, words, bytes] = parts;
        Ok(Self { part, roots, texts, words, bytes })
    }

    /// For each root, how many values it has, with those that are referred to more than once counted
    /// each time. This takes no longer than the tree is large.
    pub fn weights(&self) -> Result<Vec<u64>, Error> {
        let mut known = BTreeMap::new();
        let left = Cell::new(0);
        let roots = self.roots.as_chunks::<4>().0.iter();
        let weight = |root: &[u8; 4]| {
            let node = self.node(u32::from_le_bytes(*root), &left);
            node.weight(&mut known).map_err(|Refusal(reason)| Error::corrupt(self.part, reason))
        };
        roots.map(weight).collect()
    }

    /// A value that is in no other.
    fn node<'t>(&'t self, value: u32, left: &'t Cell<u32>) -> Node<'t> {
        Node { tree: self, value, before: u32::MAX, depth: 0, left }
    }

    /// A root, as a value of Rust.
    pub fn get<T: DeserializeOwned>(&self, root: u32) -> Result<T, Error> {
        let value = u32_at(self.roots, root as usize * 4, self.part)?;
        let left = Cell::new(BUNDLE_VALUES);
        T::deserialize(self.node(value, &left))
            .map_err(|Refusal(reason)| Error::corrupt(self.part, reason))
    }

    fn text(&self, number: u32) -> Result<&'a str, Error> {
        let at = number as usize * 8;
        let start = u32_at(self.texts, at, self.part)? as usize;
        let length = u32_at(self.texts, at + 4, self.part)? as usize;
        let bytes = slice_at(self.bytes, start, length.saturating_add(1), self.part)?;
        let Some(bytes) = bytes.strip_suffix(&[0]) else {
            return Err(Error::corrupt(self.part, "no zero follows a text"));
        };
        std::str::from_utf8(bytes).map_err(|_| Error::corrupt(self.part, "a text is not UTF-8"))
    }
}

/// The word of null.
const NULL_VALUE: u32 = NULL << KIND_BITS | SIMPLE;

/// Why a value is not what was expected.
#[derive(Debug)]
struct Refusal(String);

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Refusal {}

impl de::Error for Refusal {
    fn custom<T: fmt::Display>(message: T) -> Self {
        Self(message.to_string())
    }
}

impl From<Error> for Refusal {
    fn from(error: Error) -> Self {
        match error {
            Error::Corrupt { part: _, reason } => Self(reason),
            error => Self(error.to_string()),
        }
    }
}

/// One value of a tree.
#[derive(Clone, Copy)]
struct Node<'t> {
    tree: &'t Tree<'t>,
    value: u32,
    /// Where the list or record is that this value is in: its own parts are before that.
    before: u32,
    /// How many lists and records it is in.
    depth: u32,
    /// How many values may still be read.
    left: &'t Cell<u32>,
}

impl<'t> Node<'t> {
    /// The words of a list or a record, and where it starts.
    fn words(&self, width: usize) -> Result<(&'t [u8], u32), Refusal> {
        let at = self.value >> KIND_BITS;
        if at >= self.before {
            return Err(Refusal("a value is not before what it is in".to_owned()));
        }
        if self.depth >= BUNDLE_NESTING {
            return Err(Refusal("values are nested too deeply".to_owned()));
        }
        let start = (at as usize).saturating_mul(4);
        let count = u32_at(self.tree.words, start, self.tree.part)? as usize;
        Ok((slice_at(self.tree.words, start + 4, count.saturating_mul(width), self.tree.part)?, at))
    }

    fn child(&self, value: u32, before: u32) -> Self {
        Self { value, before, depth: self.depth + 1, ..*self }
    }

    /// How many values it has, itself included.
    fn weight(&self, known: &mut BTreeMap<u32, u64>) -> Result<u64, Refusal> {
        let (width, first) = match self.value & ((1 << KIND_BITS) - 1) {
            LIST => (4, 0),
            RECORD => (8, 4),
            _ => return Ok(1),
        };
        if let Some(weight) = known.get(&self.value) {
            return Ok(*weight);
        }
        let (words, at) = self.words(width)?;
        let mut weight = 1_u64;
        for item in words.chunks_exact(width) {
            let value = u32_at(item, first, self.tree.part)?;
            weight = weight.saturating_add(self.child(value, at).weight(known)?);
        }
        known.insert(self.value, weight);
        Ok(weight)
    }
}

impl<'de> IntoDeserializer<'de, Refusal> for Node<'_> {
    type Deserializer = Self;

    fn into_deserializer(self) -> Self {
        self
    }
}

impl<'de> Deserializer<'de> for Node<'_> {
    type Error = Refusal;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Refusal> {
        let left = self.left.get().checked_sub(1);
        self.left.set(left.ok_or_else(|| Refusal("there are too many values".to_owned()))?);
        let rest = self.value >> KIND_BITS;
        match (self.value & ((1 << KIND_BITS) - 1), rest) {
            (SIMPLE, NULL) => visitor.visit_unit(),
            (SIMPLE, FALSE) => visitor.visit_bool(false),
            (SIMPLE, TRUE) => visitor.visit_bool(true),
            (NATURAL, _) => visitor.visit_u64(rest.into()),
            (NEGATIVE, _) => visitor.visit_i64(!i64::from(rest)),
            (TEXT, _) => visitor.visit_str(self.tree.text(rest)?),
            (LIST, _) => {
                let (words, at) = self.words(4)?;
                let items = words.as_chunks::<4>().0.iter();
                let items = items.map(|word| self.child(u32::from_le_bytes(*word), at));
                visitor.visit_seq(SeqDeserializer::new(items))
            }
            (RECORD, _) => {
                let (words, at) = self.words(8)?;
                let pairs = words.as_chunks::<4>().0.as_chunks::<2>().0.iter();
                let pairs = pairs.map(|[name, value]| {
                    let name = u32::from_le_bytes(*name) << KIND_BITS | TEXT;
                    (self.child(name, at), self.child(u32::from_le_bytes(*value), at))
                });
                visitor.visit_map(MapDeserializer::new(pairs))
            }
            (LARGE, _) => large_number(self.tree.text(rest)?, visitor),
            _ => Err(Refusal("a value has an unknown kind".to_owned())),
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Refusal> {
        match self.value {
            NULL_VALUE => visitor.visit_none(),
            _ => visitor.visit_some(self),
        }
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _name: &'static str,
        _variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Refusal> {
        match self.value & ((1 << KIND_BITS) - 1) {
            TEXT => {
                let text = self.tree.text(self.value >> KIND_BITS)?;
                visitor.visit_enum(text.into_deserializer())
            }
            _ => Err(Refusal("a value is not one of the words that it may be".to_owned())),
        }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        visitor: V,
    ) -> Result<V::Value, Refusal> {
        visitor.visit_newtype_struct(self)
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit
        unit_struct seq tuple tuple_struct map struct identifier ignored_any
    }
}

fn large_number<'de, V: Visitor<'de>>(text: &str, visitor: V) -> Result<V::Value, Refusal> {
    match (text.parse::<u64>(), text.parse::<i64>()) {
        (Ok(value), _) => visitor.visit_u64(value),
        (_, Ok(value)) => visitor.visit_i64(value),
        _ => Err(Refusal(format!("`{text}` is not a number"))),
    }
}
