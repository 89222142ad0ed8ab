//! `gen`, `merge` and `watch` over a small package. They do only work that is new, caches and shards
//! do not change a byte, and errors from a cache are those of a fresh run.

mod damaged;
mod server;
mod shards;
mod shared;
mod watched;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use lamplight::compose::lean;
use lamplight_testing::commands::stderr_text;
use libtest_mimic::{Failed, Trial};
use serde_json::Value;
use tempfile::TempDir;

use server::{killed_server, shared_server, stopped_server};
use shards::{mixed_shards, newer, parallel, shards, wrong_shards};
use shared::{foreign_folder, shared_folder};
use watched::watch;

type Outcome = Result<(), Failed>;
type Case = (&'static str, fn() -> Outcome);

pub fn tests() -> Vec<Trial> {
    let cases: [Case; 24] = [
        ("comments_and_layout_go_and_nothing_else", layout),
        ("a_second_run_does_nothing", nothing_to_do),
        ("an_edit_compiles_what_it_reaches", edits),
        ("what_is_not_reached_is_not_compiled", unreached),
        ("caches_change_no_byte", caching),
        ("damaged_records_are_made_again", damage),
        ("lost_blobs_are_written_again", lost_blobs),
        ("damaged_bundles_are_noticed_and_repaired", damaged::bundles),
        ("mistakes_come_from_the_cache_in_their_new_place", mistakes),
        ("check_compares", check),
        ("a_rule_names_what_was_read", rules),
        ("shards_merge_to_the_whole", shards),
        ("shards_run_under_gnu_parallel", parallel),
        ("missing_and_foreign_shards_are_noticed", wrong_shards),
        ("shards_of_another_origin_are_refused", mixed_shards),
        ("a_newer_bundle_is_kept", newer),
        ("another_run_is_waited_for_only_so_long", watched::stopped),
        ("a_key_and_a_target_can_be_chosen", choices),
        ("watch_follows_edits", watch),
        ("a_folder_can_be_shared", shared_folder),
        ("a_foreign_folder_is_no_store", foreign_folder),
        ("a_redis_server_can_be_shared", shared_server),
        ("a_redis_server_that_is_killed_changes_nothing", killed_server),
        ("a_redis_server_that_is_stopped_changes_nothing", stopped_server),
    ];
    cases.into_iter().map(|(name, case)| Trial::test(format!("generate::{name}"), case)).collect()
}

/// The rule of `--depfile` names the bundle, the manifest and every module, also in a run with a
/// warm cache; and a run that has nothing to do writes it where it is missing.
fn rules() -> Outcome {
    let package = Package::new()?;
    for out in ["bundle", "one.lamplight"] {
        let arguments = ["-o", out, "--depfile", "rule.d"];
        package.generate(&arguments)?;
        let rule = fs::read_to_string(package.path().join("rule.d"))?;
        let target = if out == "bundle" { "bundle/manifest.json" } else { out };
        ensure(rule.starts_with(&format!("{target}:")), &rule)?;
        for file in ["lamplight.toml", "small.wesl", "tint.wesl", "small.vert.glsl"] {
            ensure(rule.contains(file), format!("the rule has no {file}: {rule}"))?;
        }
        fs::remove_file(package.path().join("rule.d"))?;
        package.generate(&arguments)?;
        equal(fs::read_to_string(package.path().join("rule.d"))?, rule)?;
    }
    Ok(())
}

/// A lean text has no comments and no layout, and is otherwise unchanged. Otherwise two texts with
/// different meanings could share a place in the cache.
fn layout() -> Outcome {
    let wgsl = [
        ("a / b;", "a / b;"),
        ("a // b\nc", "a c"),
        ("a /* b /* c */ d */ e", "a e"),
        ("a/**/b/*/ */c", "a b c"),
        ("a//", "a"),
        ("a /* open", "a"),
        ("a /", "a /"),
        ("é // é\u{2028}b", "é b"),
        ("a //* b\n*/c", "a */c"),
        ("/* a */ fn red // b\n ( x : f32 ) { }", "fn red(x : f32){}"),
        ("a - -b; c & &d", "a - -b;c & &d"),
        ("a\u{a0} b", "a\u{a0} b"),
        (" \n", ""),
    ];
    let glsl = [
        ("#version 450\n\n  int a; // b\n", "#version 450\nint a;\n"),
        ("a /* b\n c */ d / e", "a d / e\n"),
        ("  #define A (b)\n void  main( /* c */ ) { }", "#define A (b)\nvoid main(){}\n"),
        ("a /* /* */ b", "a b\n"),
        ("/", "/\n"),
        ("a /* open", "a\n"),
    ];
    let wgsl = wgsl.into_iter().map(|(text, wanted)| (lean::lean_wgsl(text), wanted));
    let glsl = glsl.into_iter().map(|(text, wanted)| (lean::lean_glsl(text), wanted));
    match wgsl.chain(glsl).find(|(found, wanted)| found != wanted) {
        None => Ok(()),
        Some((found, wanted)) => Err(format!("found {found:?}, wanted {wanted:?}").into()),
    }
}

const MANIFEST: &str = r#"
[program.small]
wesl = "small.wesl"
glsl = { vertex = "small.vert.glsl" }
targets = ["wgsl", "spirv", "glsl330"]

[program.small.axis]
tint = { values = ["red", "green", "blue"], default = "red" }
steps = { values = [1, 2], default = 1 }
shaded = { values = [false, true] }
"#;

const ROOT: &str = "import package::tint::{red, green, blue};
import package::shade::{shade, unused};
import constants::steps;

@vertex
fn vs_main(@location(0) position: vec3<f32>) -> @builtin(position) vec4<f32> {
    return vec4<f32>(position, 1.0);
}

@fragment
fn fs_main(@builtin(position) place: vec4<f32>) -> @location(0) vec4<f32> {
    var color = vec4<f32>(0.0);
    @if(tint == red) color = red(place);
    @if(tint == green) color = green(place);
    @if(tint == blue) color = blue(place);
    @if(shaded) color = shade(color, steps);
    return color * f32(steps);
}
";

const TINT: &str = "fn red(p: vec4<f32>) -> vec4<f32> { return p * vec4<f32>(1.0, 0.0, 0.0, 1.0); }
fn green(p: vec4<f32>) -> vec4<f32> { return p * vec4<f32>(0.0, 1.0, 0.0, 1.0); }
fn blue(p: vec4<f32>) -> vec4<f32> { return p * vec4<f32>(0.0, 0.0, 1.0, 1.0); }
";

const SHADE: &str =
    "fn shade(color: vec4<f32>, steps: i32) -> vec4<f32> { return color / f32(steps + 1); }
fn unused() -> f32 { return 1.0; }
";

const VERTEX: &str = "#version 450
layout(location = 0) in vec3 position;
void main() {
#if SHADED
    gl_Position = vec4(position, 2.0);
#else
    gl_Position = vec4(position, 1.0);
#endif
}
";

/// The number of permutations.
const PERMUTATIONS: u64 = 12;
/// The number of distinct texts of all entry points: twelve fragment shaders, one vertex shader in
/// WESL and two in GLSL.
const TEXTS: u64 = 15;

struct Package(TempDir);

impl Package {
    fn new() -> Result<Self, Failed> {
        let package = Self(tempfile::tempdir()?);
        for (name, text) in [
            ("lamplight.toml", MANIFEST),
            ("small.wesl", ROOT),
            ("tint.wesl", TINT),
            ("shade.wesl", SHADE),
            ("small.vert.glsl", VERTEX),
        ] {
            package.write(name, text)?;
        }
        Ok(package)
    }

    fn path(&self) -> &Path {
        self.0.path()
    }

    fn write(&self, name: &str, text: &str) -> Outcome {
        Ok(fs::write(self.path().join(name), text)?)
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_lamplight"));
        command.args(arguments).current_dir(self.path()).env("RAYON_NUM_THREADS", "2");
        command
    }

    fn run(&self, arguments: &[&str]) -> Result<Output, Failed> {
        Ok(self.command(arguments).output()?)
    }

    /// Runs `gen`, which must succeed, and gives its summary.
    fn generate(&self, arguments: &[&str]) -> Result<Value, Failed> {
        let all = [&["gen", "--json", "--cache", "cache"], arguments].concat();
        let output = self.run(&all)?;
        if !output.status.success() {
            return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
        }
        Ok(serde_json::from_slice(&output.stdout)?)
    }

    /// Every file below a folder.
    fn files(&self, folder: &str) -> Result<BTreeMap<String, Vec<u8>>, Failed> {
        let mut found = BTreeMap::new();
        let mut folders = vec![self.path().join(folder)];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder)? {
                let path = entry?.path();
                if path.is_dir() {
                    folders.push(path);
                } else {
                    let name = path.strip_prefix(self.path())?.to_string_lossy().into_owned();
                    found.insert(
                        name.split_once('/').map_or(name.clone(), |(_, rest)| rest.to_owned()),
                        fs::read(&path)?,
                    );
                }
            }
        }
        Ok(found)
    }
}

fn ensure(holds: bool, message: impl Into<String>) -> Outcome {
    if holds { Ok(()) } else { Err(message.into().into()) }
}

/// Fails, with the place of the call, unless two values are equal.
#[track_caller]
fn equal<T: PartialEq + std::fmt::Debug>(found: T, expected: T) -> Outcome {
    let place = std::panic::Location::caller();
    ensure(found == expected, format!("{place}: found {found:?}, expected {expected:?}"))
}

fn texts(summary: &Value) -> u64 {
    let entries = summary["programs"]
        .as_array()
        .into_iter()
        .flatten()
        .filter_map(|program| program["entries"].as_array());
    entries.flatten().filter_map(|entry| entry["unique"].as_u64()).sum()
}

fn compiled(summary: &Value) -> u64 {
    texts(summary) - summary["cached"].as_u64().unwrap_or_default()
}

/// A second run finds that the bundle is up to date, quickly, and prints the same warnings. A new
/// comment in the manifest needs a run that compiles nothing.
fn nothing_to_do() -> Outcome {
    let package = Package::new()?;
    let first = package.generate(&[])?;
    equal((texts(&first), compiled(&first)), (TEXTS, TEXTS))?;
    equal(first["programs"][0]["permutations"].as_u64(), Some(PERMUTATIONS))?;
    let second = package.generate(&[])?;
    equal(&second["up_to_date"], &Value::Bool(true))?;
    // The run prints the warnings about texts that it did not compose again.
    let again = stderr_text(&package.run(&["gen", "--cache", "cache"])?);
    ensure(
        again.contains("unused-import") && again.contains("small.wesl:2:32"),
        format!("the second run does not print `unused-import` at small.wesl:2:32: {again}"),
    )?;
    let seconds = second["seconds"].as_f64().unwrap_or(f64::MAX);
    // An optimised build on an idle machine takes a hundredth of this bound.
    ensure(seconds < 1.0, format!("a run with nothing to do took {seconds} s"))?;
    package.write("lamplight.toml", &format!("{MANIFEST}\n# a comment\n"))?;
    let third = package.generate(&[])?;
    equal((&third["up_to_date"], compiled(&third)), (&Value::Bool(false), 0))
}

/// An edit compiles the texts that it changes and no others.
fn edits() -> Outcome {
    let package = Package::new()?;
    package.generate(&[])?;
    // `green` is in the fragment shaders of four permutations.
    package.write("tint.wesl", &TINT.replace("0.0, 1.0, 0.0", "0.0, 0.5, 0.0"))?;
    equal(compiled(&package.generate(&[])?), 4)?;
    // `shade` is in the fragment shaders of six permutations.
    package.write("shade.wesl", &SHADE.replace("steps + 1", "steps + 2"))?;
    equal(compiled(&package.generate(&[])?), 6)?;
    // The edit is in one of the two GLSL texts.
    package.write("small.vert.glsl", &VERTEX.replace("position, 2.0", "position, 3.0"))?;
    equal(compiled(&package.generate(&[])?), 1)?;
    // The first version of this file comes back, so the cache has all texts but those two that also
    // contain the edited `shade`.
    package.write("tint.wesl", TINT)?;
    equal(compiled(&package.generate(&[])?), 2)
}

/// Edits of functions that nothing calls, and of comments and layout, compile nothing and leave the
/// bundle as it is.
fn unreached() -> Outcome {
    let package = Package::new()?;
    package.generate(&[])?;
    let before = package.files("bundle")?;
    package.write("shade.wesl", &SHADE.replace("return 1.0", "return 2.0"))?;
    let second = package.generate(&[])?;
    equal((&second["up_to_date"], compiled(&second)), (&Value::Bool(false), 0))?;
    // These edits change only comments and layout, of functions that are called.
    package.write(
        "tint.wesl",
        &TINT.replace("fn red", "/* Of /* all */ colours. */ fn red // the first\n"),
    )?;
    package.write(
        "small.vert.glsl",
        &VERTEX.replace("void main() {", "// Where it is.\nvoid main( /* nothing */ ) {\n\n"),
    )?;
    let third = package.generate(&[])?;
    equal((&third["up_to_date"], compiled(&third)), (&Value::Bool(false), 0))?;
    equal(package.files("bundle")?, before)
}

/// The bundle has the same bytes from an empty cache, from a full one, and without a cache.
fn caching() -> Outcome {
    let package = Package::new()?;
    package.generate(&["-o", "first"])?;
    equal(compiled(&package.generate(&["-o", "second"])?), 0)?;
    ensure(
        package.run(&["gen", "--no-cache", "-o", "third"])?.status.success(),
        "`gen --no-cache` failed",
    )?;
    equal(package.files("first")?, package.files("second")?)?;
    equal(package.files("first")?, package.files("third")?)
}

/// Every record of the cache with a flipped bit is noticed and made again.
fn damage() -> Outcome {
    let package = Package::new()?;
    package.generate(&["-o", "first"])?;
    for name in package.files("cache")?.keys() {
        let path = package.path().join("cache").join(name);
        let mut bytes = fs::read(&path)?;
        let last = bytes.len() - 1;
        bytes[last] ^= 1;
        fs::write(path, bytes)?;
    }
    equal(compiled(&package.generate(&["-o", "second"])?), TEXTS)?;
    equal(package.files("first")?, package.files("second")?)?;
    equal(compiled(&package.generate(&["-o", "third"])?), 0)
}

/// A blob that was deleted from the bundle is written again from the cache.
fn lost_blobs() -> Outcome {
    let package = Package::new()?;
    package.generate(&[])?;
    let before = package.files("bundle")?;
    let blob = fs::read_dir(package.path().join("bundle/blobs"))?.next().ok_or("no blob")??.path();
    fs::remove_file(blob)?;
    equal(compiled(&package.generate(&[])?), 0)?;
    equal(package.files("bundle")?, before)
}

/// Errors are cached too. A run that takes them from the cache prints the same text, or the new
/// place if lines have moved.
fn mistakes() -> Outcome {
    let package = Package::new()?;
    let wrong = TINT.replace("0.0, 0.0, 1.0, 1.0", "0.0, 0.0, true, 1.0");
    package.write("tint.wesl", &wrong)?;
    let run = |place: &str| -> Result<String, Failed> {
        let output = package.run(&["--diagnostics", "short", "gen", "--cache", "cache"])?;
        let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
        equal(output.status.code(), Some(1))?;
        equal(stderr.matches(place).count(), 1)
            .map_err(|_| Failed::from(format!("expected one error at {place}: {stderr}")))?;
        Ok(stderr)
    };
    let first = run("tint.wesl:3:")?;
    ensure(
        package.files("cache")?.keys().any(|name| name.starts_with("errors/")),
        "the cache has no record of the errors",
    )?;
    equal(run("tint.wesl:3:")?, first)?;
    package.write("tint.wesl", &format!("\n// Moved down.\n{wrong}"))?;
    run("tint.wesl:5:")?;
    package.write("tint.wesl", TINT)?;
    package.generate(&[])?;
    Ok(())
}

/// `gen --check` ends with 3 if the bundle is not up to date, and never changes it.
fn check() -> Outcome {
    let package = Package::new()?;
    package.generate(&[])?;
    let run =
        || Ok::<_, Failed>(package.run(&["gen", "--check", "--cache", "cache"])?.status.code());
    equal(run()?, Some(0))?;
    package.write("tint.wesl", &TINT.replace("0.0, 1.0, 0.0", "0.0, 0.5, 0.0"))?;
    let before = package.files("bundle")?;
    equal(run()?, Some(3))?;
    equal(package.files("bundle")?, before)?;
    package.generate(&[])?;
    equal(run()?, Some(0))
}

/// Options limit a run to one program, permutation and target. Unknown names are refused.
fn choices() -> Outcome {
    let package = Package::new()?;
    let summary = package.generate(&[
        "--program",
        "small",
        "--only",
        "tint=blue,shaded",
        "--target",
        "wgsl",
    ])?;
    equal(summary["programs"][0]["permutations"].as_u64(), Some(1))?;
    equal(summary["targets"].as_array().map(Vec::len), Some(1))?;
    equal(package.run(&["gen", "--program", "smal"])?.status.code(), Some(1))?;
    equal(package.run(&["gen", "--only", "tint=purple"])?.status.code(), Some(1))
}
