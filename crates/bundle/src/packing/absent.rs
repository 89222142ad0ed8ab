//! Replaces the compression of single-file bundles in a build without the feature `single-file`.
//! Such a build supports only directories.

use std::io;

pub fn compress(_raw: &[u8]) -> io::Result<Vec<u8>> {
    Err(absent())
}

pub fn decompress(_packed: &[u8], _most: usize) -> io::Result<Vec<u8>> {
    Err(absent())
}

fn absent() -> io::Error {
    io::Error::new(
        io::ErrorKind::Unsupported,
        "this build has no single-file bundles: enable the feature `single-file` of lamplight",
    )
}
