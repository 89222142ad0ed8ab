//! Where the cycles of `forward` go: how far the sum over its covering set falls if
//! functions of the library do nothing.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use libtest_mimic::Failed;
use serde_json::Value;

use super::{GPU, Outcome, folder, lamplight};
use crate::snapshot;

/// A change of the library: what it does, by how many per cent the sum falls, and the new bodies of
/// functions by file.
#[derive(serde::Deserialize)]
struct Change {
    about: String,
    falls_by: f64,
    bodies: BTreeMap<PathBuf, BTreeMap<String, String>>,
}

#[derive(serde::Deserialize)]
struct Rest {
    /// The sum with checks of bounds.
    restrict: i64,
    change: Vec<Change>,
}

fn file() -> PathBuf {
    folder().join("rest.toml")
}

fn recorded() -> Result<Rest, Failed> {
    Ok(toml::from_str(&std::fs::read_to_string(file())?)?)
}

/// A number as the page has it: 145,523.
fn grouped(number: i64) -> String {
    let digits = number.to_string();
    let groups: Vec<&str> = digits
        .as_bytes()
        .rchunks(3)
        .rev()
        .map(|group| str::from_utf8(group).unwrap_or(""))
        .collect();
    groups.join(",")
}

/// The page with the sums and the table.
pub fn filled(page: &str) -> Result<String, Failed> {
    let Rest { restrict, change } = recorded()?;
    let mut rows = String::new();
    for Change { about, falls_by, .. } in change {
        writeln!(rows, "| {about} | {falls_by:.1} % |")?;
    }
    let (budget, count) = recorded_sum()?;
    let page = page
        .replace("{count}", &count.to_string())
        .replace("{sum}", &grouped(budget))
        .replace("{restrict}", &grouped(restrict));
    Ok(page.replace("{changes}\n", &rows))
}

/// The sum over the covering set, and its permutations, from the recorded budget of programs.
fn recorded_sum() -> Result<(i64, usize), Failed> {
    let path = snapshot::root().join("snapshots/costs/programs.json");
    let budget: Value = serde_json::from_str(&std::fs::read_to_string(path)?)?;
    let costs = budget["costs"].as_object().ok_or("no costs are recorded")?;
    let own = costs.iter().filter(|(name, _)| name.starts_with("forward "));
    let sum = own.clone().filter_map(|(_, figures)| figures["cycles"].as_i64()).sum();
    let count = own.filter(|(name, _)| name.ends_with(" fragment")).count();
    Ok((sum, count))
}

/// The sum over the covering set, as measured now.
fn measured_sum(arguments: &[&str]) -> Result<i64, Failed> {
    let cover = ["cost", "--cover", "--program", "forward", "--gpu", GPU, "--json"];
    let found: Vec<Value> =
        serde_json::from_str(&lamplight(&[&cover[..], arguments].concat(), "")?)?;
    Ok(found.iter().filter_map(|one| one["figures"]["cycles"].as_i64()).sum())
}

/// The text, with the body of a function replaced.
fn with_body(text: &str, function: &str, body: &str) -> Result<String, Failed> {
    let missing = || format!("there is no function `{function}`");
    let head = text.find(&format!("\nfn {function}(")).ok_or_else(missing)?;
    let start = head + text[head..].find('{').ok_or_else(missing)?;
    let end = start + text[start..].find("\n}\n").ok_or_else(missing)?;
    Ok(format!("{}{{\n    {body}{}", &text[..start], &text[end..]))
}

fn copy_folder(from: &Path, to: &Path) -> Outcome {
    std::fs::create_dir_all(to)?;
    for entry in std::fs::read_dir(from)? {
        let entry = entry?;
        let to = to.join(entry.file_name());
        if entry.file_type()?.is_dir() {
            copy_folder(&entry.path(), &to)?;
        } else {
            std::fs::copy(entry.path(), to)?;
        }
    }
    Ok(())
}

/// By how many per cent the sum falls with a change.
fn fall(change: &Change, before: i64) -> Result<f64, Failed> {
    let place = tempfile::tempdir()?;
    copy_folder(&snapshot::root().join("shaderlib"), place.path())?;
    for (file, bodies) in &change.bodies {
        let path = place.path().join(file);
        let mut text = std::fs::read_to_string(&path)?;
        for (function, body) in bodies {
            text = with_body(&text, function, body)?;
        }
        std::fs::write(path, text)?;
    }
    let manifest = place.path().join("lamplight.toml");
    let after = measured_sum(&["--manifest", &manifest.to_string_lossy()])?;
    Ok(100.0 * (before - after) as f64 / before as f64)
}

/// Writes figures behind their keys, in the order of the file.
fn write_figures(figures: &[(&str, String)]) -> Outcome {
    let text = std::fs::read_to_string(file())?;
    let mut figures = figures.iter().peekable();
    let line = |line: &str| match figures.next_if(|(key, _)| line.starts_with(key)) {
        Some((key, figure)) => format!("{key}{figure}\n"),
        None => format!("{line}\n"),
    };
    Ok(std::fs::write(file(), text.lines().map(line).collect::<String>())?)
}

/// The figures of `rest.toml` are what is measured. It takes minutes, so it runs only when asked
/// for; `UPDATE_EXPECT=1` writes the figures.
pub fn where_the_rest_goes() -> Outcome {
    let is_updated = std::env::var_os("UPDATE_EXPECT").is_some();
    let Rest { restrict, change } = recorded()?;
    let before = measured_sum(&[])?;
    let checked = measured_sum(&["--bounds", "restrict"])?;
    let (mut wrong, mut figures) = (Vec::new(), vec![("restrict = ", checked.to_string())]);
    if checked != restrict {
        wrong.push(format!("with checks: {checked}, recorded {restrict}"));
    }
    for change in &change {
        let falls_by = (10.0 * fall(change, before)?).round() / 10.0;
        figures.push(("falls_by = ", format!("{falls_by:.1}")));
        if falls_by != change.falls_by {
            wrong.push(format!("{}: {falls_by}, recorded {}", change.about, change.falls_by));
        }
    }
    if is_updated {
        return write_figures(&figures);
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong.join("\n").into()) }
}
