//! The decoders in C and JavaScript against libzstd, which compresses what needs each part of the
//! format: raw and repeated blocks, literals of each kind, tables that are kept, and far offsets.

use std::path::{Path, PathBuf};
use std::process::Command;

use libtest_mimic::{Failed, Trial};
use zstd::bulk::Compressor;
use zstd::zstd_safe::CParameter;

use super::{Outcome, c};

/// Levels that compress in different ways; bundles have 9.
const LEVELS: [i32; 3] = [-5, 9, 19];

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("readers::frames::c", in_c),
        Trial::test("readers::frames::javascript", in_javascript),
    ]
}

/// Random numbers by xorshift.
struct Random(u64);

impl Random {
    fn below(&mut self, bound: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 % bound
    }

    fn bytes(&mut self, count: usize, symbols: u64) -> Vec<u8> {
        (0..count).map(|_| self.below(symbols) as u8).collect()
    }

    /// Lines of a text, some of them often.
    fn text(&mut self, lines: usize) -> Vec<u8> {
        let mut line = || {
            let most = self.below(600) + 1;
            let number = self.below(most);
            format!("value_{number} = {}.0 * x{};\n", number * 7919 % 1000, number % 17)
        };
        (0..lines).flat_map(|_| line().into_bytes()).collect()
    }
}

fn inputs() -> Vec<Vec<u8>> {
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let mut inputs: Vec<Vec<u8>> = (0..24).map(|size| random.text(2)[..size].to_vec()).collect();
    inputs.push(vec![b'x'; 300_000]);
    for symbols in [2, 3, 16, 90, 200, 256] {
        inputs.extend([500, 20_000].map(|size| random.bytes(size, symbols)));
    }
    inputs.extend([10, 200, 1_500, 9_000].map(|lines| random.text(lines)));
    // Similar texts far apart, with noise between them.
    let text = random.text(800);
    let mut apart = text.clone();
    for _ in 0..6 {
        apart.extend(random.bytes(30_000, 250));
        let from = random.below(text.len() as u64 / 2) as usize;
        apart.extend(&text[from..]);
        apart.extend([b'-'; 700]);
    }
    inputs.push(apart);
    inputs.push(repeated_literals(&mut random));
    inputs
}

/// A block of noise, and one of parts of it with the same byte after each.
fn repeated_literals(random: &mut Random) -> Vec<u8> {
    let mut bytes = random.bytes(1 << 17, 250);
    for _ in 0..600 {
        let from = random.below(130_000) as usize;
        bytes.extend_from_within(from..from + 60);
        bytes.push(255);
    }
    bytes
}

/// Writes the frames and what they hold, and returns how many there are.
fn write_frames(folder: &Path) -> Result<usize, Failed> {
    let mut count = 0;
    for raw in inputs() {
        for level in LEVELS {
            let mut compressor = Compressor::new(level)?;
            // Headers of each form: with and without a size and a checksum.
            compressor.set_parameter(CParameter::ContentSizeFlag(count % 2 == 0))?;
            compressor.set_parameter(CParameter::ChecksumFlag(count % 3 == 0))?;
            std::fs::write(folder.join(format!("{count}.zst")), compressor.compress(&raw)?)?;
            std::fs::write(folder.join(format!("{count}.raw")), &raw)?;
            count += 1;
        }
    }
    Ok(count)
}

/// Runs a program on the frames; it prints how many it read.
fn decode(mut command: Command) -> Outcome {
    let folder = tempfile::tempdir()?;
    let count = write_frames(folder.path())?.to_string();
    let said = c::output(command.arg(folder.path()).arg(&count))?;
    if said.trim() == count { Ok(()) } else { Err(format!("it prints `{said}`").into()) }
}

fn in_c() -> Outcome {
    let folder = tempfile::tempdir()?;
    decode(Command::new(c::build("frames", folder.path())?))
}

fn in_javascript() -> Outcome {
    let script: PathBuf = super::javascript::package().join("test/frames.mjs");
    let mut command = Command::new("node");
    command.arg(script);
    decode(command)
}
