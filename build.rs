//! Finds the crate's open sets by their files, so that adding a diagnostic, a target, a judge, an
//! executor, a reference, a scene or a snippet is adding a file. Writes one Rust table for each.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() -> std::io::Result<()> {
    let root =
        PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").ok_or(std::io::ErrorKind::NotFound)?);
    let out = PathBuf::from(env::var_os("OUT_DIR").ok_or(std::io::ErrorKind::NotFound)?);
    println!("cargo::rustc-env=LAMPLIGHT_BUILD={}", build_id(&root, &out)?);
    fs::write(out.join("codes.rs"), codes(&root.join("src/diagnostic/codes"))?)?;
    fs::write(out.join("target_names.rs"), target_names(&root.join("src/emit/targets"))?)?;
    for (folder, constant, ty) in [
        ("emit/targets", "TARGET", "TargetEntry"),
        ("execute/executors", "EXECUTOR", "ExecutorEntry"),
        ("judge/judges", "JUDGE", "JudgeEntry"),
        ("proof/references", "REFERENCES", "ReferenceEntry"),
        ("scene/sets", "SET", "Set"),
    ] {
        let name = folder.rsplit('/').next().unwrap_or(folder);
        let table = modules(&root.join("src").join(folder), constant, ty)?;
        fs::write(out.join(format!("{name}.rs")), table)?;
    }
    fs::write(out.join("shaderlib.rs"), embedded(&root.join("shaderlib"))?)
}

/// A hash over all that the crate's results depend on: its own sources, the versions of what it
/// is built with, and for what it is built.
fn build_id(root: &Path, out: &Path) -> std::io::Result<String> {
    let mut hash = Fnv::default();
    let mut sources = Vec::new();
    every(&root.join("src"), &mut sources)?;
    every(&root.join("shaderlib"), &mut sources)?;
    sources.sort();
    for path in sources {
        hash.add(relative(root, &path).as_bytes());
        hash.add(&fs::read(&path)?);
    }
    // The lock file of the workspace that is built, which need not be this crate's.
    let lock = out
        .ancestors()
        .chain([root])
        .map(|folder| folder.join("Cargo.lock"))
        .find(|lock| lock.is_file());
    if let Some(lock) = lock {
        println!("cargo::rerun-if-changed={}", lock.display());
        let lock = fs::read_to_string(lock)?;
        hash.add(lock.as_bytes());
        println!("cargo::rustc-env=LAMPLIGHT_NAGA={}", version_of(&lock, "naga"));
    } else {
        println!("cargo::rustc-env=LAMPLIGHT_NAGA=");
    }
    for variable in ["CARGO_PKG_VERSION", "TARGET"] {
        hash.add(env::var(variable).unwrap_or_default().as_bytes());
    }
    Ok(format!("{:032x}", hash.0))
}

/// The version of a dependency; empty where the lock file does not have it.
fn version_of<'a>(lock: &'a str, name: &str) -> &'a str {
    let (_, after) =
        lock.split_once(&format!("name = \"{name}\"\nversion = \"")).unwrap_or_default();
    after.split('"').next().unwrap_or_default()
}

/// FNV-1a of 128 bits: short enough to write down here, and build scripts should stay light.
struct Fnv(u128);

impl Default for Fnv {
    fn default() -> Self {
        Self(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d)
    }
}

impl Fnv {
    fn add(&mut self, bytes: &[u8]) {
        for byte in (bytes.len() as u64).to_le_bytes().iter().chain(bytes) {
            self.0 = (self.0 ^ u128::from(*byte))
                .wrapping_mul(0x0000_0000_0100_0000_0000_0000_0000_013b);
        }
    }
}

/// Every file below a folder.
fn every(folder: &Path, found: &mut Vec<PathBuf>) -> std::io::Result<()> {
    println!("cargo::rerun-if-changed={}", folder.display());
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() { every(&path, found)? } else { found.push(path) }
    }
    Ok(())
}

/// Files with the extension, sorted by name; the folder is watched for changes.
fn files(folder: &Path, extension: &str) -> std::io::Result<Vec<PathBuf>> {
    println!("cargo::rerun-if-changed={}", folder.display());
    if !folder.is_dir() {
        return Ok(Vec::new());
    }
    let mut found: Vec<PathBuf> = fs::read_dir(folder)?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<Result<_, _>>()?;
    found.retain(|path| path.extension().is_some_and(|found| found == extension));
    found.sort();
    Ok(found)
}

fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

fn constant(stem: &str) -> String {
    stem.replace('-', "_").to_uppercase()
}

/// One `Code` constant for each Markdown file: its first line is the title, `Page: NAME` is the
/// page of the guide, the rest explains.
fn codes(folder: &Path) -> std::io::Result<String> {
    let mut table = String::new();
    let mut names = String::new();
    for path in files(folder, "md")? {
        println!("cargo::rerun-if-changed={}", path.display());
        let name = stem(&path);
        let text = fs::read_to_string(&path)?;
        let (title, explanation) = text.split_once('\n').unwrap_or((&text, ""));
        let constant = constant(&name);
        let title = title.trim_start_matches('#').trim();
        let (page, explanation) = explanation
            .trim_start()
            .strip_prefix("Page: ")
            .and_then(|rest| rest.split_once('\n'))
            .unwrap_or(("", explanation));
        let (page, explanation) = (page.trim(), explanation.trim());
        let _ = writeln!(
            table,
            "/// {title}\npub const {constant}: &Code = &Code {{ name: {name:?}, title: {title:?}, explanation: {explanation:?}, page: {page:?} }};"
        );
        let _ = write!(names, "{constant}, ");
    }
    let _ = writeln!(table, "/// Every code, by name.\npub const ALL: &[&Code] = &[{names}];");
    Ok(table)
}

fn target_names(folder: &Path) -> std::io::Result<String> {
    let mut table = String::from("impl Target {\n");
    let mut names = String::new();
    for path in files(folder, "rs")? {
        let name = stem(&path);
        let constant = constant(&name);
        let _ = writeln!(
            table,
            "/// The target `{name}`.\npub const {constant}: Target = Target({name:?});"
        );
        let _ = write!(names, "Target::{constant}, ");
    }
    let _ = writeln!(
        table,
        "/// Every target, by name.\npub const ALL: &'static [Target] = &[{names}];\n}}"
    );
    Ok(table)
}

/// Declares each file of the folder as a module and lists the constant of each, which has the type.
fn modules(folder: &Path, constant: &str, ty: &str) -> std::io::Result<String> {
    let mut table = String::new();
    let mut entries = String::new();
    for path in files(folder, "rs")? {
        let name = stem(&path);
        if folder.ends_with("executors") && !runs_here(&path)? {
            continue;
        }
        let _ = writeln!(table, "#[path = {:?}]\npub mod {name};", path);
        let _ = write!(entries, "&{name}::{constant}, ");
    }
    let _ = writeln!(
        table,
        "/// One entry for each file of the folder, by name.\npub const ALL: &[&{ty}] = &[{entries}];"
    );
    Ok(table)
}

/// Whether an executor can be had on the system that the crate is built for. The line `Runs on:` of
/// its file says so: `every system`, `every system but WebAssembly`, or names of systems as
/// `target_os` has them.
fn runs_here(file: &Path) -> std::io::Result<bool> {
    println!("cargo::rerun-if-changed={}", file.display());
    let family = env::var("CARGO_CFG_TARGET_FAMILY").unwrap_or_default();
    let is_wasm = family.split(',').any(|name| name == "wasm");
    let system = env::var("CARGO_CFG_TARGET_OS").unwrap_or_default();
    let text = fs::read_to_string(file)?;
    let line = text.lines().find_map(|line| line.strip_prefix("//! Runs on: "));
    match line {
        Some("every system") => Ok(true),
        Some("every system but WebAssembly") => Ok(!is_wasm),
        Some(names) if names.split(", ").all(|name| SYSTEMS.contains(&name)) => {
            Ok(names.split(", ").any(|name| name == system))
        }
        _ => {
            let what = "a line `//! Runs on: ` is needed, with `every system`, `every system but \
                WebAssembly`, or some of";
            let systems = SYSTEMS.join(", ");
            Err(std::io::Error::other(format!("{}: {what} `{systems}`", file.display())))
        }
    }
}

/// The systems that a line `Runs on:` may name.
const SYSTEMS: [&str; 6] = ["android", "freebsd", "ios", "linux", "macos", "windows"];

/// The shader library as text, so that an installed binary carries it.
fn embedded(folder: &Path) -> std::io::Result<String> {
    let mut found = Vec::new();
    walk(folder, &mut found)?;
    let mut named: Vec<(String, PathBuf)> =
        found.into_iter().map(|path| (relative(folder, &path), path)).collect();
    named.sort();
    let mut table = String::from(
        "/// Path below `shaderlib/` and text of every file, by path.\npub const FILES: &[(&str, &str)] = &[\n",
    );
    for (name, path) in named {
        let _ = writeln!(table, "({name:?}, include_str!({path:?})),");
    }
    table.push_str("];\n");
    Ok(table)
}

/// The path below a folder, with `/`, as text. Text is what lookups compare, and it sorts otherwise
/// than a `Path`, which sorts by component (`a/b` before `a.b`).
fn relative(folder: &Path, path: &Path) -> String {
    path.strip_prefix(folder).unwrap_or(path).to_string_lossy().replace('\\', "/")
}

fn walk(folder: &Path, found: &mut Vec<PathBuf>) -> std::io::Result<()> {
    println!("cargo::rerun-if-changed={}", folder.display());
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            walk(&path, found)?;
        } else if path.extension().is_some_and(|found| {
            ["wesl", "wgsl", "glsl", "toml"].contains(&found.to_str().unwrap_or_default())
        }) {
            found.push(path);
        }
    }
    Ok(())
}
