//! Corrects the checksums of an input after a mutation. Otherwise the checksums would refuse the
//! input, and the code behind them would never see it.

const HEADER: usize = 24 + 6 * 32 + 16;

/// A single-file bundle with correct checksums of its header, sections and groups. A checksum stays
/// as it is if the range that it belongs to lies outside of the file.
pub fn bundle(bytes: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    if bytes.len() < HEADER {
        return bytes;
    }
    let length = bytes.len() as u64;
    bytes[16..24].copy_from_slice(&length.to_le_bytes());
    groups(&mut bytes);
    for section in 0..6 {
        let at = 24 + section * 32;
        let sum = match range(&bytes, at) {
            // The data has no checksum of its own.
            Some(_) if section == 5 => [0; 16],
            Some(range) => sum(&bytes[range]),
            None => continue,
        };
        bytes[at + 16..at + 32].copy_from_slice(&sum);
    }
    let header = sum(&bytes[..HEADER - 16]);
    bytes[HEADER - 16..HEADER].copy_from_slice(&header);
    bytes
}

/// Corrects the checksum of each group, which is in the last 16 of the 32 bytes of the group's
/// record. The records are at the end of the fifth section. The text of the first section says how
/// many groups there are.
fn groups(bytes: &mut [u8]) {
    let (Some(meta), Some(table), Some(data)) =
        (range(bytes, 24), range(bytes, 24 + 4 * 32), range(bytes, 24 + 5 * 32))
    else {
        return;
    };
    let text = String::from_utf8_lossy(&bytes[meta]).into_owned();
    let count = text.rsplit_once("\"groups\":").and_then(|(_, rest)| {
        rest.split(|c: char| !c.is_ascii_digit()).next()?.parse::<usize>().ok()
    });
    let records = count.unwrap_or(0).saturating_mul(32);
    let Some(first) = table.len().checked_sub(records).map(|before| table.start + before) else {
        return;
    };
    for at in (first..table.end).step_by(32) {
        let (Some(offset), Some(length)) = (number(bytes, at, 8), number(bytes, at + 8, 4)) else {
            return;
        };
        let packed = data.start.checked_add(offset).and_then(|start| {
            let end = start.checked_add(length)?;
            bytes.get(start..end)
        });
        let Some(sum) = packed.map(sum) else { continue };
        if let Some(place) = bytes.get_mut(at + 16..at + 32) {
            place.copy_from_slice(&sum);
        }
    }
}

/// The range of the section whose record is at `at`.
fn range(bytes: &[u8], at: usize) -> Option<std::ops::Range<usize>> {
    let (start, length) = (number(bytes, at, 8)?, number(bytes, at + 8, 8)?);
    let end = start.checked_add(length)?;
    (end <= bytes.len()).then_some(start..end)
}

/// The little-endian number of `length` bytes at `at`.
fn number(bytes: &[u8], at: usize, length: usize) -> Option<usize> {
    let bytes = bytes.get(at..at.checked_add(length)?)?;
    let value = bytes.iter().rev().fold(0u64, |value, byte| value << 8 | u64::from(*byte));
    usize::try_from(value).ok()
}

/// A record of the cache with the checksum that belongs to its name and its contents.
pub fn record(name: &str, packed: &[u8]) -> Vec<u8> {
    let mut hasher = blake3::Hasher::new();
    hasher.update(&(name.len() as u64).to_le_bytes());
    hasher.update(name.as_bytes());
    hasher.update(packed);
    [b"LLC4".as_slice(), &hasher.finalize().as_bytes()[..16], packed].concat()
}

fn sum(bytes: &[u8]) -> [u8; 16] {
    let mut sum = [0; 16];
    sum.copy_from_slice(&blake3::hash(bytes).as_bytes()[..16]);
    sum
}
