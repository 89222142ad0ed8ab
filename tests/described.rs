//! Entries of open sets are described, and what they need is installed by `cargo xtask test`.

use std::collections::BTreeMap;

use lamplight_testing::snapshot::root;
use libtest_mimic::{Failed, Trial};

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("described::needs", needs_are_installed),
        Trial::test("described::entries", entries_are_described),
    ]
}

/// `cargo xtask test` installs what executors and validators need.
fn needs_are_installed() -> Result<(), Failed> {
    let machine = std::fs::read_to_string(root().join("xtask/src/machine.rs"))?;
    let of_executors = lamplight::execute::executors::ALL
        .iter()
        .flat_map(|entry| entry.needs.iter().map(|need| (*need, "executor", entry.name)));
    let of_validators = lamplight::validators::programs::ALL
        .iter()
        .flat_map(|entry| entry.tools.iter().map(|tool| (tool.package, "validator", entry.name)));
    let is_missing =
        |need: &(&str, &str, &str)| !machine.contains(&format!("package: \"{}\"", need.0));
    if let Some((need, kind, name)) = of_executors.chain(of_validators).find(is_missing) {
        let what = format!("which the {kind} `{name}` needs");
        return Err(format!("xtask/src/machine.rs does not install `{need}`, {what}").into());
    }
    Ok(())
}

/// Targets, executors and scenes have a description and are named after their files.
fn entries_are_described() -> Result<(), Failed> {
    let targets = lamplight::emit::targets::ALL;
    let executors = lamplight::execute::executors::ALL;
    let scenes = lamplight::scene::sets::ALL;
    let all = (targets
        .iter()
        .map(|target| ("crates/emit/src/targets", target.target.name(), target.about)))
    .chain(executors.iter().map(|found| ("crates/execute/src/executors", found.name, found.about)))
    .chain(scenes.iter().map(|scene| ("crates/scenes/src/sets", scene.name, scene.about)));
    let mut problems = Vec::new();
    for (folder, name, about) in all {
        problems.extend(undescribed(name, about));
        if !root().join(folder).join(format!("{name}.rs")).is_file() {
            problems.push(format!("there is no file {folder}/{name}.rs for `{name}`"));
        }
    }
    let abouts = targets.iter().map(|entry| (entry.target.name(), entry.about.to_owned()));
    problems.extend(same_twice("crates/emit/src/targets", "description", abouts));
    let endings = targets.iter().map(|entry| (entry.target.name(), entry.extension.to_owned()));
    problems.extend(same_twice("crates/emit/src/targets", "extension", endings));
    let abouts = executors.iter().map(|entry| (entry.name, entry.about.to_owned()));
    problems.extend(same_twice("crates/execute/src/executors", "description", abouts));
    if problems.is_empty() { Ok(()) } else { Err(problems.join("\n").into()) }
}

/// Two entries of a folder, such as a copy and what it was copied from, do not say the same.
pub fn same_twice<'a>(
    folder: &str,
    what: &str,
    all: impl Iterator<Item = (&'a str, String)>,
) -> Vec<String> {
    let (mut known, mut problems) = (BTreeMap::new(), Vec::new());
    for (name, description) in all {
        if let Some(other) = known.insert(description.clone(), name) {
            problems.push(format!(
                "{folder}/{other}.rs and {name}.rs have the same {what} {description:?}: change the new one's"
            ));
        }
    }
    problems
}

/// What is wrong with an entry's description, which is one line.
pub fn undescribed(name: &str, about: &str) -> Option<String> {
    (about.len() < 4 || about.contains('\n'))
        .then(|| format!("the description of `{name}` should be one line, found {about:?}"))
}
