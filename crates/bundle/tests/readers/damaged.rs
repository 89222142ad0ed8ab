//! Damaged copies of a bundle: cut off, with a flipped bit, of another version, of somebody else;
//! and some whose checksums are right, but which say what cannot be.

use libtest_mimic::Failed;

/// Bytes of the header, and where the description of a section starts.
const HEADER: usize = 24 + 6 * 32 + 16;
const SECTIONS: [&str; 6] = ["meta", "keys", "units", "values", "blobs", "data"];

/// Names and bytes.
pub fn copies(good: &[u8]) -> Result<Vec<(String, Vec<u8>)>, Failed> {
    let mut copies = Vec::new();
    for length in [0, 7, 11, 100, HEADER] {
        copies.push((format!("truncated_{length}"), good[..length].to_vec()));
    }
    copies.push(("truncated_half".to_owned(), good[..good.len() / 2].to_vec()));
    copies.push(("truncated_end".to_owned(), good[..good.len() - 1].to_vec()));
    copies.push(("flipped_header".to_owned(), flipped(good, 20)));
    for (index, name) in SECTIONS.iter().enumerate() {
        let (offset, length) = section(good, index)?;
        copies.push((format!("flipped_{name}"), flipped(good, offset + length / 2)));
    }
    for (name, version) in [("older", 2), ("newer", 4)] {
        let mut other = good.to_vec();
        other[8] = version;
        copies.push((name.to_owned(), other));
    }
    copies.push(("foreign".to_owned(), b"\x89PNG\r\n\x1a\n and more of a picture".to_vec()));
    copies.push(("longer".to_owned(), [good, b"more"].concat()));
    copies.push(("crafted_cycle".to_owned(), with_cycle(good)?));
    copies.push(("crafted_unit".to_owned(), with_units(good)?));
    copies.push(("crafted_group".to_owned(), with_groups(good)?));
    let pieces = [
        ("group", 0, u32::MAX),
        ("offset", 1, 0xffff_fff0),
        ("empty", 2, 0),
        ("length", 2, 0xffff_fff0),
        ("values", 3, 0xffff_fff0),
        ("holes", 3, 1),
    ];
    for (name, index, value) in pieces {
        copies.push((format!("crafted_piece_{name}"), with_pieces(good, index, value)?));
    }
    Ok(copies)
}

fn flipped(good: &[u8], at: usize) -> Vec<u8> {
    let mut bytes = good.to_vec();
    bytes[at] ^= 0x10;
    bytes
}

fn word(bytes: &[u8], at: usize) -> Result<usize, Failed> {
    let found = bytes.get(at..).and_then(|rest| rest.first_chunk()).ok_or("out of range")?;
    Ok(u32::from_le_bytes(*found) as usize)
}

/// Where a section is, and how long.
fn section(bytes: &[u8], index: usize) -> Result<(usize, usize), Failed> {
    Ok((word(bytes, 24 + index * 32)?, word(bytes, 24 + index * 32 + 8)?))
}

/// Writes the checksums of all sections but the last, and of the header.
fn sealed(mut bytes: Vec<u8>) -> Result<Vec<u8>, Failed> {
    let sum = |bytes: &[u8]| blake3::hash(bytes).as_bytes()[..16].to_vec();
    for index in 0..SECTIONS.len() - 1 {
        let (offset, length) = section(&bytes, index)?;
        let found = sum(&bytes[offset..offset + length]);
        bytes[24 + index * 32 + 16..][..16].copy_from_slice(&found);
    }
    let found = sum(&bytes[..HEADER - 16]);
    bytes[HEADER - 16..HEADER].copy_from_slice(&found);
    Ok(bytes)
}

/// Each root of META and VALUES is a list that is in itself.
fn with_cycle(good: &[u8]) -> Result<Vec<u8>, Failed> {
    let mut bytes = good.to_vec();
    for index in [0, 3] {
        let (offset, _) = section(good, index)?;
        let (roots, texts) = (word(good, offset)?, word(good, offset + 4)?);
        let words = offset + 16 + roots * 4 + texts * 8;
        for root in 0..roots {
            bytes[offset + 16 + root * 4..][..4].copy_from_slice(&4_u32.to_le_bytes());
        }
        bytes[words..words + 4].copy_from_slice(&1_u32.to_le_bytes());
        bytes[words + 4..words + 8].copy_from_slice(&4_u32.to_le_bytes());
    }
    sealed(bytes)
}

/// Each word of UNITS is the largest number.
fn with_units(good: &[u8]) -> Result<Vec<u8>, Failed> {
    let mut bytes = good.to_vec();
    let (offset, length) = section(good, 2)?;
    bytes[offset..offset + length].fill(0xff);
    sealed(bytes)
}

/// Each blob says that it starts near the end of its group.
fn with_groups(good: &[u8]) -> Result<Vec<u8>, Failed> {
    let mut bytes = good.to_vec();
    let (offset, _) = section(good, 4)?;
    for blob in 0..count(good, "blobs")? {
        bytes[offset + blob * 32 + 4..][..4].copy_from_slice(&0xffff_fff0_u32.to_le_bytes());
    }
    sealed(bytes)
}

/// One word of each piece is another number.
fn with_pieces(good: &[u8], index: usize, value: u32) -> Result<Vec<u8>, Failed> {
    let mut bytes = good.to_vec();
    let (offset, _) = section(good, 4)?;
    let pieces = offset + count(good, "blobs")? * 32;
    for piece in 0..count(good, "pieces")? {
        bytes[pieces + piece * 16 + index * 4..][..4].copy_from_slice(&value.to_le_bytes());
    }
    sealed(bytes)
}

/// A number in the record that META is.
fn count(bytes: &[u8], name: &str) -> Result<usize, Failed> {
    let (at, _) = section(bytes, 0)?;
    let (roots, texts, words) = (word(bytes, at)?, word(bytes, at + 4)?, word(bytes, at + 8)?);
    let texts_at = at + 16 + roots * 4;
    let words_at = texts_at + texts * 8;
    let record = words_at + (word(bytes, at + 16)? >> 3) * 4;
    for member in 0..word(bytes, record)? {
        let text = texts_at + word(bytes, record + 4 + member * 8)? * 8;
        let (start, length) = (word(bytes, text)?, word(bytes, text + 4)?);
        if bytes[words_at + words * 4 + start..][..length] == *name.as_bytes() {
            return Ok(word(bytes, record + 8 + member * 8)? >> 3);
        }
    }
    Err(format!("META has no `{name}`").into())
}
