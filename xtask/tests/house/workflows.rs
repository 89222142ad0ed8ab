//! The workflows of the forge run commands that exist, with actions that cannot change and with few
//! permissions.

use std::collections::BTreeSet;
use std::path::Path;

use libtest_mimic::Failed;

use crate::ROOT;

/// Every workflow: its file name and its text.
fn workflows() -> Result<Vec<(String, String)>, Failed> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(Path::new(ROOT).join(".github/workflows"))? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        found.push((name, std::fs::read_to_string(&path)?));
    }
    found.sort();
    Ok(found)
}

/// The words after a key, one for each line that has it.
fn values<'t>(text: &'t str, key: &str) -> Vec<&'t str> {
    let lines = text.lines().map(|line| line.trim().trim_start_matches("- "));
    lines.filter_map(|line| line.strip_prefix(key)).map(str::trim).collect()
}

/// The steps of `ci.yml` are those of `cargo xtask ci`, each once, with the minimum Rust version of
/// `Cargo.toml`.
pub fn run_known_steps() -> Result<(), Failed> {
    let ci = std::fs::read_to_string(Path::new(ROOT).join("xtask/src/ci.rs"))?;
    let (_, table) = ci.split_once("const STEPS").ok_or("there is no table of steps")?;
    let (table, _) = table.split_once("];").ok_or("the table of steps has no end")?;
    let rows = table.split('(').filter_map(|row| row.trim_start().strip_prefix('"'));
    let names = rows.filter_map(|row| row.split_once('"'));
    let known: BTreeSet<String> = names.map(|(name, _)| name.to_owned()).collect();
    let all = workflows()?;
    let (_, text) = all.iter().find(|(name, _)| name == "ci.yml").ok_or("there is no ci.yml")?;
    let named: Vec<String> = values(text, "run:")
        .iter()
        .filter_map(|command| command.strip_prefix("cargo xtask ci "))
        .map(str::to_owned)
        .collect();
    if known.len() < 5 || named.iter().cloned().collect::<BTreeSet<_>>() != known {
        return Err(format!("ci.yml runs {named:?}, the steps are {known:?}").into());
    }
    let install = format!("rustup toolchain install {} --", env!("CARGO_PKG_RUST_VERSION"));
    match (named.len() == known.len(), text.contains(&install)) {
        (true, true) => Ok(()),
        (false, _) => Err(format!("ci.yml runs a step twice: {named:?}").into()),
        (_, false) => Err(format!("ci.yml should run `{install}`").into()),
    }
}

/// Every action is named by the hash of a commit with its version beside it, and every workflow
/// begins with the least permissions.
pub fn are_pinned() -> Result<(), Failed> {
    let mut problems = Vec::new();
    for (name, text) in workflows()? {
        for action in values(&text, "uses:") {
            let (_, version) = action.split_once('@').unwrap_or((action, ""));
            let (hash, comment) = version.split_once(" # v").unwrap_or((version, ""));
            let is_hash = hash.len() == 40 && hash.chars().all(|one| one.is_ascii_hexdigit());
            if !is_hash || comment.is_empty() {
                problems.push(format!("{name}: `{action}` should be `ACTION@HASH # vVERSION`"));
            }
        }
        if !text.contains("\npermissions:\n  contents: read\n\n") {
            problems.push(format!("{name} should begin with `permissions: contents: read` alone"));
        }
    }
    if problems.is_empty() { Ok(()) } else { Err(problems.join("\n").into()) }
}
