//! An output depends on its sources, its settings and its target only. So every way to make a bundle
//! gives the same bytes, names and reflection.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use lamplight::bundle::{Bundle, Target};
use libtest_mimic::{Failed, Trial};
use tempfile::TempDir;

type Outcome = Result<(), Failed>;

/// A test and its name.
type Case = (&'static str, fn() -> Outcome);

/// The longest wait for `watch`.
const PATIENCE: Duration = Duration::from_secs(30);

const MANIFEST: &str = r#"
[program.surface]
wesl = "surface.wesl"
glsl = { fragment = "surface.frag.glsl" }
[program.surface.axis]
warm = { values = [false, true] }
shape = { values = ["point", "spot", "both"] }
"#;

/// A shader with names that naga's writers use, with helpers that they add, and with a structure that
/// only some permutations return.
const SURFACE: &str = "
import package::light::{falloff, cone};
struct Pair { @location(0) other: vec4f, @location(1) value: vec2f }
@group(0) @binding(0) var<uniform> ret: vec4f;
const ConstructPair: f32 = 0.5;
fn filled(at: f32) -> Pair { return Pair(ret * at, modf(vec2f(at, ConstructPair)).fract); }
@if(warm) @fragment fn main_1(@location(0) at: vec3f) -> Pair { return filled(falloff(at.x)); }
@else @fragment fn main_1(@location(0) at: vec3f) -> @location(0) vec4f {
    var sum = 0.0;
    @if(shape != spot) sum += falloff(at.x);
    @if(shape != point) sum += cone(at.y, i32(at.z));
    return filled(sum).other;
}
@vertex fn vs_main(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(f32(index % 3u));
}
";
const LIGHT: &str = "fn falloff(d: f32) -> f32 { return 1.0 / (1.0 + d); }
fn cone(c: f32, n: i32) -> f32 { return falloff(c) * f32(n / 3); }
";
const FRAGMENT: &str = "#version 450
layout(location = 0) in vec3 at;
layout(location = 0) out vec4 other;
float value(float x) { return mod(x, 2.0); }
void main() {
#if WARM
    other = vec4(value(at.x));
#else
    other = vec4(at, float(int(at.x) / 3));
#endif
}
";

pub fn tests() -> Vec<Trial> {
    let cases: [Case; 5] = [
        ("one_permutation", one_permutation),
        ("one_target", one_target),
        ("shards_merged", shards_merged),
        ("cache", cache),
        ("watch", watch),
    ];
    cases.map(|(name, case)| Trial::test(format!("one_meaning::{name}"), case)).into()
}

struct Package(TempDir);

/// The outputs of a bundle, by program, language, entry point, key and target.
type Meaning = BTreeMap<(String, String, String, String, String), String>;

impl Package {
    fn new() -> Result<Self, Failed> {
        let package = Self(tempfile::tempdir()?);
        for (name, text) in [
            ("lamplight.toml", MANIFEST),
            ("surface.wesl", SURFACE),
            ("light.wesl", LIGHT),
            ("surface.frag.glsl", FRAGMENT),
        ] {
            fs::write(package.0.path().join(name), text)?;
        }
        Ok(package)
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_lamplight"));
        command.args(arguments).current_dir(self.0.path()).stdout(Stdio::null());
        command
    }

    fn run(&self, arguments: &[&str]) -> Outcome {
        let output = self.command(arguments).output()?;
        match output.status.success() {
            true => Ok(()),
            false => Err(String::from_utf8_lossy(&output.stderr).into_owned().into()),
        }
    }

    /// All outputs of a bundle of the package.
    fn meaning(&self, name: &str) -> Result<Meaning, Failed> {
        meaning(&self.0.path().join(name))
    }

    /// The outputs of a run without a cache.
    fn whole(&self) -> Result<Meaning, Failed> {
        self.run(&["gen", "--no-cache", "-o", "whole"])?;
        let whole = self.meaning("whole")?;
        // Six permutations of three entry points in seven targets.
        match whole.len() == 6 * 3 * Target::ALL.len() {
            true => Ok(whole),
            false => Err(format!("found {} outputs, expected 126", whole.len()).into()),
        }
    }
}

fn meaning(path: &Path) -> Result<Meaning, Failed> {
    let bundle = Bundle::open(path)?;
    let mut found = Meaning::new();
    for name in bundle.programs() {
        let program = bundle.program(name)?;
        for (language, entry) in program.entries() {
            let shader = program.entry(language, entry)?;
            for key in shader.keys()? {
                for target in Target::ALL {
                    let Ok(output) = shader.get(&key, *target) else { continue };
                    let language = format!("{language:?}");
                    let place =
                        (name.into(), language, entry.into(), key.clone(), target.to_string());
                    let all =
                        format!("{:?} {:?} {:?}", output.bytes, output.native, output.reflection);
                    found.insert(place, all);
                }
            }
        }
    }
    Ok(found)
}

/// Fails, with the place of the call, unless `all` has every output of `some`, of which there are at
/// least `least`.
#[track_caller]
fn within(some: &Meaning, all: &Meaning, least: usize) -> Outcome {
    let caller = std::panic::Location::caller();
    if some.len() < least {
        return Err(format!("{caller}: {} outputs, expected {least}", some.len()).into());
    }
    match some.iter().find(|(place, output)| all.get(*place) != Some(output)) {
        Some((place, _)) => Err(format!("{caller}: differs from the whole run: {place:?}").into()),
        None => Ok(()),
    }
}

/// `gen --only` gives the outputs of the whole run.
fn one_permutation() -> Outcome {
    let package = Package::new()?;
    let whole = package.whole()?;
    let keys: std::collections::BTreeSet<&String> = whole.keys().map(|place| &place.3).collect();
    for key in keys {
        let _ = fs::remove_dir_all(package.0.path().join("one"));
        package.run(&["gen", "--no-cache", "--program", "surface", "--only", key, "-o", "one"])?;
        within(&package.meaning("one")?, &whole, 3 * Target::ALL.len())?;
    }
    Ok(())
}

/// `gen --target` gives the outputs of the whole run.
fn one_target() -> Outcome {
    let package = Package::new()?;
    let whole = package.whole()?;
    for target in Target::ALL {
        package.run(&["gen", "--no-cache", "--target", target.name(), "-o", target.name()])?;
        within(&package.meaning(target.name())?, &whole, 6 * 3)?;
    }
    Ok(())
}

/// Shards that are merged give the outputs of the whole run.
fn shards_merged() -> Outcome {
    let package = Package::new()?;
    let whole = package.whole()?;
    for shard in ["1/3", "2/3", "3/3"] {
        let out = format!("shard{}", &shard[..1]);
        package.run(&["gen", "--no-cache", "--shard", shard, "-o", &out])?;
    }
    package.run(&[
        "merge",
        "merged",
        "shard2",
        "shard3",
        "shard1",
        "--manifest",
        "lamplight.toml",
    ])?;
    within(&package.meaning("merged")?, &whole, whole.len())
}

/// Runs with a cache that is partly or wholly filled give the outputs of the whole run.
fn cache() -> Outcome {
    let package = Package::new()?;
    let whole = package.whole()?;
    // The second run finds one target in the cache, and the third run finds all of them.
    package.run(&["gen", "--cache", "cache", "--target", "hlsl", "-o", "part"])?;
    package.run(&["gen", "--cache", "cache", "-o", "filled"])?;
    package.run(&["gen", "--cache", "cache", "-o", "hit"])?;
    within(&package.meaning("filled")?, &whole, whole.len())?;
    within(&package.meaning("hit")?, &whole, whole.len())
}

fn watch() -> Outcome {
    let package = Package::new()?;
    package.run(&["gen", "--no-cache"])?;
    let mut child =
        package.command(&["watch", "--cache", "cache"]).stderr(Stdio::null()).spawn()?;
    let outcome = followed(&package);
    child.kill()?;
    child.wait()?;
    outcome
}

/// After an edit, the bundle of `watch` becomes that of a fresh run.
fn followed(package: &Package) -> Outcome {
    let edited = LIGHT.replace("1.0 + d", "2.0 + d");
    fs::write(package.0.path().join("light.wesl"), edited)?;
    let fresh = package.whole()?;
    let start = Instant::now();
    loop {
        let same = package.meaning("bundle").and_then(|found| within(&found, &fresh, fresh.len()));
        match same {
            Ok(()) => return Ok(()),
            Err(error) if start.elapsed() > PATIENCE => return Err(error),
            Err(_) => std::thread::sleep(Duration::from_millis(100)),
        }
    }
}
