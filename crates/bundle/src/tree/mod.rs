//! Values in binary form: what JSON can say, without a parser. The single file holds its tables of
//! names, bindings and constants so.
//!
//! ```text
//! header    number of roots, of texts, of words, of bytes of text
//! roots     a value for each
//! texts     offset and length of each, from the start of the bytes
//! words     lists and records
//! bytes     the texts, UTF-8, each with a zero after it that its length does not count
//! ```
//! Each number is little-endian and has 32 bits. A value is one word: its lower three bits are its
//! kind, and the other bits are what the kind says.
//!
//! | kind | value | other bits |
//! |---|---|---|
//! | 0 | null, false, true | 0, 1, 2 |
//! | 1 | a natural number | the number |
//! | 2 | a negative number | -1 - number |
//! | 3 | a text | number of the text |
//! | 4 | a list | the word where it starts: its length, then its values |
//! | 5 | a record | the word where it starts: the number of its members; then for each the number of its name and its value, sorted by the bytes of the names |
//! | 6 | a whole number that needs more bits | number of the text with its digits |
//!
//! A list or a record is written after everything in it, so that there are no cycles.
//! Equal ones are written once.

mod read;
mod write;

pub use read::Tree;
pub use write::TreeBuilder;

/// Words before the roots.
const HEADER_WORDS: usize = 4;

/// Bits of a value that are its kind.
const KIND_BITS: u32 = 3;

/// The first number that does not fit into a value.
const MOST: u32 = 1 << (32 - KIND_BITS);

const SIMPLE: u32 = 0;
const NATURAL: u32 = 1;
const NEGATIVE: u32 = 2;
const TEXT: u32 = 3;
const LIST: u32 = 4;
const RECORD: u32 = 5;
const LARGE: u32 = 6;

const NULL: u32 = 0;
const FALSE: u32 = 1;
const TRUE: u32 = 2;

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;

    fn sample() -> Value {
        json!({
            "a": [1, -1, 536_870_911, 536_870_912_u64, -9_000_000_000_i64, true, false, null],
            "b": { "name": "größe", "inner": { "name": "größe" } },
            "c": [],
            "d": {},
        })
    }

    #[test]
    fn values_come_back() {
        let mut builder = TreeBuilder::default();
        let roots = [sample(), json!("text"), json!(7)];
        let numbers = roots.each_ref().map(|root| builder.add(root).unwrap());
        assert_eq!(numbers, [0, 1, 2]);
        let bytes = builder.finish().unwrap();
        for (number, root) in roots.iter().enumerate() {
            let tree = Tree::new(&bytes, "tree").unwrap();
            assert_eq!(&tree.get::<Value>(number as u32).unwrap(), root);
        }
    }

    #[test]
    fn equal_parts_are_written_once() {
        let part = json!({ "x": [1, 2, 3], "y": "text" });
        let mut once = TreeBuilder::default();
        once.add(&part).unwrap();
        let before = once.finish().unwrap().len();
        let mut often = TreeBuilder::default();
        often.add(&json!([part, part, part, part])).unwrap();
        // A list of four values and its length.
        assert_eq!(often.finish().unwrap().len(), before + 5 * 4);
    }

    /// Each changed word gives an error or a value, and no panic, in bounded time.
    #[test]
    fn damage_is_an_error_or_a_value() {
        let mut builder = TreeBuilder::default();
        builder.add(&sample()).unwrap();
        let bytes = builder.finish().unwrap();
        for at in 0..bytes.len() {
            for change in [1, 4, 0x80] {
                let mut damaged = bytes.clone();
                damaged[at] ^= change;
                if let Ok(tree) = Tree::new(&damaged, "tree") {
                    drop(tree.get::<Value>(0));
                }
            }
            assert!(Tree::new(&bytes[..at], "tree").is_err(), "{at} bytes");
        }
    }

    #[test]
    fn deep_nesting_is_refused() {
        let mut value = json!(0);
        for _ in 0..100 {
            value = json!([value]);
        }
        let mut builder = TreeBuilder::default();
        builder.add(&value).unwrap();
        let bytes = builder.finish().unwrap();
        let tree = Tree::new(&bytes, "tree").unwrap();
        assert!(tree.get::<Value>(0).unwrap_err().to_string().contains("too deeply"));
        assert!(tree.weights().unwrap_err().to_string().contains("too deeply"));
    }

    /// Lists of two references to the list before would have 2^60 parts.
    #[test]
    fn a_tree_that_grows_without_bound_is_refused() {
        let list = |at: u32| at << KIND_BITS | LIST;
        let mut words = vec![1, SIMPLE];
        for level in 0..22 {
            let before = list(if level == 0 { 0 } else { 3 * level - 1 });
            words.extend([2, before, before]);
        }
        let mut all = vec![1, 0, words.len() as u32, 0, list(words.len() as u32 - 3)];
        all.extend(words);
        let bytes: Vec<u8> = all.into_iter().flat_map(u32::to_le_bytes).collect();
        let tree = Tree::new(&bytes, "tree").unwrap();
        let error = tree.get::<Value>(0).unwrap_err();
        assert!(error.to_string().contains("too many values"), "{error}");
        assert_eq!(tree.weights().unwrap(), [(1 << 23) - 1 + (1 << 22)]);
    }
}
