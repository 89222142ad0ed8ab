//! Two commands at the same time over one bundle. A run that waits for another says so, and a reader
//! always finds a whole bundle.

use std::fs::{self, File};
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};
use std::thread;

use libtest_mimic::{Failed, Trial};
use tempfile::TempDir;

use super::{Outcome, fails, run};

type Case = (&'static str, fn() -> Outcome);

pub fn tests() -> Vec<Trial> {
    let cases: [Case; 2] =
        [("waiting_is_reported", waiting), ("verified_while_it_is_written", verified)];
    let test = |(name, case): Case| Trial::test(format!("hostile::{name}"), case);
    cases.into_iter().map(test).collect()
}

/// How often the bundle is written while it is verified.
const ROUNDS: usize = 12;
const GEN: [&str; 5] = ["gen", "--cache", "cache", "-o", "out"];

fn package() -> Result<TempDir, Failed> {
    let folder = tempfile::tempdir()?;
    let manifest = "[program.p]\nwesl = \"s.wesl\"\ntargets = [\"wgsl\"]\n[program.p.axis]\n\
                    a = { values = [0, 1, 2, 3] }\n";
    fs::write(folder.path().join("lamplight.toml"), manifest)?;
    change(&folder, 0)?;
    fails(&run(&folder, &GEN)?, 0, "4 permutations")?;
    Ok(folder)
}

fn change(folder: &TempDir, number: usize) -> Outcome {
    let shader = format!(
        "@fragment fn m() -> @location(0) vec4f {{ return vec4f(f32(constants::a), {number}.0, \
         0.0, 1.0); }}\n"
    );
    Ok(fs::write(folder.path().join("s.wesl"), shader)?)
}

/// A run that finds the bundle locked says that it waits for another run, and continues when the
/// lock is released.
fn waiting() -> Outcome {
    let folder = package()?;
    change(&folder, 1)?;
    let turn = File::open(folder.path().join("out"))?;
    turn.lock()?;
    let mut waiting = Command::new(env!("CARGO_BIN_EXE_lamplight"))
        .args(GEN)
        .current_dir(folder.path())
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()?;
    let mut line = String::new();
    if let Some(stderr) = waiting.stderr.take() {
        BufReader::new(stderr).read_line(&mut line)?;
    }
    drop(turn);
    let status = waiting.wait()?;
    match status.success() && line.contains("another run") {
        true => Ok(()),
        false => Err(format!("expected `another run` and success: {line:?}, {status}").into()),
    }
}

/// A bundle can be verified at any time while runs replace it.
fn verified() -> Outcome {
    let folder = package()?;
    thread::scope(|scope| {
        let writer = scope.spawn(|| {
            (1..=ROUNDS).try_for_each(|number| {
                change(&folder, number)?;
                fails(&run(&folder, &GEN)?, 0, "4 permutations")
            })
        });
        let mut times = 0;
        while !writer.is_finished() || times < ROUNDS {
            fails(&run(&folder, &["bundle", "verify", "out"])?, 0, "")?;
            times += 1;
        }
        writer.join().map_err(|_| Failed::from("the writer panicked"))?
    })
}
