//! Figures that were measured before are taken from the cache, and no others.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use libtest_mimic::Failed;
use serde_json::Value;

type Outcome = Result<(), Failed>;

/// The figures of a shader, as JSON.
fn cost(folder: &Path, arguments: &[&str]) -> Result<Vec<Value>, Failed> {
    let output = Command::new(env!("CARGO_BIN_EXE_lamplight"))
        .args(["cost", "shader.wesl", "--json"])
        .args(arguments)
        .current_dir(folder)
        .env("XDG_CACHE_HOME", folder.join("home"))
        .output()?;
    match output.status.success() {
        true => Ok(serde_json::from_slice(&output.stdout)?),
        false => Err(String::from_utf8_lossy(&output.stderr).into_owned().into()),
    }
}

/// A fragment stage with a sum of sines.
fn write_shader(folder: &Path, terms: usize) -> Outcome {
    let sum: Vec<String> = (1..=terms).map(|term| format!("sin(x * {term}.0)")).collect();
    let text = format!(
        "@fragment fn fs_main(@location(0) x: f32) -> @location(0) vec4f {{ return vec4f({}); }}\n",
        sum.join(" + ")
    );
    Ok(fs::write(folder.join("shader.wesl"), text)?)
}

/// The records of figures in a cache.
fn records(folder: &Path) -> Result<Vec<PathBuf>, Failed> {
    let mut found = Vec::new();
    for letters in fs::read_dir(folder.join("costs"))? {
        for record in fs::read_dir(letters?.path())? {
            found.push(record?.path());
        }
    }
    found.sort();
    Ok(found)
}

/// A second run gives the same figures and adds no record. Another shader and another GPU have
/// figures of their own. A damaged record is measured again.
pub fn figures_are_kept() -> Outcome {
    let place = tempfile::tempdir()?;
    let folder = place.path();
    let cache = ["--cache", "cache", "--gpu", "navi21"];
    let count = || records(&folder.join("cache")).map(|records| records.len());
    write_shader(folder, 3)?;
    let measured = cost(folder, &["--no-cache", "--gpu", "navi21"])?;
    let first = cost(folder, &cache)?;
    let kept = count()?;
    let again = cost(folder, &cache)?;
    if kept == 0 || measured != first || first != again || count()? != kept {
        return Err(format!("{kept} records\n{measured:?}\n{first:?}\n{again:?}").into());
    }
    for record in records(&folder.join("cache"))? {
        let mut bytes = fs::read(&record)?;
        let middle = bytes.len() / 2;
        bytes[middle] ^= 1;
        fs::write(&record, bytes)?;
    }
    if cost(folder, &cache)? != measured {
        return Err("a damaged record changed the figures".into());
    }
    let other = cost(folder, &["--cache", "cache", "--gpu", "polaris10"])?;
    if other != cost(folder, &["--no-cache", "--gpu", "polaris10"])? || count()? != 2 * kept {
        return Err(format!("another GPU: {other:?}").into());
    }
    for terms in [4, 5, 2] {
        write_shader(folder, terms)?;
        if cost(folder, &cache)? != cost(folder, &["--no-cache", "--gpu", "navi21"])? {
            return Err(format!("{terms} terms have the figures of another shader").into());
        }
    }
    Ok(())
}

/// If no folder is named, the cache is in the user's folder.
pub fn usual_place() -> Outcome {
    let place = tempfile::tempdir()?;
    let folder = place.path();
    write_shader(folder, 3)?;
    cost(folder, &["--gpu", "navi21"])?;
    match records(&folder.join("home/lamplight-cache"))?.is_empty() {
        true => Err("there is no record in the usual place".into()),
        false => Ok(()),
    }
}
