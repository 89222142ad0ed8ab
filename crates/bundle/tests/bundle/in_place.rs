//! A single file that changes while it is open. A reader gets an error, or what it would have got.

use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use lamplight_bundle::{Bundle, Error, Target, pack, write_file};

use super::{Outcome, check, small};

/// How often the file is truncated and written again.
const REWRITES: usize = 150;

/// Truncates a file and writes it again in small parts, as `cp` and `rsync --inplace` do.
fn rewrite(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let mut file = OpenOptions::new().write(true).truncate(true).open(path)?;
    bytes.chunks(512).try_for_each(|part| file.write_all(part))
}

/// All shaders of a bundle that is open, with its tables read now.
fn read_all(bundle: &Bundle) -> Result<Vec<Vec<u8>>, Error> {
    let shader = bundle.program("forward")?.shader("fs_main")?;
    bundle.verify()?;
    ["", "shadow=hard", "max_lights=10"]
        .into_iter()
        .map(|key| Ok(shader.get(key, Target::WGSL)?.bytes.to_vec()))
        .collect()
}

pub fn rewritten() -> Outcome {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("served.lamplight");
    let bytes = pack(&small())?;
    fs::write(&path, &bytes)?;
    let expected = read_all(&Bundle::open(&path)?)?;
    let is_done = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let reader = scope.spawn(|| -> Result<[usize; 2], String> {
            let mut counts = [0, 0];
            while !is_done.load(Ordering::Relaxed) || counts[0] == 0 {
                match Bundle::open(&path).and_then(|bundle| read_all(&bundle)) {
                    Ok(found) if found == expected => counts[0] += 1,
                    Ok(_) => return Err("a shader is not the one that was written".to_owned()),
                    Err(Error::Corrupt { .. } | Error::Io(_)) => counts[1] += 1,
                    Err(other) => return Err(format!("{other:?}")),
                }
            }
            Ok(counts)
        });
        let written = (0..REWRITES).try_for_each(|_| rewrite(&path, &bytes));
        is_done.store(true, Ordering::Relaxed);
        let counts = reader.join().map_err(|_| "the reader panicked")??;
        written?;
        check(counts[0] > 0, "no reading succeeded")
    })?;
    truncated(&path, &bytes)
}

/// Every length to which an open file can be cut gives an error or the right bytes.
fn truncated(path: &Path, bytes: &[u8]) -> Outcome {
    for length in (0..bytes.len()).step_by(bytes.len().div_ceil(REWRITES)) {
        rewrite(path, bytes)?;
        let bundle = Bundle::open(path)?;
        OpenOptions::new().write(true).open(path)?.set_len(length as u64)?;
        let outcome = read_all(&bundle);
        let is_reported = matches!(outcome, Err(Error::Corrupt { .. } | Error::Io(_)));
        check(is_reported, &format!("cut to {length} bytes: {outcome:?}"))?;
    }
    Ok(())
}

/// A file that was replaced by renaming, as `gen` and `pack` do.
pub fn replaced() -> Outcome {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("served.lamplight");
    write_file(&small(), &path)?;
    let bundle = Bundle::open(&path)?;
    let expected = read_all(&Bundle::open(&path)?)?;
    fs::write(folder.path().join("other"), b"another file")?;
    fs::rename(folder.path().join("other"), &path)?;
    check(read_all(&bundle)? == expected, "the reader lost the file that it had opened")
}
