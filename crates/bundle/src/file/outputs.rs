//! The outputs of a single file: whole, or in pieces.

use super::*;
use crate::pieces::{self, Found};

/// Where a blob is.
pub struct BlobRecord {
    pub group: u32,
    pub offset: usize,
    /// The bytes of the output.
    pub length: usize,
    /// How many words the list of its pieces has. None if the group has the output itself.
    pub words: usize,
    pub sum: Hash,
}

/// Where a piece is.
pub(super) struct PieceRecord {
    pub group: u32,
    pub offset: usize,
    pub length: usize,
    pub values: usize,
}

impl BlobRecord {
    /// How many bytes its group has of it.
    pub fn stored(&self) -> usize {
        if self.words == 0 { self.length } else { self.words * 4 }
    }
}

impl PieceRecord {
    /// How many bytes its group has of it.
    pub fn stored(&self) -> usize {
        let holes = if self.values == 0 { 0 } else { pieces::hole_bytes(self.length) };
        self.length + holes
    }
}

impl Packed {
    pub fn blob_record(&self, blob: u32) -> Result<BlobRecord, Error> {
        let table = self.section(BLOBS)?;
        let at = blob as usize * BLOB_BYTES;
        let word = |index: usize| Ok::<_, Error>(u32_at(table, at + 4 * index, "blobs")? as usize);
        let record = BlobRecord {
            group: u32_at(table, at, "blobs")?,
            offset: word(1)?,
            length: word(2)?,
            words: word(3)?,
            sum: hash_at(table, at + 16, "blobs")?,
        };
        let is_large = record.length > MOST_GROUP_BYTES || record.stored() > MOST_GROUP_BYTES;
        // The blobs of a directory are in files, and may be larger than its index allows.
        match blob >= self.meta.blobs || is_large && record.group != NONE {
            true => Err(Error::corrupt("blobs", "a blob is out of range")),
            false => Ok(record),
        }
    }

    pub(super) fn piece_record(&self, piece: u32) -> Result<PieceRecord, Error> {
        let table = self.section(BLOBS)?;
        let at = self.meta.blobs as usize * BLOB_BYTES + piece as usize * PIECE_BYTES;
        let word = |index: usize| Ok::<_, Error>(u32_at(table, at + 4 * index, "blobs")? as usize);
        let group = u32_at(table, at, "blobs")?;
        let record = PieceRecord { group, offset: word(1)?, length: word(2)?, values: word(3)? };
        // An empty piece would cost time and add nothing.
        let is_right = (1..=MOST_GROUP_BYTES).contains(&record.length);
        match piece < self.meta.pieces && is_right && record.values <= record.length / 4 {
            true => Ok(record),
            false => Err(Error::corrupt("blobs", "a piece is out of range")),
        }
    }

    /// The bytes of an output.
    pub(super) fn output(&self, blob: &BlobRecord) -> Result<Vec<u8>, Error> {
        let group = self.group(blob.group)?;
        let stored = slice_at(&group, blob.offset, blob.stored(), "blobs")?;
        if blob.words == 0 {
            return Ok(stored.to_vec());
        }
        pieces::join(stored, blob.length, &mut |number| {
            let piece = self.piece_record(number)?;
            let PieceRecord { group, offset, length, values } = piece;
            Ok(Found { group: self.group(group)?, offset, length, values })
        })
    }
}
