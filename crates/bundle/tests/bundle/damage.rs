//! Bundles that are damaged, cut short, or of another version. Loading one must not panic, and
//! verifying it must notice.

use std::path::Path;

use lamplight_bundle::{Bundle, Error, Target, pack, write_directory};

use super::{Outcome, check, small};

/// A random number below a bound, by xorshift, which is good enough to choose positions.
fn random(state: &mut u64, below: usize) -> usize {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    (*state % below as u64) as usize
}

pub fn flips() -> Outcome {
    let packed = pack(&small())?;
    let mut state = 0x1234_5678_9abc_def1;
    for round in 0..2_000 {
        // Every byte of the header, then bytes at random.
        let at = if round < 300 { round } else { random(&mut state, packed.len()) };
        let mut damaged = packed.clone();
        damaged[at] ^= 1 << random(&mut state, 8);
        use_all(damaged, &format!("a flipped bit in byte {at}"))?;
    }
    Ok(())
}

/// Loads, looks up and reads all of a damaged file. None of these may panic, and `verify` must fail.
fn use_all(bytes: Vec<u8>, what: &str) -> Outcome {
    let Ok(bundle) = Bundle::from_bytes(bytes) else { return Ok(()) };
    if let Ok(shader) = bundle.program("forward").and_then(|program| program.shader("fs_main")) {
        let _ = shader.get("shadow=hard", Target::WGSL);
        let _ = shader.get("taps=16", Target::WGSL);
    }
    let _ = bundle.contents();
    check(bundle.verify().is_err(), &format!("damage was not noticed: {what}"))
}

pub fn truncations() -> Outcome {
    let packed = pack(&small())?;
    let mut state = 0xdead_beef_0bad_cafe;
    for round in 0..500 {
        let length = if round < 300 { round } else { random(&mut state, packed.len()) };
        use_all(packed[..length].to_vec(), &format!("cut to {length} bytes"))?;
    }
    use_all([packed.as_slice(), b"x"].concat(), "one byte was added")?;
    let folder = tempfile::tempdir()?;
    let empty = folder.path().join("empty");
    std::fs::write(&empty, b"")?;
    let opened = Bundle::open(empty);
    check(matches!(opened, Err(Error::Corrupt { .. })), "an empty file should be corrupt")
}

pub fn damaged_directories() -> Outcome {
    let folder = tempfile::tempdir()?;
    write_directory(&small(), folder.path())?;
    let manifest = std::fs::read(folder.path().join("manifest.json"))?;
    let mut state = 0x0123_4567_89ab_cdef;
    for round in 0..500 {
        let mut damaged = manifest.clone();
        if round % 5 == 0 {
            damaged.truncate(random(&mut state, manifest.len()));
        } else {
            damaged[random(&mut state, manifest.len())] ^= 1 << random(&mut state, 8);
        }
        std::fs::write(folder.path().join("manifest.json"), &damaged)?;
        let what = format!("round {round}: damage of the manifest was not noticed");
        check(Bundle::open(folder.path())?.verify().is_err(), &what)?;
    }
    std::fs::write(folder.path().join("manifest.json"), &manifest)?;
    let bundle = Bundle::open(folder.path())?;
    bundle.verify()?;
    damaged_indices(folder.path(), &bundle)?;
    let blob = std::fs::read_dir(folder.path().join("blobs"))?.next().ok_or("no blob")??.path();
    let good = std::fs::read(&blob)?;
    let mut bad = good.clone();
    bad[0] ^= 1;
    std::fs::write(&blob, &bad)?;
    check(matches!(bundle.verify(), Err(Error::Corrupt { .. })), "a damaged blob was not noticed")?;
    std::fs::remove_file(&blob)?;
    check(bundle.verify().is_err(), "a missing blob was not noticed")
}

/// A flipped bit in any byte of the index, and an index that is cut off or not there.
fn damaged_indices(folder: &Path, bundle: &Bundle) -> Outcome {
    let place = folder.join("index.bin");
    let index = std::fs::read(&place)?;
    let mut state = 0x0fed_cba9_8765_4321;
    for at in (0..index.len()).step_by(61) {
        let mut damaged = index.clone();
        damaged[at] ^= 1 << random(&mut state, 8);
        std::fs::write(&place, &damaged)?;
        check(bundle.verify().is_err(), &format!("a flipped bit in byte {at} of the index"))?;
    }
    std::fs::write(&place, &index[..index.len() - 1])?;
    check(bundle.verify().is_err(), "an index that was cut off was not noticed")?;
    std::fs::remove_file(&place)?;
    check(bundle.verify().is_err(), "a missing index was not noticed")?;
    std::fs::write(&place, &index)?;
    Ok(bundle.verify()?)
}

pub fn versions() -> Outcome {
    let mut packed = pack(&small())?;
    packed[8] = 9;
    check(
        matches!(Bundle::from_bytes(packed), Err(Error::Version { found: 9, known: 3 })),
        "a file of version 9 should be refused with both versions",
    )?;
    let folder = tempfile::tempdir()?;
    std::fs::write(
        folder.path().join("manifest.json"),
        "{\"version\": 9, \"something\": \"else\"}",
    )?;
    check(
        matches!(Bundle::open(folder.path()), Err(Error::Version { found: 9, known: 3 })),
        "a manifest of version 9 should be refused with both versions",
    )
}
