//! Runs that may have little memory or a small stack. The bundle of the run before stays whole.

use std::fs;
use std::process::{Command, Output};

use libtest_mimic::{Failed, Trial};
use tempfile::TempDir;

use super::{Outcome, fails, run, run_within};

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("hostile::a_small_stack_is_enough", small_stack),
        Trial::test("hostile::little_memory_is_reported", little_memory),
    ]
}

/// A package with a bundle that holds something else than the next run makes.
fn package() -> Result<TempDir, Failed> {
    let folder = tempfile::tempdir()?;
    let values: Vec<String> = (0..100).map(|value| value.to_string()).collect();
    let manifest = format!(
        "[program.p]\nwesl = \"s.wesl\"\ntargets = [\"wgsl\", \"spirv\", \"hlsl\"]\n\
         [program.p.axis]\na = {{ values = [{}] }}\n",
        values.join(", ")
    );
    fs::write(folder.path().join("lamplight.toml"), manifest)?;
    shade(&folder, "1.0")?;
    fails(&run(&folder, &["gen", "-o", "bundle"])?, 0, "100 permutations")?;
    shade(&folder, "2.0")?;
    Ok(folder)
}

fn shade(folder: &TempDir, alpha: &str) -> Outcome {
    let shader = format!(
        "@fragment fn fs_main() -> @location(0) vec4f {{\n\
         return vec4f(f32(constants::a), 0.0, 0.0, {alpha});\n}}\n"
    );
    Ok(fs::write(folder.path().join("s.wesl"), shader)?)
}

/// The stack of the main thread, in KiB: less than the arguments alone would need.
const SMALL_KIB: u64 = 64;

fn small_stack() -> Outcome {
    let folder = package()?;
    let limited = format!("ulimit -s {SMALL_KIB}; exec \"$@\"");
    let output = Command::new("sh")
        .args(["-c", &limited, "sh", env!("CARGO_BIN_EXE_lamplight"), "gen", "-o", "bundle"])
        .current_dir(folder.path())
        .output()?;
    fails(&output, 0, "100 permutations")
}

/// A run that has too little memory ends with a message, or with one of Rust before it aborts.
fn little_memory() -> Outcome {
    let folder = package()?;
    // Below this, the system cannot even start the program.
    let starts =
        |kib: &u64| run_within(*kib, &folder, &["--version"]).is_ok_and(|o| o.status.success());
    let least = (1..64).map(|step| (step * 16) << 10).find(starts).ok_or("it never starts")?;
    let mut starved = 0;
    for kib in (0..12).map(|step| least + step * 8 * 1024) {
        let output = run_within(kib, &folder, &["gen", "--no-cache", "-o", "bundle"])?;
        starved += usize::from(!output.status.success());
        is_reported(&output).map_err(|what| format!("with {kib} KiB: {what}"))?;
        fails(&run(&folder, &["bundle", "verify", "bundle"])?, 0, "")?;
    }
    if starved == 0 {
        return Err(format!("every run from {least} KiB upwards had enough memory").into());
    }
    Ok(())
}

fn is_reported(output: &Output) -> Result<(), String> {
    let message = String::from_utf8_lossy(&output.stderr);
    let is_known = match output.status.code() {
        Some(0) => true,
        Some(1 | 4) => message.contains("error"),
        Some(_) => false,
        // Rust and the system's allocator abort after they said why.
        None => message.contains("memory") || message.contains("allocat"),
    };
    if is_known { Ok(()) } else { Err(format!("{}: {message}", output.status)) }
}
