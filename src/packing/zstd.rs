//! The compression of single-file bundles.

use std::io;

/// zstd's: higher ones gain a few percent and cost several times as long.
const LEVEL: i32 = 9;

/// One frame that holds `raw`.
pub fn compress(raw: &[u8]) -> io::Result<Vec<u8>> {
    zstd::bulk::compress(raw, LEVEL)
}

/// What `packed` holds, at most `most` bytes of it.
pub fn decompress(packed: &[u8], most: usize) -> io::Result<Vec<u8>> {
    zstd::bulk::decompress(packed, most)
}
