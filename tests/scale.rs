//! The memory that `gen` needs grows little with the number of permutations.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use libtest_mimic::{Failed, Trial};

type Outcome = Result<(), Failed>;

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("scale::memory_is_flat", flat),
        // This takes half a minute, and ten times as long in the development profile.
        Trial::test("scale::one_hundred_thousand_permutations", all).with_ignored_flag(true),
    ]
}

/// The most memory that 100,000 permutations may take, in bytes.
const BOUND: f64 = (1u64 << 30) as f64;

/// Writes a program with five axes. The product of their numbers of values is the number of
/// permutations.
fn package(folder: &Path, counts: [usize; 5]) -> Outcome {
    let axes = ["a", "b", "c", "d", "e"];
    let mut manifest = String::from(
        "[program.large]\nwesl = \"large.wesl\"\ntargets = [\"spirv\", \"wgsl\"]\n\n[program.large.axis]\n",
    );
    for (axis, count) in axes.iter().zip(counts) {
        let values: Vec<String> = (1..=count).map(|value| value.to_string()).collect();
        writeln!(manifest, "{axis} = {{ values = [{}], default = 1 }}", values.join(", "))?;
    }
    let imports = axes.map(|axis| format!("import constants::{axis};\n")).join("");
    let body = axes
        .map(|axis| format!("    sum = sum * 0.5 + vec4<f32>(f32({axis}), sum.xyz);\n"))
        .join("");
    let root = format!(
        "{imports}\n@fragment\nfn fs_main(@location(0) color: vec4<f32>) -> @location(0) vec4<f32> {{\n    var sum = color;\n{}    return sum;\n}}\n",
        body.repeat(8)
    );
    fs::write(folder.join("lamplight.toml"), manifest)?;
    Ok(fs::write(folder.join("large.wesl"), root)?)
}

/// The most memory that `gen` took, in bytes, and its time.
fn peak(counts: [usize; 5]) -> Result<(f64, Duration), Failed> {
    let folder = tempfile::tempdir()?;
    package(folder.path(), counts)?;
    let start = Instant::now();
    let mut child = Command::new(env!("CARGO_BIN_EXE_lamplight"))
        .args(["gen", "--no-cache"])
        .current_dir(folder.path())
        .env("RAYON_NUM_THREADS", "2")
        .stdout(Stdio::null())
        .spawn()?;
    let mut most = 0.0;
    let status = loop {
        // The kernel keeps the highest value, so it is enough to read it now and then.
        let status = fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap_or_default();
        let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        most = line
            .and_then(|line| line.trim().strip_suffix(" kB")?.parse().ok())
            .map_or(most, |found: f64| found * 1024.0);
        if let Some(status) = child.try_wait()? {
            break status;
        }
        std::thread::sleep(Duration::from_millis(10));
    };
    if status.success() && most > 0.0 {
        Ok((most, start.elapsed()))
    } else {
        Err(format!("`gen` ended with {status}, and {most} bytes were measured").into())
    }
}

/// Extrapolated from 1,000 and 10,000 permutations, 100,000 take less memory than the bound.
///
/// Runs of the same size differ by up to 20 MB, and the distance to 100,000 multiplies that by
/// eleven: 4,000 in the place of 10,000 would multiply it by 33, which is more than is free.
fn flat() -> Outcome {
    let ((few, _), (many, _)) = (peak([10, 10, 10, 1, 1])?, peak([10, 10, 10, 10, 1])?);
    let each = (many - few) / 9_000.0;
    let expected = few + 99_000.0 * each;
    println!("{:.1} MB for 1,000, {:.1} MB for 10,000 permutations", few / 1e6, many / 1e6);
    if expected < BOUND {
        Ok(())
    } else {
        let bound = BOUND / 1e6;
        let expected = expected / 1e6;
        Err(format!("100,000 permutations would take {expected:.0} MB of {bound:.0} MB").into())
    }
}

fn all() -> Outcome {
    let (peak, elapsed) = peak([10, 10, 10, 10, 10])?;
    println!("100,000 permutations: {:.0} MB at most, {:.1} s", peak / 1e6, elapsed.as_secs_f64());
    match peak < BOUND {
        true => Ok(()),
        false => Err(format!("took {:.0} MB, at most {:.0} MB", peak / 1e6, BOUND / 1e6).into()),
    }
}
