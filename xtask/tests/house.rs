//! Rules of the repository: the map in ARCHITECTURE.md is true, paths, functions and files are short,
//! no run left a file behind, what lists the packages lists all of them, and what is published is
//! complete.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "house/destructured.rs"]
mod destructured;
#[path = "house/lengths.rs"]
mod lengths;
#[path = "house/links.rs"]
mod links;
#[path = "house/one_way.rs"]
mod one_way;
#[path = "house/packages.rs"]
mod packages;
#[path = "house/promises.rs"]
mod promises;
#[path = "house/published.rs"]
mod published;
#[path = "house/workflows.rs"]
mod workflows;

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use libtest_mimic::{Arguments, Failed, Trial};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");

fn main() -> ExitCode {
    libtest_mimic::run(&Arguments::from_args(), rules()).exit_code()
}

fn rules() -> Vec<Trial> {
    vec![
        Trial::test("house::map", packages::are_mapped),
        Trial::test("house::packages_are_listed", packages::are_listed),
        Trial::test("house::groups_are_known", packages::groups_are_known),
        Trial::test("house::published", published::is_complete),
        Trial::test("house::workflow_steps", workflows::run_known_steps),
        Trial::test("house::workflow_actions", workflows::are_pinned),
        Trial::test("house::links", links::lead_somewhere),
        Trial::test("house::leftovers", nothing_is_left_behind),
        Trial::test("house::leftovers_are_seen", leftovers_are_seen),
        Trial::test("house::pictures", pictures_are_small),
        Trial::test("house::paths", paths_are_short),
        Trial::test("house::one_way_to_the_terminal", one_way::to_the_terminal),
        Trial::test("house::one_rename", one_way::to_rename),
        Trial::test("house::promises_have_tests", promises::have_tests),
        Trial::test("house::destructured", destructured::in_full),
        Trial::test("house::destructured_is_seen", destructured::is_seen),
        Trial::test("house::lengths", lengths::are_kept),
        Trial::test("house::lengths_are_counted", lengths::are_counted),
    ]
}

/// The files that the root of the repository may have.
const ROOT_FILES: [&str; 15] = [
    ".gitignore",
    "ARCHITECTURE.md",
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    "Cargo.lock",
    "Cargo.toml",
    "LICENSE-APACHE",
    "LICENSE-MIT",
    "README.md",
    "RELEASING.md",
    "SECURITY.md",
    "build.rs",
    "clippy.toml",
    "deny.toml",
    "rustfmt.toml",
];

/// Endings of files that editors, tools and failed tests leave behind.
const LEFTOVERS: [&str; 10] =
    [".new", ".orig", ".rej", ".bak", ".tmp", ".log", ".swp", ".profraw", ".spv", "~"];

/// Files that may be binary: pictures, tables, and inputs that are wrong on purpose.
const BINARIES: [&str; 16] = [
    ".png",
    ".lamplight",
    "shaderlib/tables/blue_noise.bin",
    "shaderlib/tables/blue_noise.ktx2",
    "shaderlib/tables/dfg.bin",
    "shaderlib/tables/dfg.ktx2",
    "shaderlib/tables/ltc.bin",
    "shaderlib/tables/ltc.ktx2",
    "shaderlib/tables/sheen.bin",
    "shaderlib/tables/sheen.ktx2",
    "tests/bundles/good/index.bin",
    ".spv.txt",
    "tests/regressions/bundle/valid",
    "tests/regressions/picture/valid",
    "tests/regressions/record/diagnostics",
    "tests/regressions/record/valid",
];

/// The largest size of all pictures of the documentation, in bytes. Large pictures are drawn by the
/// build of the site.
const PICTURES: u64 = 8_000_000;

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

/// The pictures of the documentation are small together.
fn pictures_are_small() -> Result<(), Failed> {
    let files = git(&["ls-files", "-z", "docs/*.png", "docs/*.svg"])?;
    let sizes = files.iter().filter_map(|path| Path::new(ROOT).join(path).metadata().ok());
    let size: u64 = sizes.map(|metadata| metadata.len()).sum();
    match size {
        0 => Err("no picture was found in docs".into()),
        1..=PICTURES => Ok(()),
        _ => Err(format!("the pictures in docs have {size} bytes, more than {PICTURES}").into()),
    }
}

/// The reason why a file does not belong in the repository, if there is one.
fn leftover(path: &str, bytes: &[u8]) -> Option<String> {
    let is_named_so = LEFTOVERS.iter().any(|end| path.ends_with(end));
    let may_be_binary = BINARIES.iter().any(|end| path.ends_with(end));
    if !path.contains('/') && !ROOT_FILES.contains(&path) {
        Some(format!(
            "{path} does not belong in the root; if it does, list it in xtask/tests/house.rs"
        ))
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
