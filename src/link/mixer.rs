//! A hash for maps that are looked up very often.

use std::hash::Hasher;

/// Hashes faster than the default, which guards against attacks that writers' words need not fear.
#[derive(Default)]
pub struct Mixer(u64);

impl Mixer {
    fn mix(&mut self, value: u64) {
        self.0 = (self.0.rotate_left(5) ^ value).wrapping_mul(0x517c_c1b7_2722_0a95);
    }
}

impl Hasher for Mixer {
    fn write(&mut self, bytes: &[u8]) {
        let (chunks, rest) = bytes.as_chunks();
        chunks.iter().for_each(|&chunk| self.mix(u64::from_le_bytes(chunk)));
        rest.iter().for_each(|&byte| self.mix(byte.into()));
    }

    fn write_u32(&mut self, value: u32) {
        self.mix(value.into());
    }

    fn write_usize(&mut self, value: usize) {
        self.mix(value as u64);
    }

    /// The map takes the low bits, and multiplication mixes the high ones best.
    fn finish(&self) -> u64 {
        self.0.rotate_left(26)
    }
}
