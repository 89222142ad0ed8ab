//! The forms of SPIR-V: what each keeps, and that another optimiser is never taken for this one. What
//! they compute is drawn by `frames::shipped` and `specialise`.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use lamplight::bundle::{Bundle, Found, Native, Target, blob_files};
use lamplight::emit::spirv::{instructions, op, words};
use lamplight::validators::{self, Extent, Tint, verdict};
use libtest_mimic::{Failed, Trial};

use crate::validators::{Package, expect};

type Outcome = Result<(), Failed>;
type Case = (&'static str, fn() -> Outcome);

pub fn tests() -> Vec<Trial> {
    let cases: [Case; 5] = [
        ("each_keeps_what_hosts_need", contents),
        ("the_manifest_chooses", in_manifest),
        ("the_same_bytes_twice", same_bytes),
        ("another_version_makes_new_outputs", other_version),
        ("without_the_program_nothing_is_written", missing_program),
    ];
    cases
        .into_iter()
        .map(|(name, case)| Trial::test(format!("spirv_forms::{name}"), case))
        .collect()
}

const MANIFEST: &str = r#"
[program.one]
wesl = "one.wesl"
targets = ["spirv", "wgsl"]
[program.one.axis]
taps = { values = [4, 8], mode = "spec" }
lit = { values = [false, true] }
"#;

/// It has a uniform block with an array, a texture, a sampler, a binding that only dead code reads
/// once the optimiser has seen it, and a constant that pipelines choose.
const SHADER: &str = "
struct Screen { exposure: f32, steps: array<vec4f, 2> }
@group(0) @binding(0) var<uniform> screen: Screen;
@group(0) @binding(1) var image: texture_2d<f32>;
@group(1) @binding(2) var image_sampler: sampler;
@group(1) @binding(3) var<uniform> unseen: vec4f;
fn weighted(color: vec4f, weight: f32) -> vec4f { return color * weight; }
@fragment fn fs_main(@location(3) uv: vec2f) -> @location(0) vec4f {
    var sum = vec4f(0.0);
    for (var i = 0; i < constants::taps; i++) {
        let place = uv + f32(i) * screen.steps[1].xy;
        sum += weighted(textureSampleLevel(image, image_sampler, place, 0.0), screen.exposure);
    }
    @if(lit) { sum += 0.0 * vec4f(sum.xyz, 1.0); }
    if false { sum += unseen; }
    return sum / f32(constants::taps);
}
";

const FORMS: [&str; 3] = ["names", "stripped", "optimised"];

fn package() -> Result<Package, Failed> {
    Package::new(MANIFEST, SHADER)
}

/// Runs `gen` with a form into a place of the same name, which must succeed.
fn generate(package: &Package, form: &str, more: &[&str]) -> Result<Output, Failed> {
    let all = [&["gen", "--spirv", form, "-o", form, "--no-cache"], more].concat();
    let output = package.run(&all)?;
    expect(&output, 0, &[])?;
    Ok(output)
}

fn found(bundle: &Bundle, key: &str) -> Result<Found, Failed> {
    Ok(bundle.program("one")?.shader("fs_main")?.get(key, Target::SPIRV)?)
}

/// The decorations by which a host binds: of descriptors, locations and constants, without the ids.
fn decorations(module: &[u8]) -> Vec<[u32; 2]> {
    const HOSTS: [u32; 4] = [1, 30, 33, 34];
    let words = words(module);
    let found = instructions(&words).filter_map(|one| match one.words {
        [_, _, decoration, value] if one.op == op::DECORATE && HOSTS.contains(decoration) => {
            Some([*decoration, *value])
        }
        _ => None,
    });
    let mut found: Vec<[u32; 2]> = found.collect();
    found.sort_unstable();
    found
}

fn counted(module: &[u8], wanted: &[u16]) -> usize {
    let words = words(module);
    instructions(&words).filter(|one| wanted.contains(&one.op)).count()
}

/// Every form has the same bindings, locations and constants, the validators and the comparison with
/// the reflection accept it as a directory and as a file, and only the first has names. What is
/// optimised is smaller. Tint is not asked: its package comes from npm.
fn contents() -> Outcome {
    let package = package()?;
    let mut outputs = BTreeMap::new();
    for form in FORMS {
        generate(&package, form, &[])?;
        validated(&package.path(form))?;
        let file = format!("{form}.lamplight");
        expect(&package.run(&["bundle", "pack", form, "-o", &file])?, 0, &[])?;
        for place in [form, &file] {
            expect(&package.run(&["bundle", "verify", place])?, 0, &["is intact"])?;
            let bundle = Bundle::open(package.path(place))?;
            let found = found(&bundle, "lit,taps=8")?;
            let choices: Vec<&str> =
                found.native.choices.iter().map(|choice| choice.name.as_str()).collect();
            ensure(choices == ["taps"], format!("{place}: {choices:?}"))?;
            let known = outputs.entry(form).or_insert_with(|| found.clone());
            ensure(*known == found, format!("{place} has another output than the directory"))?;
        }
    }
    let [names, stripped, optimised] = FORMS.map(|form| &outputs[form]);
    for (form, found) in FORMS.iter().zip([names, stripped, optimised]) {
        ensure(
            decorations(&found.bytes) == decorations(&names.bytes),
            format!("{form} has other bindings, locations or constants"),
        )?;
        let is_named = counted(&found.bytes, &op::DEBUG) > 0;
        ensure(is_named == (*form == "names"), format!("names in {form}: {is_named}"))?;
        let native = Native { optimiser: None, ..(*found.native).clone() };
        ensure(native == *names.native, format!("{form} has another native reflection"))?;
        let is_named_there =
            found.native.optimiser.as_ref().is_some_and(|one| one.contains("spirv-opt"));
        ensure(
            is_named_there == (*form == "optimised"),
            format!("optimiser of {form}: {is_named_there}"),
        )?;
    }
    let functions = |found: &Found| counted(&found.bytes, &[op::FUNCTION]);
    ensure(
        functions(optimised) == 1 && functions(stripped) == functions(names),
        "expected one function in what is optimised, and as many as before in what is stripped",
    )?;
    let sizes = [names, stripped, optimised].map(|found| found.bytes.len());
    ensure(sizes[0] > sizes[1] && sizes[1] > sizes[2], format!("sizes {sizes:?}"))
}

/// The validators but Tint, and the comparison with the reflection, accept all outputs of a bundle.
fn validated(bundle: &Path) -> Outcome {
    let tint = Tint::at(bundle.join("no-tint"));
    let outputs = validators::outputs(blob_files(bundle)?)?;
    let found = verdict(outputs, Extent::All, None, &tint, &|_, _| ())?;
    ensure(found.refusals.is_empty(), format!("{:?}", found.refusals))?;
    for target in &found.validation.targets {
        let what = format!("{}: {} of {}", target.target, target.now, target.outputs);
        ensure(target.outputs > 0 && target.now == target.outputs, what)?;
    }
    let missing = found.validation.missing();
    ensure(missing.iter().all(|one| one.contains("Tint")), format!("{missing:?}"))
}

fn ensure(holds: bool, message: impl Into<String>) -> Outcome {
    if holds { Ok(()) } else { Err(message.into().into()) }
}

/// The key of a program does what the option does, `compile` gives the bytes of `gen`, and a name
/// that is none is refused.
fn in_manifest() -> Outcome {
    for form in FORMS {
        let manifest = MANIFEST.replace("targets", &format!("spirv = \"{form}\"\ntargets"));
        let (chosen, asked) = (Package::new(&manifest, SHADER)?, package()?);
        expect(&chosen.run(&["gen", "--no-cache"])?, 0, &[])?;
        generate(&asked, form, &[])?;
        let [of_manifest, of_option] =
            [chosen.path("bundle"), asked.path(form)].map(|path| manifest_text(&path));
        ensure(of_manifest? == of_option?, format!("{form}: the manifest gives other outputs"))?;
        let arguments = ["compile", "one.wesl", "--target", "spirv", "-o", "compiled"];
        expect(&chosen.run(&arguments)?, 0, &[])?;
        let compiled = fs::read(chosen.path("compiled/one.fs_main.frag.spv"))?;
        let bundle = Bundle::open(chosen.path("bundle"))?;
        ensure(
            found(&bundle, "default")?.bytes == compiled,
            format!("{form}: `compile` gives other bytes than `gen`"),
        )?;
    }
    let manifest = MANIFEST.replace("targets", "spirv = \"small\"\ntargets");
    let package = Package::new(&manifest, SHADER)?;
    expect(&package.run(&["gen"])?, 1, &["unknown-spirv", "optimised"])
}

fn manifest_text(bundle: &Path) -> Result<String, Failed> {
    Ok(fs::read_to_string(bundle.join("manifest.json"))?)
}

/// A run gives the bytes of any other run, with one thread or with several.
fn same_bytes() -> Outcome {
    let package = package()?;
    for form in FORMS {
        let mut texts = Vec::new();
        for (place, threads) in [("a", "1"), ("b", "4")] {
            let arguments = ["gen", "--spirv", form, "-o", place, "--no-cache", "--force"];
            let mut command = package.command(&arguments);
            expect(&command.env("RAYON_NUM_THREADS", threads).output()?, 0, &[])?;
            texts.push(manifest_text(&package.path(place))?);
        }
        ensure(texts[0] == texts[1], format!("{form}: two runs differ"))?;
    }
    Ok(())
}

/// A folder with a program `spirv-opt` that calls the real one, and prints another version.
fn other_optimiser(package: &Package, version: &str) -> Result<String, Failed> {
    use std::os::unix::fs::PermissionsExt;
    let folder = package.path(version);
    fs::create_dir_all(&folder)?;
    let known = std::env::var("PATH")?;
    let folders = std::env::split_paths(&known);
    let real = folders.map(|folder| folder.join("spirv-opt")).find(|path| path.is_file());
    let real: PathBuf = real.ok_or("no spirv-opt: apt-get install spirv-tools")?;
    let script = format!(
        "#!/bin/sh\nif [ \"$1\" = --version ]; then echo 'SPIRV-Tools {version}'; exit 0; fi\n\
         exec '{}' \"$@\"\n",
        real.display()
    );
    let path = folder.join("spirv-opt");
    fs::write(&path, script)?;
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755))?;
    Ok(format!("{}:{known}", folder.display()))
}

/// With the cache and the bundle of one version, a run with another version compiles everything
/// again, and the bundle names that version. A run with the same version does nothing.
fn other_version() -> Outcome {
    let package = package()?;
    let run = |path: &str| -> Result<serde_json::Value, Failed> {
        let arguments = ["gen", "--spirv", "optimised", "--json", "--cache", "kept"];
        let output = package.command(&arguments).env("PATH", path).output()?;
        expect(&output, 0, &[])?;
        Ok(serde_json::from_slice(&output.stdout)?)
    };
    let versions = ["v2030.1", "v2030.2"];
    for version in versions {
        let path = other_optimiser(&package, version)?;
        let first = run(&path)?;
        ensure(first["cached"] == 0 && first["up_to_date"] != true, format!("{first:#}"))?;
        let bundle = Bundle::open(package.path("bundle"))?;
        let optimiser = found(&bundle, "default")?.native.optimiser.clone();
        ensure(
            optimiser.as_ref().is_some_and(|found| found.contains(version)),
            format!("expected {version}, found {optimiser:?}"),
        )?;
        let second = run(&path)?;
        ensure(second["up_to_date"] == true, format!("{second:#}"))?;
    }
    // The first version finds its own outputs again.
    let third = run(&other_optimiser(&package, versions[0])?)?;
    ensure(third["cached"] == 2 && third["up_to_date"] != true, format!("{third:#}"))
}

/// Without the program, and with one that fails, commands end with exit code 4, name the package,
/// write nothing, and leave a bundle as it was. A run for other targets does not need it.
fn missing_program() -> Outcome {
    let (package, nothing) = (package()?, tempfile::tempdir()?);
    generate(&package, "stripped", &[])?;
    let before = manifest_text(&package.path("stripped"))?;
    let words = ["optimiser-failed", "apt-get install spirv-tools"];
    let gen_words = ["gen", "--spirv", "optimised", "-o", "stripped"];
    let compile = ["compile", "one.wesl", "--target", "spirv", "--spirv", "optimised", "-o", "out"];
    for arguments in [&gen_words[..], &compile[..]] {
        let output = package.command(arguments).env("PATH", nothing.path()).output()?;
        expect(&output, 4, &words)?;
    }
    let path = other_optimiser(&package, "v2030.3")?;
    fs::write(package.path("v2030.3/spirv-opt"), REFUSING)?;
    for arguments in [&gen_words[..], &compile[..]] {
        let output = package.command(arguments).env("PATH", &path).output()?;
        expect(&output, 4, &["optimiser-failed", "no such pass"])?;
    }
    ensure(!package.path("out").exists(), "an output was written")?;
    ensure(manifest_text(&package.path("stripped"))? == before, "the bundle was replaced")?;
    let others = ["gen", "--spirv", "optimised", "--target", "wgsl", "-o", "others"];
    expect(&package.command(&others).env("PATH", nothing.path()).output()?, 0, &[])
}

const REFUSING: &str = "#!/bin/sh\nif [ \"$1\" = --version ]; then echo v1.0; exit 0; fi\n\
    echo 'error: no such pass' >&2\nexit 1\n";
