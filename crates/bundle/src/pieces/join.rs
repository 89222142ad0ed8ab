//! Joins the pieces of an output.

use std::sync::Arc;

use crate::Error;

const PART: &str = "pieces";

/// A piece of a file.
pub struct Found {
    /// The group that has it, decompressed.
    pub group: Arc<[u8]>,
    /// Where it starts there.
    pub offset: usize,
    /// Its bytes, without the bits of its holes.
    pub length: usize,
    /// How many values its holes have.
    pub values: usize,
}

/// The output of `length` bytes that a list describes. `find` returns the piece of a number.
///
/// # Errors
/// [`Error::Corrupt`] if the list is damaged, and what `find` returns.
pub fn join(
    list: &[u8],
    length: usize,
    find: &mut dyn FnMut(u32) -> Result<Found, Error>,
) -> Result<Vec<u8>, Error> {
    let damaged = |reason: &str| Error::corrupt(PART, reason);
    let mut words = list.as_chunks::<4>().0.iter().copied().map(u32::from_le_bytes);
    let mut output = Vec::with_capacity(length);
    let (mut values, mut before) = (Vec::new(), 0u32);
    while let Some(number) = words.next() {
        let piece = find(number)?;
        values.clear();
        for difference in words.by_ref().take(piece.values) {
            before = before.wrapping_add(difference);
            values.push(before);
        }
        if values.len() != piece.values {
            return Err(damaged("a list ends before its values"));
        }
        if piece.length > length - output.len() {
            return Err(damaged("an output has other bytes than it should"));
        }
        append(&mut output, &piece, &values).ok_or_else(|| damaged("a piece is out of range"))?;
    }
    match output.len() == length {
        true => Ok(output),
        false => Err(damaged("an output has other bytes than it should")),
    }
}

/// Appends a piece with its holes filled. `None` if a position is out of range.
fn append(output: &mut Vec<u8>, piece: &Found, values: &[u32]) -> Option<()> {
    let Found { group, offset, length, values: _ } = piece;
    let end = offset.checked_add(*length)?;
    let bytes = group.get(*offset..end)?;
    if values.is_empty() {
        output.extend_from_slice(bytes);
        return Some(());
    }
    let words = bytes.as_chunks::<4>().0;
    let holes = group.get(end..end.checked_add(hole_bytes(*length))?)?;
    for (index, word) in words.iter().enumerate() {
        let word = match holes.get(index / 8)? >> (index % 8) & 1 {
            0 => *word,
            _ => values.get(u32::from_le_bytes(*word) as usize)?.to_le_bytes(),
        };
        output.extend_from_slice(&word);
    }
    length.is_multiple_of(4).then_some(())
}

/// How many bytes the bits of the holes take in a piece that has some.
pub fn hole_bytes(length: usize) -> usize {
    (length / 4).div_ceil(8)
}
