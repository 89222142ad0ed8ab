//! Outputs as lists of pieces.
//!
//! The permutations of a program consist of the same few thousand declarations, in different
//! selections. So the single file stores each declaration once, as a *piece*, and an output as a list
//! of pieces. Declarations of SPIR-V name what they use by numbers that differ from module to module.
//! A piece of SPIR-V has *holes* in their place, and a list has the values for them.
//!
//! How an output is split only decides how small the file becomes. Joined again, the pieces are the
//! bytes of the output whatever the split, and a reader knows nothing of languages.

mod join;
mod spirv;
mod text;

use std::collections::HashMap;
use std::num::TryFromIntError;

use super::layout::MOST_GROUP_BYTES;
pub use join::{Found, hole_bytes, join};

/// A piece as the file stores it: its bytes, and if it has holes, a bit for each of its words that is
/// one. A hole holds the index of its value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct Stored {
    /// How many of the bytes are those of the piece itself.
    length: u32,
    /// How many values a list has for the holes.
    values: u32,
}

/// A piece and how often outputs have it.
struct Entry {
    bytes: Vec<u8>,
    stored: Stored,
    uses: u32,
    /// The first target that has it.
    target: u32,
}

/// A piece of a finished table.
pub struct Piece {
    /// What is in the group: the bytes of the piece, and behind them the bits of its holes.
    pub bytes: Vec<u8>,
    /// How many of them are the piece's own.
    pub length: u32,
    /// How many values a list has for its holes.
    pub values: u32,
}

/// The distinct pieces of many outputs.
#[derive(Default)]
pub struct PieceTable {
    /// The number of each, by its bytes as they are stored, followed by [`Stored`].
    numbers: HashMap<Vec<u8>, u32>,
    entries: Vec<Entry>,
}

/// An output as a list of numbers in a [`PieceTable`]. After the number of a piece come the values of
/// its holes.
pub type List = Vec<u32>;

impl PieceTable {
    /// Splits an output. `None` if it has no pieces, if a list would not be smaller, or if a piece
    /// would be too large for a group: then it is stored as it is. `target` is the index of its
    /// target.
    ///
    /// # Errors
    /// There are more than 2^32 pieces.
    pub fn split(&mut self, bytes: &[u8], target: u32) -> Result<Option<List>, TryFromIntError> {
        let (mut list, mut key, mut failed) = (List::new(), Vec::new(), Ok(()));
        let mut is_small = true;
        let mut take = |piece: &[u8], holes: &[u8], values: &[u32]| {
            key.clear();
            key.extend_from_slice(piece);
            key.extend_from_slice(holes);
            is_small &= key.len() <= MOST_GROUP_BYTES;
            match self.number(&mut key, piece.len(), values.len(), target) {
                Ok(number) => list.push(number),
                Err(error) => failed = Err(error),
            }
            list.extend_from_slice(values);
        };
        let is_split = match spirv::is_spirv(bytes) {
            true => spirv::split(bytes, &mut take),
            false => text::split(bytes, &mut take),
        };
        failed?;
        if is_split && is_small && list.len() * 4 < bytes.len() {
            return Ok(Some(list));
        }
        self.forget(&list);
        Ok(None)
    }

    /// Takes back what a list has counted.
    fn forget(&mut self, list: &[u32]) {
        let mut at = 0;
        while let Some(entry) = list.get(at).and_then(|word| self.entries.get_mut(*word as usize)) {
            entry.uses = entry.uses.saturating_sub(1);
            at += 1 + entry.stored.values as usize;
        }
    }

    fn number(
        &mut self,
        key: &mut Vec<u8>,
        length: usize,
        values: usize,
        target: u32,
    ) -> Result<u32, TryFromIntError> {
        let stored = Stored { length: length.try_into()?, values: values.try_into()? };
        let end = key.len();
        key.extend_from_slice(&stored.length.to_le_bytes());
        key.extend_from_slice(&stored.values.to_le_bytes());
        if let Some(number) = self.numbers.get(key.as_slice()) {
            let uses = &mut self.entries[*number as usize].uses;
            *uses = uses.saturating_add(1);
            return Ok(*number);
        }
        let number = self.entries.len().try_into()?;
        self.entries.push(Entry { bytes: key[..end].to_vec(), stored, uses: 1, target });
        self.numbers.insert(key.clone(), number);
        Ok(number)
    }

    /// The pieces in the order of the file, and the new number of each. Pieces of one target are
    /// neighbours, and those that most outputs have come first, so that a reader who needs one output
    /// needs few groups.
    pub fn finish(self) -> (Vec<Piece>, Renumbering) {
        let Self { numbers: _, entries } = self;
        let mut renumbering = Renumbering(vec![(0, 0); entries.len()]);
        let mut order: Vec<(usize, Entry)> = entries.into_iter().enumerate().collect();
        order.retain(|(_, entry)| entry.uses > 0);
        order.sort_by_key(|(index, entry)| (entry.target, std::cmp::Reverse(entry.uses), *index));
        let mut pieces = Vec::with_capacity(order.len());
        for (new, (old, Entry { bytes, stored, uses: _, target: _ })) in (0..).zip(order) {
            let Stored { length, values } = stored;
            renumbering.0[old] = (new, values);
            pieces.push(Piece { bytes, length, values });
        }
        (pieces, renumbering)
    }
}

/// The new number of each piece, with the number of its values.
pub struct Renumbering(Vec<(u32, u32)>);

impl Renumbering {
    /// Gives a list the new numbers, and writes each value as the difference from the one before,
    /// which compresses better: most follow each other.
    pub fn apply(&self, list: &mut List) {
        let (mut at, mut before) = (0, 0u32);
        while let Some(word) = list.get_mut(at) {
            let (new, values) = self.0[*word as usize];
            *word = new;
            at += 1;
            for value in list.iter_mut().skip(at).take(values as usize) {
                let difference = value.wrapping_sub(before);
                before = *value;
                *value = difference;
            }
            at += values as usize;
        }
    }
}

#[cfg(test)]
mod tests;
