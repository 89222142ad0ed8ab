//! `cargo xtask test fast`: the tests that need little outside the repository, those of changed
//! packages first.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use serde_json::Value;

use super::binaries::{self, TestBinary};
use super::needs;
use xtask::process::{self, root};
use xtask::{CommandFailure, CommandResult, machine};

/// Packages of the workspace in an order in which each comes after those that it depends on, with
/// these.
type Workspace = Vec<(String, BTreeSet<String>)>;

/// Runs the tests of the packages that the arguments name, or of those that changes since the last
/// commit can affect, or of all packages where nothing changed. The packages that changed come first:
/// their tests are built from the least.
pub fn run(arguments: &[String]) -> CommandResult {
    let workspace = read_workspace()?;
    let changed = match arguments.is_empty() {
        true => changed_packages()?,
        false => arguments.iter().map(|name| full_name(name)).collect(),
    };
    let binaries = binaries::find_binaries()?;
    let light: Vec<&TestBinary> = binaries.iter().filter(|binary| is_light(binary)).collect();
    let started = Instant::now();
    let mut failed = Vec::new();
    let order = in_order(&workspace, &changed, arguments.is_empty());
    let pairs = order.iter().flat_map(|name| light.iter().map(move |binary| (name, *binary)));
    let chosen = pairs.filter(|(name, binary)| binary.package == **name);
    let chosen: Vec<&TestBinary> = chosen.map(|(_, binary)| binary).collect();
    machine::prepare(&Some(needs::of_packages(chosen.iter().copied()).collect()))?;
    for TestBinary { package, target, groups: _ } in chosen {
        println!("{package} ({target}), after {:.1?}", started.elapsed());
        let test = ["test", "--quiet", "--package", package, "--test", target];
        if process::cargo(&test, &["--quiet".to_owned()]).is_err() {
            failed.push(package.clone());
        }
    }
    println!("{:.1?}", started.elapsed());
    match failed.is_empty() {
        true => Ok(()),
        false => Err(CommandFailure::check(format!("failed: {}", failed.join(", ")))),
    }
}

/// Whether tests need no more outside the repository than [`needs::of_packages`] lists.
fn is_light(binary: &TestBinary) -> bool {
    (binary.package.as_str(), binary.target) != ("lamplight", "all")
}

/// Runs these tests of all packages, whatever changed. Those below `crates/` are built together,
/// before the whole.
pub fn test_packages() -> CommandResult {
    let binaries = binaries::find_binaries()?;
    let light = binaries.iter().filter(|binary| is_light(binary));
    machine::prepare(&Some(needs::of_packages(light).collect()))?;
    let (of_root, of_packages): (Vec<&TestBinary>, Vec<&TestBinary>) = binaries
        .iter()
        .filter(|binary| is_light(binary))
        .partition(|binary| binary.package == "lamplight");
    let test_all = |binaries: &[&TestBinary]| {
        let mut arguments = vec!["test", "--locked", "--no-fail-fast"];
        for TestBinary { package, target, groups: _ } in binaries {
            arguments.extend(["--package", package, "--test", target]);
        }
        process::cargo(&arguments, &[])
    };
    let [packages, root] = [of_packages, of_root].map(|binaries| test_all(&binaries));
    packages.and(root)
}

/// `eval` for `lamplight-eval`.
fn full_name(name: &str) -> String {
    match name {
        "lamplight" | "xtask" => name.to_owned(),
        _ => format!("lamplight-{}", name.trim_start_matches("lamplight-")),
    }
}

/// The packages to test: changed ones, then those that depend on them unless only the former are
/// wanted; all of them if nothing changed. The rules of the repository take no time, so they are
/// always checked.
fn in_order(workspace: &Workspace, changed: &BTreeSet<String>, with_users: bool) -> Vec<String> {
    let uses = |used: &BTreeSet<String>| used.iter().any(|name| changed.contains(name));
    let names = |wanted: &dyn Fn(&str, &BTreeSet<String>) -> bool| -> Vec<String> {
        let all = workspace.iter().filter(|(name, used)| wanted(name, used));
        all.map(|(name, _)| name.clone()).collect()
    };
    let mut order = names(&|name, _| changed.contains(name));
    if with_users {
        order.extend(names(&|name, used| !changed.contains(name) && uses(used)));
        order.push("xtask".to_owned());
    }
    if order.iter().all(|name| name == "xtask") && changed.is_empty() {
        order = names(&|_, _| true);
    }
    let mut known = BTreeSet::new();
    order.retain(|name| known.insert(name.clone()));
    order
}

/// Packages with files that differ from the last commit, by git.
fn changed_packages() -> Result<BTreeSet<String>, CommandFailure> {
    let mut git = Command::new("git");
    git.args(["status", "--porcelain", "--untracked-files=all", "--no-renames"]);
    let listed =
        git.current_dir(root()).output().map_err(|error| process::not_run("git", &error))?;
    process::succeeded(listed.status, "git status")?;
    let listed = String::from_utf8_lossy(&listed.stdout);
    let paths = listed.lines().filter_map(|line| line.get(3..)).map(|path| path.trim_matches('"'));
    Ok(paths.filter_map(package_of).collect())
}

/// The package that a file of the repository belongs to; `None` if no build reads it.
fn package_of(path: &str) -> Option<String> {
    let mut parts = path.split('/');
    match (parts.next()?, parts.next()) {
        ("crates", Some(folder)) => Some(format!("lamplight-{folder}")),
        ("shaderlib", _) => Some("lamplight-shaderlib".to_owned()),
        ("src" | "tests" | "examples" | "build.rs" | "Cargo.toml", _) => {
            Some("lamplight".to_owned())
        }
        ("xtask", _) => Some("xtask".to_owned()),
        _ => Path::new(path)
            .extension()
            .is_some_and(|ending| ending == "md")
            .then(|| "xtask".to_owned()),
    }
}

/// The packages by `cargo metadata`.
fn read_workspace() -> Result<Workspace, CommandFailure> {
    let mut command = process::cargo_command();
    command.args(["metadata", "--format-version", "1", "--no-deps", "--offline"]);
    let output = command.output().map_err(|error| process::not_run("cargo metadata", &error))?;
    process::succeeded(output.status, "cargo metadata")?;
    let metadata: Value = serde_json::from_slice(&output.stdout)
        .map_err(|error| CommandFailure::environment(format!("cargo metadata: {error}")))?;
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
    let direct: BTreeMap<String, BTreeSet<String>> = list(&metadata["packages"])
        .iter()
        .map(|package| {
            let own = list(&package["dependencies"]);
            let used = own.iter().filter(|used| used["path"].is_string() && used["kind"] != "dev");
            (text(&package["name"]), used.map(|used| text(&used["name"])).collect())
        })
        .collect();
    Ok(sorted(&direct))
}

/// Packages after those that they use, each with all that it uses.
fn sorted(direct: &BTreeMap<String, BTreeSet<String>>) -> Workspace {
    let mut order = Workspace::new();
    while order.len() < direct.len() {
        let known: BTreeMap<&String, &BTreeSet<String>> =
            order.iter().map(|(name, used)| (name, used)).collect();
        let is_ready = |(name, used): &(&String, &BTreeSet<String>)| {
            !known.contains_key(name) && used.iter().all(|one| known.contains_key(one))
        };
        let Some((name, used)) = direct.iter().find(is_ready) else { break };
        let further = used.iter().flat_map(|one| known[one].iter().cloned());
        let whole = used.iter().cloned().chain(further).collect();
        order.push((name.clone(), whole));
    }
    order
}
