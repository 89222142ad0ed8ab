//! What lists the packages of the workspace, or the groups of tests, lists all of them.

use std::collections::BTreeSet;
use std::path::Path;

use libtest_mimic::Failed;
use toml::Table;

use crate::ROOT;

/// The folders below `crates/`, by name, with their manifests.
fn packages() -> Result<Vec<(String, Table)>, Failed> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(Path::new(ROOT).join("crates"))? {
        let folder = entry?;
        let text = std::fs::read_to_string(folder.path().join("Cargo.toml"))?;
        found.push((folder.file_name().to_string_lossy().into_owned(), text.parse()?));
    }
    found.sort_by(|(left, _), (right, _)| left.cmp(right));
    Ok(found)
}

/// The packages of this workspace that a package uses, by the folders of `crates/`.
fn used(manifest: &Table) -> BTreeSet<String> {
    let own = manifest.get("dependencies").and_then(|table| table.as_table());
    let names = own.into_iter().flat_map(|table| table.keys());
    names.filter_map(|name| name.strip_prefix("lamplight-").map(str::to_owned)).collect()
}

/// The table of packages in ARCHITECTURE.md lists each once, after those that it uses.
pub fn are_mapped() -> Result<(), Failed> {
    let text = std::fs::read_to_string(Path::new(ROOT).join("ARCHITECTURE.md"))?;
    let rows = text.lines().skip_while(|line| !line.starts_with("| package |")).skip(2);
    let name =
        |line: &str| line.strip_prefix("| `")?.split_once('`').map(|(name, _)| name.to_owned());
    let listed: Vec<String> = rows.map_while(name).collect();
    let mut problems = Vec::new();
    for (name, manifest) in packages()? {
        match listed.iter().position(|row| *row == name) {
            None => problems.push(format!("`{name}` is not listed")),
            Some(at) => problems.extend(
                used(&manifest)
                    .iter()
                    .filter(|one| *one != "shaderlib" && !listed[..at].contains(one))
                    .map(|one| format!("`{name}` is above `{one}`, which it uses")),
            ),
        }
    }
    if listed.iter().collect::<BTreeSet<_>>().len() < listed.len() {
        problems.push("a package is listed twice".to_owned());
    }
    match problems.is_empty() {
        true => Ok(()),
        false => Err(format!("the map of ARCHITECTURE.md:\n{}", problems.join("\n")).into()),
    }
}

/// The workspace's manifest has every package among its dependencies, and among those that are
/// checked in tests. No package depends on the library, and the loader not on naga.
pub fn are_listed() -> Result<(), Failed> {
    let root: Table = std::fs::read_to_string(Path::new(ROOT).join("Cargo.toml"))?.parse()?;
    let shared = &root["workspace"]["dependencies"];
    let checked = &root["profile"]["test"]["package"];
    let mut problems = Vec::new();
    for (folder, manifest) in packages()? {
        let name = format!("lamplight-{folder}");
        if manifest["package"]["name"].as_str() != Some(&name) {
            problems.push(format!("the package in crates/{folder} should be called {name}"));
        }
        if shared.get(&name).is_none() {
            problems.push(format!("{name} is not in [workspace.dependencies]"));
        }
        let only_helps = ["build", "testing"].contains(&folder.as_str());
        if checked.get(&name).is_none() && !only_helps {
            problems.push(format!("{name} is not in [profile.test.package]"));
        }
        if used(&manifest).contains("shaderlib") {
            problems.push(format!("{name} depends on the library, which is passed in"));
        }
        let light = ["bundle", "files"].contains(&folder.as_str());
        let heavy = ["naga", "wgpu", "clap"];
        let table = manifest.get("dependencies").and_then(|table| table.as_table());
        let found = table.into_iter().flat_map(|table| table.keys());
        if light
            && (found.into_iter().any(|one| heavy.contains(&one.as_str()))
                || manifest.contains_key("build-dependencies"))
        {
            problems.push(format!("{name} is what engines load bundles with, and must stay light"));
        }
    }
    if problems.is_empty() { Ok(()) } else { Err(problems.join("\n").into()) }
}

/// The table of what groups of tests need names groups that exist.
pub fn groups_are_known() -> Result<(), Failed> {
    let needs = std::fs::read_to_string(Path::new(ROOT).join("xtask/src/test/needs.rs"))?;
    let mut groups = BTreeSet::new();
    for file in ["tests/main.rs", "tests/quick.rs"] {
        let text = std::fs::read_to_string(Path::new(ROOT).join(file))?;
        let module = |line: &str| line.strip_prefix("mod ")?.strip_suffix(';').map(str::to_owned);
        groups.extend(text.lines().filter_map(module));
    }
    let of_groups =
        needs.split("const OF_GROUPS").nth(1).and_then(|rest| rest.split("\n];").next());
    let rows = of_groups.unwrap_or_default().lines();
    let rows = rows.filter_map(|line| line.trim().strip_prefix("(\"")?.split_once('"'));
    let named: Vec<&str> = rows.map(|(name, _)| name).collect();
    match named.iter().find(|name| !groups.contains(**name)) {
        _ if named.len() < 10 => Err("the table in xtask/src/test/needs.rs was not found".into()),
        Some(name) => Err(format!("there is no group `{name}` of tests").into()),
        None => Ok(()),
    }
}
