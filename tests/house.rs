//! Rules of the repository: folders of `src/` have no cycles, the map in ARCHITECTURE.md is true,
//! paths, functions and files are short, and no run left a file behind.

mod lengths;
mod one_way;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

use libtest_mimic::{Failed, Trial};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// Files of `src/` that only declare the others.
const ROOTS: [&str; 2] = ["lib.rs", "main.rs"];

/// For each folder (or single file) of `src/`, those that it uses, each with a file that does so.
type Graph = BTreeMap<String, BTreeMap<String, PathBuf>>;

pub fn trials() -> Vec<Trial> {
    vec![
        Trial::test("house::no_cycles", no_cycles),
        Trial::test("house::map", map_is_in_order),
        Trial::test("house::detects", cycles_are_found),
        Trial::test("house::leftovers", nothing_is_left_behind),
        Trial::test("house::leftovers_are_seen", leftovers_are_seen),
        Trial::test("house::paths", paths_are_short),
        Trial::test("house::one_way_to_the_terminal", one_way::to_the_terminal),
        Trial::test("house::one_rename", one_way::to_rename),
        Trial::test("house::needs", needs_are_installed),
        Trial::test("house::described", entries_are_described),
        Trial::test("house::lengths", lengths::are_kept),
        Trial::test("house::lengths_are_counted", lengths::are_counted),
    ]
}

/// `cargo xtask test` installs what executors and judges need.
fn needs_are_installed() -> Result<(), Failed> {
    let machine = std::fs::read_to_string(Path::new(ROOT).join("xtask/src/machine.rs"))?;
    let of_executors = lamplight::execute::executors::ALL
        .iter()
        .flat_map(|entry| entry.needs.iter().map(|need| (*need, "executor", entry.name)));
    let of_judges = lamplight::judge::judges::ALL
        .iter()
        .flat_map(|entry| entry.tools.iter().map(|tool| (tool.package, "judge", entry.name)));
    let is_missing =
        |need: &(&str, &str, &str)| !machine.contains(&format!("package: \"{}\"", need.0));
    if let Some((need, kind, name)) = of_executors.chain(of_judges).find(is_missing) {
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
        if !Path::new(ROOT).join(folder).join(format!("{name}.rs")).is_file() {
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
    for (name, said) in all {
        if let Some(other) = known.insert(said.clone(), name) {
            problems.push(format!(
                "{folder}/{other}.rs and {name}.rs have the same {what} {said:?}: change the new one's"
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

/// No folder of `src/` uses another that uses it, directly or through others.
fn no_cycles() -> Result<(), Failed> {
    match cycle(&graph()?) {
        Some(cycle) => Err(format!("folders of src/ use each other: {cycle}").into()),
        None => Ok(()),
    }
}

/// The table of folders in ARCHITECTURE.md lists each folder once, after those that it uses.
fn map_is_in_order() -> Result<(), Failed> {
    let text = std::fs::read_to_string(Path::new(ROOT).join("ARCHITECTURE.md"))?;
    let listed: Vec<&str> = text
        .lines()
        .skip_while(|line| !line.starts_with("| folder |"))
        .skip(2)
        .map_while(|line| line.strip_prefix("| `")?.split_once('`').map(|(name, _)| name))
        .map(|name| name.trim_end_matches('/').trim_end_matches(".rs"))
        .collect();
    let graph = graph()?;
    let mut problems = Vec::new();
    for (index, name) in listed.iter().enumerate() {
        match graph.get(*name) {
            None => problems.push(format!("there is no `src/{name}`")),
            Some(_) if listed[..index].contains(name) => {
                problems.push(format!("`{name}` is listed twice"));
            }
            Some(uses) => problems.extend(
                uses.iter().filter(|(used, _)| !listed[..index].contains(&used.as_str())).map(
                    |(used, file)| {
                        format!("`{name}` is above `{used}`, which {} uses", file.display())
                    },
                ),
            ),
        }
    }
    let missing = graph.keys().filter(|name| !listed.contains(&name.as_str()));
    problems.extend(missing.map(|name| format!("`src/{name}` is not listed")));
    match problems.is_empty() {
        true => Ok(()),
        false => Err(format!("the map of ARCHITECTURE.md:\n{}", problems.join("\n")).into()),
    }
}

/// The search for cycles reads every form of a path, and finds a cycle. If it did not, the trial
/// [`no_cycles`] would pass whatever the folders use.
fn cycles_are_found() -> Result<(), Failed> {
    let text = "use crate::{b::X, c::{Y, d::Z}};\nfn f() { crate::e::g() } // crate::no\n";
    let names = named(text, 1);
    if names != BTreeSet::from(["b", "c", "e"].map(str::to_owned)) {
        return Err(format!("the text names b, c and e, found {names:?}").into());
    }
    if named("use super::super::b::X;\nuse super::c;", 2) != BTreeSet::from(["b".to_owned()]) {
        return Err("in a file two folders deep, `super::super::b` should be read as `b`".into());
    }
    let edge = |to: &str| BTreeMap::from([(to.to_owned(), PathBuf::from("file.rs"))]);
    let graph: Graph =
        [("a", "b"), ("b", "c"), ("c", "b")].map(|(a, b)| (a.to_owned(), edge(b))).into();
    match cycle(&graph) {
        Some(words) if words.starts_with("b -> c -> b") => Ok(()),
        other => Err(format!("expected the cycle `b -> c -> b`, found {other:?}").into()),
    }
}

/// The files that the root of the repository may have.
const ROOT_FILES: [&str; 13] = [
    ".gitignore",
    "ARCHITECTURE.md",
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    "Cargo.lock",
    "Cargo.toml",
    "LICENSE-APACHE",
    "LICENSE-MIT",
    "README.md",
    "SECURITY.md",
    "build.rs",
    "clippy.toml",
    "rustfmt.toml",
];

/// Endings of files that editors, tools and failed tests leave behind.
const LEFTOVERS: [&str; 10] =
    [".new", ".orig", ".rej", ".bak", ".tmp", ".log", ".swp", ".profraw", ".spv", "~"];

/// Files that may be binary: pictures, tables, and inputs that are wrong on purpose.
const BINARIES: [&str; 13] = [
    ".png",
    "shaderlib/tables/blue_noise.bin",
    "shaderlib/tables/blue_noise.ktx2",
    "shaderlib/tables/dfg.bin",
    "shaderlib/tables/dfg.ktx2",
    "shaderlib/tables/ltc.bin",
    "shaderlib/tables/ltc.ktx2",
    "shaderlib/tables/sheen.bin",
    "shaderlib/tables/sheen.ktx2",
    "tests/regressions/bundle/valid",
    "tests/regressions/picture/valid",
    "tests/regressions/record/told",
    "tests/regressions/record/valid",
];

/// A path must have fewer characters. Windows allows 260, with the folder that holds the repository.
const LONGEST: usize = 120;

/// The repository has no file that a run left behind.
fn nothing_is_left_behind() -> Result<(), Failed> {
    let files = git(&["ls-files", "-z"])?;
    let ignored = git(&["ls-files", "-z", "--cached", "--ignored", "--exclude-standard"])?;
    let mut found: Vec<String> =
        ignored.iter().map(|path| format!("{path} is committed although git ignores it")).collect();
    for path in &files {
        let bytes = std::fs::read(Path::new(ROOT).join(path));
        // git still lists a file that is deleted before the deletion is committed.
        found.extend(bytes.ok().and_then(|bytes| leftover(path, &bytes)));
    }
    match found.is_empty() {
        true => Ok(()),
        false => Err(found.join("\n").into()),
    }
}

/// The reason why a file does not belong in the repository, if there is one.
fn leftover(path: &str, bytes: &[u8]) -> Option<String> {
    let is_named_so = LEFTOVERS.iter().any(|end| path.ends_with(end));
    let may_be_binary = BINARIES.iter().any(|end| path.ends_with(end));
    if !path.contains('/') && !ROOT_FILES.contains(&path) {
        Some(format!("{path} does not belong in the root; if it does, list it in tests/house.rs"))
    } else if is_named_so || !may_be_binary && std::str::from_utf8(bytes).is_err() {
        Some(format!("{path} looks like a file that a run left behind"))
    } else {
        None
    }
}

/// The search for such files finds those of each kind, and no others.
fn leftovers_are_seen() -> Result<(), Failed> {
    let wrong: [(&str, &[u8]); 4] = [
        ("vert.spv", b""),
        ("notes.txt", b""),
        ("snapshots/emit/a.snap.new", b"text"),
        ("tests/emit/frag", b"\x03\x02\x23\x07\xff"),
    ];
    let right: [(&str, &[u8]); 3] =
        [("README.md", b"text"), ("docs/a.png", b"\x89PNG"), ("src/a.rs", b"text")];
    for (path, bytes) in wrong {
        leftover(path, bytes).ok_or_else(|| format!("{path} should be found, and is not"))?;
    }
    match right.iter().find_map(|(path, bytes)| leftover(path, bytes)) {
        Some(wrong) => Err(format!("this file belongs there: {wrong}").into()),
        None => Ok(()),
    }
}

/// Paths are short enough for every system.
fn paths_are_short() -> Result<(), Failed> {
    let files = git(&["ls-files", "-z"])?;
    let long: Vec<String> =
        files.into_iter().filter(|path| path.chars().count() >= LONGEST).collect();
    match long.is_empty() {
        true => Ok(()),
        false => Err(format!("paths of {LONGEST} characters or more:\n{}", long.join("\n")).into()),
    }
}

/// Runs git and gives the paths that it prints, which end with zero bytes.
fn git(arguments: &[&str]) -> Result<Vec<String>, Failed> {
    let output = Command::new("git").args(arguments).current_dir(ROOT).output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
    }
    let text = String::from_utf8(output.stdout)?;
    Ok(text.split('\0').filter(|path| !path.is_empty()).map(str::to_owned).collect())
}

fn graph() -> Result<Graph, Failed> {
    let source = Path::new(ROOT).join("src");
    let mut files = Vec::new();
    rust_files(&source, &mut files)?;
    let mut graph = Graph::new();
    for file in &files {
        let path = file.strip_prefix(&source)?;
        let parts: Vec<_> = path.iter().map(|part| part.to_string_lossy()).collect();
        let name = parts[0].trim_end_matches(".rs");
        if parts.len() == 1 && ROOTS.contains(&&*parts[0]) {
            continue;
        }
        // How many `super::` lead from this file's items to the crate.
        let depth = parts.len() - usize::from(parts.last().is_some_and(|last| last == "mod.rs"));
        let uses = graph.entry(name.to_owned()).or_default();
        for used in named(&std::fs::read_to_string(file)?, depth) {
            uses.entry(used).or_insert_with(|| Path::new("src").join(path));
        }
    }
    let known: BTreeSet<String> = graph.keys().cloned().collect();
    for (name, uses) in &mut graph {
        uses.retain(|used, _| used != name && known.contains(used));
    }
    Ok(graph)
}

fn rust_files(folder: &Path, files: &mut Vec<PathBuf>) -> std::io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            rust_files(&path, files)?;
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    files.sort();
    Ok(())
}

/// The first names of the crate's paths in a text whose items are `depth` modules deep.
fn named(text: &str, depth: usize) -> BTreeSet<String> {
    let code: String =
        text.lines().map(|line| line.split("//").next().unwrap_or_default()).collect();
    let above = "super::".repeat(depth);
    let mut names = BTreeSet::new();
    for (prefix, before) in [("crate::", "$"), (above.as_str(), ":")] {
        for (at, _) in code.match_indices(prefix) {
            let follows = |letter: char| letter.is_alphanumeric() || letter == '_';
            if code[..at].ends_with(|letter| follows(letter) || before.contains(letter)) {
                continue;
            }
            names.extend(heads(&code[at + prefix.len()..]));
        }
    }
    names
}

/// The first names of the path after `crate::`: one name, or those of a list in braces.
fn heads(rest: &str) -> Vec<String> {
    let word = |text: &str| -> String {
        text.trim_start().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
    };
    let Some(list) = rest.strip_prefix('{') else { return vec![word(rest)] };
    let (mut depth, mut found) = (0_usize, vec![word(list)]);
    for (at, letter) in list.char_indices() {
        match letter {
            '{' => depth += 1,
            '}' if depth == 0 => break,
            '}' => depth -= 1,
            ',' if depth == 0 => found.push(word(&list[at + 1..])),
            _ => {}
        }
    }
    found
}

/// The first cycle of a graph, as text, with a file for each step.
fn cycle(graph: &Graph) -> Option<String> {
    graph.keys().find_map(|start| {
        let mut way = vec![start.as_str()];
        back(graph, &mut way, &mut BTreeSet::new()).then(|| {
            let steps: Vec<String> = way
                .windows(2)
                .map(|step| format!("{} uses {}", graph[step[0]][step[1]].display(), step[1]))
                .collect();
            format!("{}\n{}", way.join(" -> "), steps.join("\n"))
        })
    })
}

/// Extends a path until it leads back to its start. Gives whether that is possible.
fn back<'a>(graph: &'a Graph, way: &mut Vec<&'a str>, seen: &mut BTreeSet<&'a str>) -> bool {
    let Some(uses) = way.last().and_then(|last| graph.get(*last)) else { return false };
    for used in uses.keys() {
        let is_start = way.first().is_some_and(|first| first == used);
        if !is_start && !seen.insert(used) {
            continue;
        }
        way.push(used);
        if is_start || back(graph, way, seen) {
            return true;
        }
        way.pop();
    }
    false
}
