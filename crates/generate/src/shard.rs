//! A part of the permutations, for one of several machines.

use std::str::FromStr;

/// The `index`th of `count` parts, from 1. A part is a run of neighbouring permutations, since
/// those share the most texts and functions. Of `n` permutations it begins at `n * (index - 1) /
/// count`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    index: usize,
    count: usize,
}

impl Shard {
    /// `None` unless `1 <= index <= count`.
    pub fn new(index: usize, count: usize) -> Option<Self> {
        (1..=count).contains(&index).then_some(Self { index, count })
    }

    /// Its number, from 1, and the number of all parts.
    pub fn numbers(self) -> (usize, usize) {
        (self.index, self.count)
    }

    /// The part of all `items`. Every item is in exactly one part.
    pub fn of<T>(self, items: &[T]) -> &[T] {
        let bound =
            |index: usize| (items.len() as u128 * index as u128 / self.count as u128) as usize;
        &items[bound(self.index - 1)..bound(self.index)]
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text
            .split_once('/')
            .and_then(|(index, count)| Some((index.parse().ok()?, count.parse().ok()?)));
        parts
            .and_then(|(index, count)| Self::new(index, count))
            .ok_or_else(|| "write `k/n` with 1 <= k <= n, as in `2/8`".to_owned())
    }
}
