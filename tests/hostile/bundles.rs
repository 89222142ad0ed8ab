//! Bundles and cache records that an attacker made. Their checksums are right, so checksums do not
//! protect the reader.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use lamplight::bundle::{Artifact, Bundle, Contents, pack};
use libtest_mimic::{Failed, Trial};
use tempfile::TempDir;

use super::{Outcome, fails, run, run_within};
use crate::regressions::kinds::seal;

type Case = (&'static str, fn() -> Outcome);

pub fn tests() -> Vec<Trial> {
    let cases: [Case; 9] = [
        ("bundle_that_is_no_file", no_file),
        ("bundle_with_a_pipe_for_a_blob", pipe_for_a_blob),
        ("bundle_of_overlapping_blobs", overlapping),
        ("bundle_of_one_piece", many_of_one_piece),
        ("bundle_that_is_mended", mended),
        ("bundle_with_names_for_a_terminal", names),
        ("cache_with_swapped_records", swapped),
        ("cache_with_records_that_grow", growing),
        ("cache_with_pipes", pipes),
    ];
    let test = |(name, case): Case| Trial::test(format!("hostile::{name}"), case);
    cases.into_iter().map(test).collect()
}

/// Every command that reads bundles.
const READERS: [&[&str]; 4] = [
    &["bundle", "verify", "b.lamplight"],
    &["bundle", "pack", "b.lamplight", "-o", "packed.lamplight"],
    &["bundle", "diff", "b.lamplight", "good.lamplight"],
    &["merge", "merged", "b.lamplight", "good.lamplight"],
];

/// An address space that is enough for every ordinary bundle of this size, in KiB.
const LITTLE_KIB: u64 = 1 << 20;

/// How many permutations a [`package`] has.
const PERMUTATIONS: usize = 20 * 15;

/// A package with permutations that all have different texts, and its bundle.
fn package() -> Result<TempDir, Failed> {
    let folder = tempfile::tempdir()?;
    let list = |count: usize| (0..count).map(|i| i.to_string()).collect::<Vec<_>>().join(",");
    let manifest = format!(
        "[program.p]\nwesl = \"s.wesl\"\ntargets = [\"wgsl\"]\n[program.p.axis]\n\
         a = {{ values = [{}] }}\nb = {{ values = [{}] }}\n",
        list(20),
        list(15)
    );
    let shader = "@fragment fn fs_main() -> @location(0) vec4f {\n\
                  return vec4f(f32(constants::a), f32(constants::b), 0.0, 1.0);\n}\n";
    fs::write(folder.path().join("lamplight.toml"), manifest)?;
    fs::write(folder.path().join("s.wesl"), shader)?;
    generate(&folder, "good.lamplight")?;
    Ok(folder)
}

fn generate(folder: &TempDir, out: &str) -> Outcome {
    fails(&run(folder, &["gen", "--cache", "cache", "-o", out])?, 0, "")
}

fn pipe(path: &Path) -> Outcome {
    match Command::new("mkfifo").arg(path).status()?.success() {
        true => Ok(()),
        false => Err(format!("`mkfifo {}` failed", path.display()).into()),
    }
}

/// Every reader refuses the bundle, in little memory, and writes nothing.
fn refused(folder: &TempDir, words: &str) -> Outcome {
    for arguments in READERS {
        let output = run_within(LITTLE_KIB, folder, arguments)?;
        // 1 is a bundle that cannot be opened. 3 is a failed check: the bundle was opened, and its
        // damage was found later.
        let code = if output.status.code() == Some(3) { 3 } else { 1 };
        fails(&output, code, words).map_err(|error| format!("{arguments:?}: {error:?}"))?;
    }
    let is_there = |name: &str| folder.path().join(name).exists();
    match is_there("packed.lamplight") || is_there("merged/manifest.json") {
        true => Err("a command wrote an output from the bundle, although it refused it".into()),
        false => Ok(()),
    }
}

/// A pipe or a device in the place of a bundle is refused. Reading it would never end.
fn no_file() -> Outcome {
    let folder = package()?;
    let place = folder.path().join("b.lamplight");
    pipe(&place)?;
    refused(&folder, "is a pipe or a device")?;
    fs::remove_file(&place)?;
    std::os::unix::fs::symlink("/dev/zero", &place)?;
    refused(&folder, "is a pipe or a device")?;
    fs::remove_file(&place)?;
    fs::create_dir(&place)?;
    pipe(&place.join("manifest.json"))?;
    refused(&folder, "is a pipe or a device")
}

/// A pipe in the place of a blob is refused.
fn pipe_for_a_blob() -> Outcome {
    let folder = package()?;
    generate(&folder, "b.lamplight.dir")?;
    let place = folder.path().join("b.lamplight");
    fs::rename(folder.path().join("b.lamplight.dir"), &place)?;
    let blob = files(&place.join("blobs"))?.into_iter().next().ok_or("no blob")?;
    fs::remove_file(&blob)?;
    pipe(&blob)?;
    refused(&folder, "is a pipe or a device")
}

/// All files below a folder, sorted.
fn files(folder: &Path) -> Result<Vec<PathBuf>, Failed> {
    let (mut found, mut open) = (Vec::new(), vec![folder.to_owned()]);
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(folder)? {
            let path = entry?.path();
            if path.is_dir() { open.push(path) } else { found.push(path) }
        }
    }
    found.sort();
    Ok(found)
}

/// The contents, with other bytes for the first artifact.
fn with_artifact(mut contents: Contents, bytes: Vec<u8>) -> Result<Contents, Failed> {
    let program = contents.programs.values_mut().next().ok_or("no program")?;
    let entries = program.languages.values_mut().next().ok_or("no language")?;
    let entry = entries.values_mut().next().ok_or("no entry point")?;
    let (key, hash) = entry.keys.iter().next().ok_or("no key")?;
    let (key, mut unit) = (key.clone(), entry.units.remove(hash).ok_or("no unit")?);
    let change = |(name, artifact): (String, Artifact)| {
        (name, Artifact { bytes: bytes.clone().into(), ..artifact })
    };
    unit.targets = unit.targets.into_iter().map(change).collect::<BTreeMap<_, _>>();
    let hash = entry.add(unit)?;
    entry.keys.insert(key, hash);
    Ok(contents)
}

/// The offset of the table of blobs.
fn blobs(packed: &[u8]) -> Result<usize, Failed> {
    let at = 24 + 4 * 32;
    let bytes = packed.get(at..at + 8).and_then(|bytes| bytes.try_into().ok());
    Ok(u64::from_le_bytes(bytes.ok_or("no header")?) as usize)
}

/// Each record of a blob has the list of one large blob. A reader that extracted every blob would
/// need much memory for a small file.
fn overlapping() -> Outcome {
    const LARGE: usize = 1 << 20;
    let folder = package()?;
    let good = Bundle::open(folder.path().join("good.lamplight"))?;
    let mut packed = pack(&with_artifact(good.contents()?, vec![0; LARGE])?)?;
    let (table, count) = (blobs(&packed)?, PERMUTATIONS);
    let length = |record: &[u8]| u32::from_le_bytes([record[8], record[9], record[10], record[11]]);
    let records: Vec<Vec<u8>> =
        packed[table..].chunks(32).take(count).map(<[u8]>::to_vec).collect();
    let large = records.iter().find(|record| length(record) as usize == LARGE);
    let large = large.ok_or("no large blob")?.clone();
    for number in 0..count {
        packed[table + number * 32..table + (number + 1) * 32].copy_from_slice(&large);
    }
    write_small(&folder, &seal::bundle(&packed))?;
    refused(&folder, "is damaged")
}

/// Outputs that have one piece hundreds of times: six hundred megabytes in a small file. They are
/// checked one at a time, and refused where all would be in memory together.
fn many_of_one_piece() -> Outcome {
    let folder = package()?;
    let good = Bundle::open(folder.path().join("good.lamplight"))?;
    let mut contents = good.contents()?;
    let line = format!("//{};\n", " ".repeat(4000));
    for entry in contents.entries_mut() {
        for (number, (key, hash)) in std::mem::take(&mut entry.keys).into_iter().enumerate() {
            let mut unit = entry.units.remove(&hash).ok_or("no unit")?;
            for artifact in unit.targets.values_mut() {
                artifact.bytes = (line.repeat(500) + &format!("//{number}\n")).into_bytes().into();
            }
            let hash = entry.add(unit)?;
            entry.keys.insert(key, hash);
        }
    }
    let packed = pack(&contents)?;
    drop(contents);
    write_small(&folder, &packed)?;
    for arguments in READERS {
        let output = run_within(LITTLE_KIB, &folder, arguments)?;
        match arguments[..2] {
            ["bundle", "diff"] => fails(&output, 1, "512 times the bytes of the file")?,
            ["merge", _] => fails(&output, 3, "disagree about permutation")?,
            _ => fails(&output, 0, "")?,
        }
    }
    Ok(())
}

fn write_small(folder: &TempDir, packed: &[u8]) -> Outcome {
    if packed.len() > 100_000 {
        return Err(format!("the file should be small, it has {} bytes", packed.len()).into());
    }
    Ok(fs::write(folder.path().join("b.lamplight"), packed)?)
}

/// A blob has a wrong checksum, but the checksums of the tables above it are right.
fn mended() -> Outcome {
    let folder = package()?;
    let mut packed = fs::read(folder.path().join("good.lamplight"))?;
    let table = blobs(&packed)?;
    packed[table + 16] ^= 1;
    fs::write(folder.path().join("b.lamplight"), seal::bundle(&packed))?;
    refused(&folder, "checksum")
}

/// A name with control characters, which would clear a terminal, is refused and never printed.
fn names() -> Outcome {
    let folder = package()?;
    let packed = fs::read(folder.path().join("good.lamplight"))?;
    let (name, evil) = (b"fs_main\0", b"\x1bs_main\0");
    let at = packed.windows(name.len()).position(|bytes| bytes == name).ok_or("no name")?;
    let packed = [&packed[..at], evil, &packed[at + name.len()..]].concat();
    fs::write(folder.path().join("b.lamplight"), seal::bundle(&packed))?;
    for arguments in READERS.into_iter().chain([&["bundle", "list", "b.lamplight"][..]]) {
        let output = run(&folder, arguments)?;
        fails(&output, 1, "").map_err(|error| format!("{arguments:?}: {error:?}"))?;
        if [output.stdout, output.stderr].concat().contains(&0x1b) {
            return Err(format!("{arguments:?} prints the name's escape character").into());
        }
    }
    Ok(())
}

/// The records of compiled texts in a package's cache.
fn records(folder: &TempDir) -> Result<Vec<PathBuf>, Failed> {
    let found = files(&folder.path().join("cache"))?;
    let is_unit = |path: &PathBuf| path.components().any(|part| part.as_os_str() == "units");
    Ok(found.into_iter().filter(is_unit).collect())
}

/// A run over the changed cache records gives the same bundle as before, in limited memory.
fn same(folder: &TempDir) -> Outcome {
    let limited = ["gen", "--cache", "cache", "-o", "again.lamplight"];
    fails(&run_within(2 << 20, folder, &limited)?, 0, "")?;
    let [one, other] =
        ["good.lamplight", "again.lamplight"].map(|name| fs::read(folder.path().join(name)));
    match one? == other? {
        true => Ok(()),
        false => Err("the changed cache records gave another bundle".into()),
    }
}

/// Records of the cache are exchanged with each other, so each is valid and in the wrong place.
fn swapped() -> Outcome {
    let folder = package()?;
    let records = records(&folder)?;
    for pair in records.chunks_exact(2) {
        let (one, other) = (fs::read(&pair[0])?, fs::read(&pair[1])?);
        fs::write(&pair[0], other)?;
        fs::write(&pair[1], one)?;
    }
    same(&folder)
}

/// Compressed records that claim to hold two gigabytes. One of them really extracts to that much.
fn growing() -> Outcome {
    let folder = package()?;
    for (number, path) in records(&folder)?.into_iter().enumerate() {
        let name = path.strip_prefix(folder.path().join("cache"))?.to_string_lossy().into_owned();
        let name =
            name.split_once("units/").map_or(name.clone(), |(_, rest)| format!("units/{rest}"));
        // An LZ4 match that repeats the previous byte: each byte of input gives 255 of output.
        let length = if number == 0 { 8 << 20 } else { 16 };
        let packed = [&0x7fff_ff00_u32.to_le_bytes()[..], &[0x1f, 0, 1, 0], &vec![255; length]];
        fs::write(&path, seal::record(&name, &packed.concat()))?;
    }
    same(&folder)
}

/// Pipes in the place of cache records are not waited for.
fn pipes() -> Outcome {
    let folder = package()?;
    for path in records(&folder)? {
        fs::remove_file(&path)?;
        pipe(&path)?;
    }
    same(&folder)
}
