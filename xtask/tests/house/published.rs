//! What is published: each package has all of its sources and both licences, and nothing else.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

use libtest_mimic::Failed;
use serde_json::Value;

use crate::{ROOT, git};

/// A package that is published: its name, and its folder below the root, empty for the root itself.
struct Published {
    name: String,
    folder: String,
    manifest: Value,
}

/// What each package must have.
const LICENCES: [&str; 2] = ["LICENSE-APACHE", "LICENSE-MIT"];

/// Folders that no package may have. The root's `examples/` is more than its package needs.
const OTHERS: [&str; 7] = ["bench/", "docs/", "fuzz/", "site/", "snapshots/", "tests/", "xtask/"];

/// Files that cargo adds.
const ADDED: [&str; 4] = [".cargo_vcs_info.json", "Cargo.lock", "Cargo.toml", "Cargo.toml.orig"];

/// What the root's package has beside `src/`; `include` of its manifest lists it.
const OF_ROOT: [&str; 4] = ["CHANGELOG.md", "README.md", "build.rs", "examples/load_bundle.rs"];

/// Each package can be described by the registry, and its list of files is right.
pub fn is_complete() -> Result<(), Failed> {
    let mut files = git(&["ls-files", "-z", "--cached", "--others", "--exclude-standard"])?;
    // git still lists a file that is deleted before the deletion is committed.
    files.retain(|file| Path::new(ROOT).join(file).exists());
    let packages = published()?;
    let mut problems = Vec::new();
    for package in &packages {
        for field in ["description", "license", "repository", "rust_version"] {
            if package.manifest[field].as_str().is_none_or(str::is_empty) {
                problems.push(format!("{} has no `{field}`", package.name));
            }
        }
        let wanted = wanted_files(&package.folder, &files);
        let listed = listed_files(&package.name)?;
        let name = &package.name;
        problems.extend(wanted.difference(&listed).map(|file| format!("{name} lacks {file}")));
        problems.extend(listed.difference(&wanted).map(|file| format!("{name} has {file}")));
    }
    match problems.is_empty() {
        true if packages.len() > 20 => Ok(()),
        true => Err("cargo metadata lists too few packages".into()),
        false => Err(problems.join("\n").into()),
    }
}

/// The packages of the workspace that `publish = false` does not keep back.
fn published() -> Result<Vec<Published>, Failed> {
    let listed = cargo(&["metadata", "--format-version", "1", "--no-deps", "--offline"])?;
    let metadata: Value = serde_json::from_str(&listed)?;
    let root = metadata["workspace_root"].as_str().unwrap_or_default();
    let packages = metadata["packages"].as_array().into_iter().flatten();
    let published = packages.filter(|package| package["publish"].is_null()).map(|package| {
        let path = Path::new(package["manifest_path"].as_str().unwrap_or_default());
        let folder = path.parent().and_then(|folder| folder.strip_prefix(root).ok());
        let folder = folder.unwrap_or(path).to_string_lossy().replace('\\', "/");
        let name = package["name"].as_str().unwrap_or_default().to_owned();
        Published { name, folder, manifest: package.clone() }
    });
    Ok(published.collect())
}

/// The files that a package should have: those of the repository in its folder, without tests and, for
/// the root, without other packages and what only the repository needs.
fn wanted_files(folder: &str, files: &[String]) -> BTreeSet<String> {
    let is_of_root = |file: &&str| {
        ["src/", "include/", "cmake/"].iter().any(|start| file.starts_with(start))
            || OF_ROOT.contains(file)
            || LICENCES.contains(file)
    };
    let mut wanted: BTreeSet<String> = match folder {
        "" => files.iter().map(String::as_str).filter(is_of_root).map(str::to_owned).collect(),
        _ => {
            let prefix = format!("{folder}/");
            let below = files.iter().filter_map(|file| file.strip_prefix(&prefix));
            let below = below.filter(|file| !OTHERS.iter().any(|other| file.starts_with(other)));
            below.map(str::to_owned).collect()
        }
    };
    wanted.extend(LICENCES.map(str::to_owned));
    wanted.extend(ADDED.map(str::to_owned));
    wanted
}

/// The files that cargo would pack.
fn listed_files(name: &str) -> Result<BTreeSet<String>, Failed> {
    let list = ["package", "--list", "--allow-dirty", "--offline", "--package", name];
    Ok(cargo(&list)?.lines().map(|file| file.replace('\\', "/")).collect())
}

fn cargo(arguments: &[&str]) -> Result<String, Failed> {
    let program = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(program).args(arguments).current_dir(ROOT).output()?;
    match output.status.success() {
        true => Ok(String::from_utf8(output.stdout)?),
        false => Err(String::from_utf8_lossy(&output.stderr).into_owned().into()),
    }
}
