//! Writes tables as textures: KTX 2.0, 32-bit floats, one level.
//!
//! Khronos, "KTX File Format Specification 2.0", sections 3 and 4; "Khronos Data Format
//! Specification 1.3", section 5, for the descriptor.

use crate::{SIDE, Table};

const IDENTIFIER: [u8; 12] = *b"\xabKTX 20\xbb\r\n\x1a\n";

/// `VK_FORMAT_R32_SFLOAT` and its siblings of two and four channels, and what a channel is called
/// in a descriptor.
const FORMATS: [(usize, u32); 3] = [(1, 100), (2, 103), (4, 109)];
const CHANNELS: [u32; 4] = [0, 1, 2, 15];

/// The file's bytes; `None` where no format has so many channels.
pub fn file(table: &Table, values: &[f32]) -> Option<Vec<u8>> {
    let channels = table.channels.len();
    let (_, format) = FORMATS.into_iter().find(|(count, _)| *count == channels)?;
    let descriptor = descriptor(channels as u32);
    let pairs = pairs(table);
    let before = 80 + 24;
    let pairs_at = before + descriptor.len() as u32 * 4;
    let end = pairs_at as usize + pairs.len();
    let level_at = end.next_multiple_of(16);
    let length = values.len() as u64 * 4;
    let side = SIDE as u32;
    let mut bytes = IDENTIFIER.to_vec();
    // Format, bytes of a component, width, height, depth, layers, faces, levels, no compression.
    let head = [format, 4, side, side, 0, 0, 1, 1, 0];
    // Descriptor, pairs of names and values, and no global data of a compression.
    let index = [before, descriptor.len() as u32 * 4, pairs_at, pairs.len() as u32, 0, 0, 0, 0];
    for word in head.into_iter().chain(index) {
        bytes.extend(word.to_le_bytes());
    }
    for number in [level_at as u64, length, length] {
        bytes.extend(number.to_le_bytes());
    }
    bytes.extend(descriptor.iter().flat_map(|word| word.to_le_bytes()));
    bytes.extend(pairs);
    bytes.resize(level_at, 0);
    bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    Some(bytes)
}

/// The basic descriptor: linear values, and a texel of `channels` signed floats.
fn descriptor(channels: u32) -> Vec<u32> {
    let size = 24 + 16 * channels;
    // Colour model RGB, primaries of BT.709, linear, alpha straight.
    let mut words =
        vec![4 + size, 0, 2 | (size << 16), 1 | (1 << 8) | (1 << 16), 0, 4 * channels, 0];
    for (index, channel) in CHANNELS.into_iter().take(channels as usize).enumerate() {
        // 32 bits of a signed float, from -1 to 1.
        let kind = channel | 0xc0;
        let place = (32 * index as u32) | (31 << 16) | (kind << 24);
        words.extend([place, 0, (-1.0_f32).to_bits(), 1.0_f32.to_bits()]);
    }
    words
}

/// Pairs of names and values, sorted by name: the writer, and the orientation of the axes.
fn pairs(table: &Table) -> Vec<u8> {
    let mut bytes = Vec::new();
    let swizzle = if table.channels.len() == 1 { "r001" } else { "rg01" };
    let mut known = vec![("KTXorientation", "rd")];
    if table.channels.len() < 4 {
        known.push(("KTXswizzle", swizzle));
    }
    known.push(("KTXwriter", "lamplight tables"));
    for (name, value) in known {
        let pair: Vec<u8> = [name.as_bytes(), b"\0", value.as_bytes(), b"\0"].concat();
        bytes.extend((pair.len() as u32).to_le_bytes());
        bytes.extend(&pair);
        bytes.resize(bytes.len().next_multiple_of(4), 0);
    }
    bytes
}
