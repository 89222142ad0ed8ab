//! What functions cost beside their published formulas without guards, what permutations of `forward`
//! cost beside recorded figures of peers, and, with a folder, functions and whole shaders beside those
//! of peers. All ratios are of one run: cycles of vector instructions
//! along the dearest path on one GPU, as Mesa's driver compiles for it.
//!
//! Each folder within the folder of peers is a peer. It is laid out as `tests/plain/`: a module such
//! as `brdf/specular.wesl` or `.glsl` has functions with the names and parameters of the library's.
//! `PROGRAM/KEY.spv`, such as `forward/lights=spot.spv`, is a fragment stage that does what the
//! permutation does.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use lamplight::project;
use lamplight::source::SourceSet;
use serde_json::Value;

use crate::{Outcome, forward};

pub type Cycles = BTreeMap<String, i64>;

pub type Measured<T> = Result<T, Box<dyn std::error::Error>>;

const GPU: &str = "navi21";

/// The row of a function or a permutation: its name, its cycles, and those of the other one.
pub type Row = (String, i64, i64);

/// Prints the ratios, the worst first.
pub fn run() -> Outcome {
    let plain = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/plain");
    let (driver, library) = cycles_of(Path::new("."), &[])?;
    println!("cycles on {GPU}, an AMD GPU, compiled by {driver}\n");
    let rows = paired(&library, &module_cycles(&plain)?);
    let (fast, guarded): (Vec<Row>, Vec<Row>) =
        rows.into_iter().partition(|(name, _, _)| name.ends_with("_fast"));
    print_rows("formulas without guards", guarded);
    print_rows("the same formulas, forms without guards", fast);
    print_forward()?;
    let Some(folder) = std::env::args().nth(2) else { return Ok(()) };
    for peer in folders_of(Path::new(&folder))? {
        let name = peer.file_name().unwrap_or_default().to_string_lossy().into_owned();
        print_rows(&format!("functions of {name}"), paired(&library, &module_cycles(&peer)?));
        print_rows(&format!("shaders of {name}"), program_rows(&peer)?);
    }
    Ok(())
}

/// The permutations of `forward` that peers were measured for.
fn print_forward() -> Outcome {
    let keys = forward::keys();
    let arguments: Vec<&str> =
        ["--program", "forward"].into_iter().chain(keys.iter().map(String::as_str)).collect();
    let (_, cycles) = cycles_of(Path::new("."), &arguments)?;
    print_rows("recorded shaders of peers", forward::rows(&cycles)?);
    for (name, cycles) in forward::further_lamps(&cycles) {
        println!("{cycles:6} cycles for {name}");
    }
    println!();
    Ok(())
}

fn paired(library: &Cycles, others: &Cycles) -> Vec<Row> {
    let row = |(name, other): (&String, &i64)| Some((name.clone(), *library.get(name)?, *other));
    others.iter().filter_map(row).collect()
}

fn print_rows(what: &str, rows: Vec<Row>) {
    if rows.is_empty() {
        return;
    }
    let ratio = |(_, own, other): &Row| *own as f64 / (*other).max(1) as f64;
    let mut rows = rows;
    rows.sort_by(|one, other| {
        ratio(other).total_cmp(&ratio(one)).then_with(|| one.0.cmp(&other.0))
    });
    println!("beside {what}:");
    for row in &rows {
        println!("{:6.2} {:6} {:6}  {}", ratio(row), row.1, row.2, row.0);
    }
    let sum: f64 = rows.iter().map(|row| ratio(row).max(f64::MIN_POSITIVE).ln()).sum();
    let mean = (sum / rows.len() as f64).exp();
    let worst = rows.first().map_or(0.0, ratio);
    println!("{} of {what}: geometric mean {mean:.3}, worst {worst:.2}\n", rows.len());
}

/// The cycles of all functions of a folder of modules, by the library's names.
fn module_cycles(folder: &Path) -> Measured<Cycles> {
    let files = files_below(folder, folder)?;
    let is_module = |file: &&String| file.ends_with(".wesl") || file.ends_with(".glsl");
    let mut found = Cycles::new();
    for file in files.iter().filter(is_module) {
        let (_, cycles) = cycles_of(folder, &["--root", ".", file])?;
        let module = file.rsplit_once('.').map_or(file.as_str(), |(module, _)| module);
        let module = module.replace('/', "::");
        found.extend(cycles.into_iter().map(|(name, cycles)| {
            let function = name.rsplit_once(' ').map_or(name.as_str(), |(_, function)| function);
            (format!("{module}::{function}"), cycles)
        }));
    }
    Ok(found)
}

/// The permutations for which a peer has a shader.
fn program_rows(peer: &Path) -> Measured<Vec<Row>> {
    let library = project::library_manifest();
    let (_, manifest): (SourceSet, _) = library.map_err(|(_, problems)| format!("{problems:?}"))?;
    let mut rows = Vec::new();
    for program in &manifest.programs {
        let folder = peer.join(&program.name);
        if !folder.is_dir() {
            continue;
        }
        for file in files_below(&folder, &folder)? {
            let Some(key) = file.strip_suffix(".spv") else { continue };
            let (_, own) = cycles_of(&folder, &["--program", &program.name, key])?;
            let (_, other) = cycles_of(&folder, &[&file])?;
            let pair = own.values().next().zip(other.values().next());
            let (own, other) = pair.ok_or_else(|| format!("no fragment stage: {file}"))?;
            rows.push((format!("{} {key}", program.name), *own, *other));
        }
    }
    Ok(rows)
}

/// The driver, and the cycles of functions and fragment stages as `lamplight cost` counts them.
fn cycles_of(folder: &Path, arguments: &[&str]) -> Measured<(String, Cycles)> {
    let mut program = std::env::current_exe()?;
    program.set_file_name("lamplight");
    if !program.is_file() {
        return Err(format!("there is no `{}`: cargo build --release", program.display()).into());
    }
    let mut command = Command::new(program);
    command.args(["cost", "--no-cache", "--json", "--gpu", GPU]).args(arguments);
    let output = command.current_dir(folder).output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
    }
    let found: Vec<Value> = serde_json::from_slice(&output.stdout)?;
    let text = |object: &Value, key: &str| object[key].as_str().unwrap_or_default().to_owned();
    let driver = found.first().map(|object| text(object, "driver")).unwrap_or_default();
    let fragments = found.iter().filter(|object| object["stage"] == "fragment");
    let cycles = fragments.filter_map(|object| {
        let figures = if object["net"].is_null() { &object["figures"] } else { &object["net"] };
        Some((text(object, "name"), figures["cycles"].as_i64()?))
    });
    Ok((driver, cycles.collect()))
}

fn folders_of(folder: &Path) -> Measured<Vec<PathBuf>> {
    let entries = std::fs::read_dir(folder)?.collect::<Result<Vec<_>, _>>()?;
    let mut folders: Vec<PathBuf> =
        entries.iter().map(std::fs::DirEntry::path).filter(|path| path.is_dir()).collect();
    folders.sort();
    Ok(folders)
}

/// The files below a folder, by their paths from the root, sorted.
fn files_below(root: &Path, folder: &Path) -> Measured<Vec<String>> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            files.extend(files_below(root, &path)?);
        } else if let Ok(below) = path.strip_prefix(root) {
            files.push(below.to_string_lossy().replace('\\', "/"));
        }
    }
    files.sort();
    Ok(files)
}
