//! `lamplight gen` and `lamplight compose` give the same bytes, whatever the number of threads,
//! the order of flags, the order in which files were made, and the folder they are in.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

use libtest_mimic::{Failed, Trial};
use tempfile::TempDir;

const FILES: [(&str, &str); 5] = [
    ("lamplight.toml", MANIFEST),
    ("main.wesl", MAIN),
    (
        "light/falloff.wesl",
        "fn falloff(d: f32) -> f32 { return 1.0 / (1.0 + d); }\n@if(warm) const TINT = vec3f(1.0, 0.9, 0.8);\n",
    ),
    (
        "light/cone.wesl",
        "import super::falloff::falloff;\nfn cone(c: f32) -> f32 { return falloff(c) * c; }\n",
    ),
    ("main.frag.glsl", GLSL),
];
const MANIFEST: &str = r#"
[program.b]
wesl = "main.wesl"
targets = ["spirv", "wgsl", "essl300"]
[program.b.axis]
warm = { values = [false, true] }
shape = { values = ["point", "spot", "both"], default = "point" }
count = { values = [1, 4], default = 4 }

[program.a]
glsl = { fragment = "main.frag.glsl" }
targets = ["glsl450", "hlsl", "spirv"]
[program.a.axis]
warm = { values = [false, true] }
"#;
const MAIN: &str = "import package::light::{falloff::{falloff, TINT}, cone::cone};
@fragment fn fs_main(@location(0) at: vec3f) -> @location(0) vec4f {
    var sum = 0.0;
    for (var i = 0; i < constants::count; i++) {
        @if(shape == point || shape == both) sum += falloff(at.x);
        @if(shape != point) sum += cone(at.y);
    }
    @if(warm) return vec4f(sum * TINT, 1.0);
    @else return vec4f(sum);
}
@vertex fn vs_main(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f { return vec4f(f32(index)); }
";
const GLSL: &str = "#version 450
layout(location = 0) out vec4 color;
void main() {
#if WARM
    color = vec4(1.0, 0.5, 0.25, 1.0);
#else
    color = vec4(0.5);
#endif
}
";

/// Numbers of threads. The last is not a power of two, and more than most CI machines have.
const THREADS: [&str; 3] = ["1", "2", "7"];
/// One command with its arguments in different orders.
const GENERATE: [&[&str]; 3] = [
    &["gen", "--manifest", "lamplight.toml", "--target", "spirv,wgsl,glsl450,essl300", "-o"],
    &[
        "gen",
        "--target",
        "glsl450,essl300",
        "--manifest",
        "lamplight.toml",
        "--target",
        "wgsl,spirv",
        "-o",
    ],
    &[
        "gen",
        "--target=essl300",
        "--target=wgsl",
        "--target=spirv",
        "--target=glsl450",
        "--manifest=lamplight.toml",
        "-o",
    ],
];
/// One command with its arguments in different orders.
const COMPOSE: [&[&str]; 3] = [
    &[
        "compose",
        "main.wesl",
        "--root",
        ".",
        "--set",
        "shape=both",
        "--set",
        "count=4",
        "--feature",
        "warm",
    ],
    &[
        "compose",
        "--feature",
        "warm=true",
        "--set",
        "count=4",
        "--set",
        "shape=both",
        "--root",
        ".",
        "main.wesl",
    ],
    &[
        "compose",
        "--set",
        "count=4",
        "--root",
        ".",
        "--feature",
        "warm",
        "main.wesl",
        "--set",
        "shape=both",
    ],
];

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("determinism::folders", || alike(&GENERATE, "bundle")),
        Trial::test("determinism::single_files", || alike(&GENERATE, "bundle.lamplight")),
        Trial::test("determinism::composed_texts", || alike(&COMPOSE, "")),
    ]
}

/// Runs every command with every number of threads, each in a folder of its own.
fn alike(commands: &[&[&str]], out: &str) -> Result<(), Failed> {
    let mut first: Option<BTreeMap<String, Vec<u8>>> = None;
    for (run, (threads, command)) in THREADS
        .iter()
        .flat_map(|threads| commands.iter().map(move |command| (threads, command)))
        .enumerate()
    {
        let folder = written(run)?;
        let outputs = outputs(folder.path(), threads, command, out)?;
        match &first {
            None => first = Some(outputs),
            Some(first) => same(first, &outputs).map_err(|name| {
                let command = command.join(" ");
                format!("{name} differs from the first run's: {threads} threads, `{command}`")
            })?,
        }
    }
    Ok(())
}

fn same(
    first: &BTreeMap<String, Vec<u8>>,
    other: &BTreeMap<String, Vec<u8>>,
) -> Result<(), String> {
    let mut names = first.keys().chain(other.keys());
    names.find(|name| first.get(*name) != other.get(*name)).map_or(Ok(()), |name| Err(name.clone()))
}

/// Writes the files in an order that differs from run to run.
fn written(run: usize) -> Result<TempDir, Failed> {
    let folder = tempfile::tempdir()?;
    let mut files = FILES;
    files.rotate_left(run % FILES.len());
    if run % 2 == 1 {
        files.reverse();
    }
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap())?;
        fs::write(path, text)?;
    }
    Ok(folder)
}

/// Runs a command, and gives the files below `out`, or its output if it writes no files.
fn outputs(
    folder: &Path,
    threads: &str,
    command: &[&str],
    out: &str,
) -> Result<BTreeMap<String, Vec<u8>>, Failed> {
    let mut lamplight = Command::new(env!("CARGO_BIN_EXE_lamplight"));
    lamplight
        .args(command)
        .args((!out.is_empty()).then_some(out))
        .current_dir(folder)
        .env("RAYON_NUM_THREADS", threads);
    let output = lamplight.output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
    }
    let mut found = BTreeMap::new();
    collect(&folder.join(out), "", &mut found)?;
    // With files, the output is a summary with times, which differ from run to run.
    found.extend(out.is_empty().then_some(("standard output".to_owned(), output.stdout)));
    Ok(found)
}

fn collect(path: &Path, name: &str, found: &mut BTreeMap<String, Vec<u8>>) -> std::io::Result<()> {
    if !path.is_dir() {
        found.insert(name.to_owned(), fs::read(path)?);
        return Ok(());
    }
    for entry in fs::read_dir(path)? {
        let entry = entry?;
        collect(&entry.path(), &format!("{name}/{}", entry.file_name().to_string_lossy()), found)?;
    }
    Ok(())
}
