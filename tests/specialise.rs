//! Axes of the mode `spec`, whose value is chosen when the pipeline is made. Every target has one
//! shader for all their values.

mod drawing;

use std::path::Path;
use std::process::Command;

use lamplight::bundle::{Bundle, Convention, Found, SpirvForm, Target, pack};
use lamplight::diagnostic::render::{Form, render};
use lamplight::emit::targets;
use lamplight::generate::{Request, in_memory};
use lamplight::project;
use lamplight::source::SourceSet;
use libtest_mimic::{Failed, Trial};

use drawing::Drawing;

type Outcome = Result<(), Failed>;
type Case = (&'static str, fn() -> Outcome);

const MANIFEST: &str = r#"
[program.spec]
wesl = "spec.wesl"
[program.spec.axis]
taps = { values = [5, 9, 16], default = 9, mode = "spec" }
negative = { values = [false, true], mode = "spec" }
tint = { values = ["red", "green"] }
"#;

const TEXT: &str = "
fn weight(i: i32) -> f32 {
    return f32(i + constants::taps * 2);
}
@fragment fn fs_main(@location(0) x: f32) -> @location(0) vec4f {
    var sum = 0.0;
    for (var i = 0; i < constants::taps; i++) { sum += weight(i); }
    if constants::negative { sum = -sum; }
    @if(tint == red) { return vec4f(sum, x, 0.0, 1.0); }
    @else { return vec4f(0.0, sum, x, 1.0); }
}";

pub fn tests() -> Vec<Trial> {
    let cases: [Case; 8] = [
        ("values_arrive", values),
        ("one_shader_for_all_values", shared),
        ("spirv", spirv),
        ("glsl", glsl),
        ("texts", texts),
        ("static_in_glsl_sources", static_in_glsl),
        ("constants_of_glsl", constants_of_glsl),
        ("usage_lists_narrow_a_manifest", usage),
    ];
    cases.into_iter().map(|(name, case)| Trial::test(format!("specialise::{name}"), case)).collect()
}

fn bundle_of(folder: &Path) -> Result<Bundle, Failed> {
    let mut sources = SourceSet::default();
    let made = (|| {
        let manifest = project::read_manifest(&folder.join("lamplight.toml"), &mut sources)?;
        let packages = project::packages(folder, &mut sources)?;
        in_memory(&mut sources, &packages, &manifest, &Request::default(), &|_| ())
    })();
    let made = made.map_err(|problems| render(&sources, &problems, Form::Human))?;
    Ok(Bundle::from_bytes(pack(&made.contents)?)?)
}

fn bundle() -> Result<Bundle, Failed> {
    let folder = tempfile::tempdir()?;
    std::fs::write(folder.path().join("lamplight.toml"), MANIFEST)?;
    std::fs::write(folder.path().join("spec.wesl"), TEXT)?;
    bundle_of(folder.path())
}

fn found(key: &str, target: Target) -> Result<Found, Failed> {
    Ok(bundle()?.program("spec")?.shader("fs_main")?.get(key, target)?)
}

fn check(condition: bool, what: &str) -> Outcome {
    if condition { Ok(()) } else { Err(what.into()) }
}

/// Keys that differ only in `spec` axes share a shader, and the bundle has their values as constants.
fn shared() -> Outcome {
    let bundle = bundle()?;
    let shader = bundle.program("spec")?.shader("fs_main")?;
    let keys = shader.keys()?;
    let mut units = keys.iter().map(|key| shader.find(key)).collect::<Result<Vec<_>, _>>()?;
    units.sort_unstable();
    units.dedup();
    check(
        keys.len() == 12 && units.len() == 2,
        &format!("{} keys, {} shaders, expected 12 and 2", keys.len(), units.len()),
    )?;
    for target in Target::ALL {
        let found = shader.get("taps=16,negative", *target)?;
        let values: Vec<String> = found
            .constants
            .iter()
            .map(|constant| format!("{}={}", constant.name, constant.value))
            .collect();
        let what = format!("{target}: expected negative=true and taps=16, found {values:?}");
        check(values == ["negative=true", "taps=16"], &what)?;
        let mut choices: Vec<&str> =
            found.native.choices.iter().map(|choice| choice.name.as_str()).collect();
        choices.sort_unstable();
        let what = format!("{target}: expected choices for negative and taps, found {choices:?}");
        check(choices == ["negative", "taps"], &what)?;
    }
    Ok(())
}

/// Runs a tool, which must succeed, and gives its output.
fn run(tool: &str, arguments: &[&str]) -> Result<String, Failed> {
    let output =
        Command::new(tool).args(arguments).output().map_err(|error| format!("{tool}: {error}"))?;
    let printed = String::from_utf8_lossy(&[output.stdout, output.stderr].concat()).into_owned();
    if output.status.success() { Ok(printed) } else { Err(format!("{tool}: {printed}").into()) }
}

/// The id of the specialisation constant of an axis.
fn choice_id(found: &Found, name: &str) -> Option<u32> {
    found.native.choices.iter().find(|choice| choice.name == name).and_then(|choice| choice.id)
}

/// In SPIR-V the axes are specialisation constants. spirv-opt can set them by the ids in the
/// reflection, and the result is valid.
fn spirv() -> Outcome {
    let found = found("default", Target::SPIRV)?;
    let folder = tempfile::tempdir()?;
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    std::fs::write(path("a.spv"), &found.bytes)?;
    run("spirv-val", &["--target-env", "vulkan1.1", &path("a.spv")])?;
    let id = |name: &str| choice_id(&found, name).ok_or("no id");
    let chosen = format!("{}:16 {}:true", id("taps")?, id("negative")?);
    run(
        "spirv-opt",
        &[
            "--set-spec-const-default-value",
            &chosen,
            "--freeze-spec-const",
            "-O",
            &path("a.spv"),
            "-o",
            &path("b.spv"),
        ],
    )?;
    run("spirv-val", &["--target-env", "vulkan1.1", &path("b.spv")])?;
    let text = run("spirv-dis", &["--raw-id", &path("a.spv")])?;
    check(
        text.matches("OpSpecConstant").count() == 2 && text.matches("SpecId").count() == 2,
        &format!("expected two specialisation constants in\n{text}"),
    )?;
    check(
        !text.lines().any(|line| line.contains("OpVariable") && line.contains("Private")),
        &format!("expected no private variables in\n{text}"),
    )?;
    let text = run("spirv-dis", &["--raw-id", &path("b.spv")])?;
    let what = format!("expected no specialisation constants once they are frozen in\n{text}");
    check(!text.contains("OpSpecConstant"), &what)
}

/// The bundle in each form of SPIR-V, as the command writes it.
fn bundles_of_forms() -> Result<Vec<(&'static str, Bundle)>, Failed> {
    let folder = tempfile::tempdir()?;
    std::fs::write(folder.path().join("lamplight.toml"), MANIFEST)?;
    std::fs::write(folder.path().join("spec.wesl"), TEXT)?;
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let bundle = |form: &'static str| {
        let (manifest, out) = (path("lamplight.toml"), path(&format!("{form}.lamplight")));
        let places = ["--manifest", &manifest, "-o", &out, "--no-cache"];
        let options = ["gen", "--target", "spirv", "--spirv", form];
        run(env!("CARGO_BIN_EXE_lamplight"), &[&options[..], &places[..]].concat())?;
        Ok((form, Bundle::from_bytes(std::fs::read(&out)?)?))
    };
    SpirvForm::names().map(bundle).collect()
}

/// The pixel of a drawn shader has the value that was chosen, by the override in WGSL and by the
/// specialisation constant in SPIR-V of every form.
fn values() -> Outcome {
    let device = Drawing::open()?;
    let forms = bundles_of_forms()?;
    for (key, expected) in [("default", 198.0), ("taps=5", 60.0), ("negative,taps=16", -632.0)] {
        let found = found(key, Target::WGSL)?;
        let number = |value: &str| value.parse().unwrap_or(f64::from(u8::from(value == "true")));
        let constants: Vec<(&str, f64)> = found
            .constants
            .iter()
            .map(|constant| (constant.name.as_str(), number(&constant.value)))
            .collect();
        let source = wgpu::ShaderSource::Wgsl(std::str::from_utf8(&found.bytes)?.into());
        let module = device
            .device
            .create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
        let drawn = device.draw(&module, &constants)?;
        let what = format!("WGSL {key}: expected {expected}, found {drawn:?}");
        check(drawn == [expected, 1.0, 0.0, 1.0], &what)?;
        for (form, bundle) in &forms {
            let found = bundle.program("spec")?.shader("fs_main")?.get(key, Target::SPIRV)?;
            let drawn = device.draw(&device.chosen(&found)?, &[])?;
            let what = format!("SPIR-V, {form}, {key}: expected {expected}, found {drawn:?}");
            check(drawn == [expected, 1.0, 0.0, 1.0], &what)?;
        }
    }
    Ok(())
}

/// In GLSL the axes are macros with defaults. The text compiles with the defaults and with other
/// values.
fn glsl() -> Outcome {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("a.frag").to_string_lossy().into_owned();
    for entry in targets::ALL.iter().filter(|entry| entry.glsl.is_some()) {
        let found = found("default", entry.target)?;
        let text = String::from_utf8(found.bytes)?;
        let (version, rest) = text.split_once('\n').ok_or("no lines")?;
        for chosen in ["", "#define LAMPLIGHT_TAPS 16\n#define LAMPLIGHT_NEGATIVE 1\n"] {
            std::fs::write(&path, format!("{version}\n{chosen}{rest}"))?;
            run("glslangValidator", &["-S", "frag", &path])?;
        }
    }
    Ok(())
}

/// The texts with these axes are those of the snapshots.
fn texts() -> Outcome {
    for target in [Target::WGSL, Target::GLSL330, Target::HLSL, Target::MSL] {
        let text = String::from_utf8(found("default", target)?.bytes)?;
        crate::snapshot::check("specialise", target.name(), &text)?;
    }
    Ok(())
}

/// A GLSL source is composed for each value of a `spec` axis, and `variants` says so.
fn static_in_glsl() -> Outcome {
    let folder = tempfile::tempdir()?;
    let manifest = MANIFEST.replace(
        "wesl = \"spec.wesl\"",
        "glsl = { fragment = \"spec.frag.glsl\" }\ntargets = [\"glsl450\"]",
    );
    std::fs::write(folder.path().join("lamplight.toml"), manifest)?;
    let text =
        "#version 450\nlayout(location = 0) out vec4 c;\nvoid main() { c = vec4(float(TAPS)); }\n";
    std::fs::write(folder.path().join("spec.frag.glsl"), text)?;
    let bundle = bundle_of(folder.path())?;
    let shader = bundle.program("spec")?.shader("fragment")?;
    for (key, value) in [("default", "9"), ("taps=16", "16")] {
        let found = shader.get(key, Target::GLSL450)?;
        let text = String::from_utf8(found.bytes)?;
        check(
            found.constants.is_empty() && found.native.choices.is_empty() && text.contains(value),
            &format!("`{key}`: expected no constants, and {value} in\n{text}"),
        )?;
    }
    let manifest = folder.path().join("lamplight.toml").to_string_lossy().into_owned();
    let printed = run(env!("CARGO_BIN_EXE_lamplight"), &["variants", "--manifest", &manifest])?;
    let words = "static in GLSL, which is composed for each value: negative, taps";
    check(printed.contains(words), &format!("expected `{words}` in\n{printed}"))
}

/// A function of GLSL may use a specialisation constant: the outputs declare it, and Metal passes it
/// along.
fn constants_of_glsl() -> Outcome {
    let folder = tempfile::tempdir()?;
    let manifest = "[program.spec]\nglsl = { fragment = \"spec.frag\" }\n";
    std::fs::write(folder.path().join("lamplight.toml"), manifest)?;
    let text = "#version 450\nlayout(constant_id = 3) const float GAIN = 4.0;\n\
                layout(location = 0) in vec4 v;\nlayout(location = 0) out vec4 c;\n\
                vec4 gained(vec4 x) { return x * GAIN; }\nvoid main() { c = gained(v) + GAIN; }\n";
    std::fs::write(folder.path().join("spec.frag"), text)?;
    let bundle = bundle_of(folder.path())?;
    let shader = bundle.program("spec")?.shader("fragment")?;
    let text = |target| Ok::<_, Failed>(String::from_utf8(shader.get("default", target)?.bytes)?);
    let wgsl = text(Target::WGSL)?;
    naga::front::wgsl::parse_str(&wgsl).map_err(|error| error.emit_to_string(&wgsl))?;
    check(wgsl.contains("@id(3) override GAIN: f32 = 4f;"), &wgsl)?;
    let msl = text(Target::MSL)?;
    let has = |part: &str| msl.contains(part);
    let is_passed = ["gained(", "main_1_("].iter().all(|call| {
        let calls = msl.lines().filter(|line| line.contains(call) && line.ends_with(';'));
        calls.into_iter().all(|line| line.contains("lamplight_GAIN_open"))
    });
    check(has("[[function_constant(3)]]") && is_passed, &msl)
}

/// With a usage list, exactly its keys are generated. Keys and programs that do not exist any more
/// give warnings.
fn usage() -> Outcome {
    let folder = tempfile::tempdir()?;
    let used = "spec tint=green\nspec taps=16\nspec gone=1\nspec tint=mauve\nother x\n";
    std::fs::write(
        folder.path().join("lamplight.toml"),
        MANIFEST.replace("wesl =", "usage = \"spec.used\"\nwesl ="),
    )?;
    std::fs::write(folder.path().join("spec.wesl"), TEXT)?;
    std::fs::write(folder.path().join("spec.used"), used)?;
    let keys = bundle_of(folder.path())?.program("spec")?.shader("fs_main")?.keys()?;
    let what = format!("expected the keys taps=16 and tint=green, found {keys:?}");
    check(keys == ["taps=16", "tint=green"], &what)?;
    let mut sources = SourceSet::default();
    let manifest = project::read_manifest(&folder.path().join("lamplight.toml"), &mut sources)
        .map_err(|_| "no manifest")?;
    let warnings: Vec<&str> =
        manifest.warnings.iter().map(|warning| warning.message.as_str()).collect();
    let names = ["`gone=1`", "`tint=mauve`", "no program `other`"];
    let all = warnings.len() == 3
        && warnings.iter().zip(names).all(|(warnings, name)| warnings.contains(name));
    check(all, &format!("expected a warning for each of {names:?}, found {warnings:?}"))
}
