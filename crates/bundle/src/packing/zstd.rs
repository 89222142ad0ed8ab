//! The compression of single-file bundles.

use std::io;

/// The compression level of zstd. Higher levels save a few percent and take several times as long.
const LEVEL: i32 = 9;

/// One frame that holds `raw`.
pub fn compress(raw: &[u8]) -> io::Result<Vec<u8>> {
    zstd::bulk::compress(raw, LEVEL)
}

/// The content of `packed`. Fails if it has more than `most` bytes.
pub fn decompress(packed: &[u8], most: usize) -> io::Result<Vec<u8>> {
    zstd::bulk::decompress(packed, most)
}
