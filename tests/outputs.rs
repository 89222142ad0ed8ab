//! Outputs of shaders that naga's writers get wrong without help.
//!
//! The cases of `tests/outputs/values/` have the same values on every executor. The shaders of
//! `tests/outputs/shaders/` are compiled for the targets that their manifest names, and the
//! independent validators of these targets accept them, as do the rules of browsers.

mod pointers;

use std::path::{Path, PathBuf};
use std::process::Command;

use lamplight::bundle::{Bundle, Found, Target, blob_files};
use lamplight::execute::executors;
use lamplight::validators;
use lamplight::validators::agreement::output_differences;
use libtest_mimic::{Failed, Trial};

type Outcome = Result<(), Failed>;

pub fn tests() -> Vec<Trial> {
    let executors =
        executors::ALL.iter().filter(|one| !OTHERS.contains(&one.name) && !one.reads_glsl);
    executors
        .map(|executor| {
            let name = format!("outputs::values::{}", executor.name);
            Trial::test(name, || values(executor.name))
        })
        .chain([
            Trial::test("outputs::random_pointers", pointers::random_programs),
            Trial::test("outputs::shaders_are_valid", shaders),
            Trial::test("outputs::sizes", sizes),
            Trial::test("outputs::sizes_of_spec_axes", spec_sizes),
            Trial::test("outputs::another_size_is_noticed", other_sizes),
        ])
        .collect()
}

/// Executors in a browser are slow: what they run is the WGSL that `vulkan` runs, and the GLSL of
/// `essl300`. `gl` runs the GLSL that wgpu writes itself, where GLSL leaves some results open.
const OTHERS: [&str; 3] = ["gl", "webgl2", "webgpu"];

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/outputs").join(name)
}

fn lamplight(arguments: &[&str], folder: &Path) -> Outcome {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lamplight"));
    let output = command.current_dir(folder).args(arguments).output()?;
    match output.status.success() {
        true => Ok(()),
        false => {
            let printed = [output.stdout, output.stderr].concat();
            Err(format!("{arguments:?}: {}", String::from_utf8_lossy(&printed)).into())
        }
    }
}

fn values(executor: &str) -> Outcome {
    lamplight(&["check", ".", "--executor", executor], &folder("values"))
}

fn shaders() -> Outcome {
    let bundle = generated(&folder("shaders"), &[])?;
    validated(&folder("shaders"))?;
    for_each_output(&bundle, &|name, target, found| {
        let (reflection, native) = (&found.reflection, &found.native);
        if target.name() == "wgsl" {
            let problems = lamplight_rules::check(std::str::from_utf8(&found.bytes)?);
            let refused: Vec<&str> = problems.iter().map(|problem| &*problem.message).collect();
            if !refused.is_empty() {
                return Err(format!("{name}: browsers refuse {refused:?}").into());
            }
        }
        match output_differences(target, &found.bytes, reflection, native).as_slice() {
            [] => Ok(()),
            found => Err(format!("{name} in {target}: {}", found.join("\n")).into()),
        }
    })
}

/// The validators of all targets accept what `gen` writes. Tint is not asked: its package comes
/// from npm.
fn validated(folder: &Path) -> Outcome {
    let out = tempfile::tempdir()?;
    let bundle = out.path().join("bundle");
    lamplight(&["gen", "--no-cache", "-o", &bundle.to_string_lossy()], folder)?;
    let outputs = validators::outputs(blob_files(&bundle)?)?;
    match validators::validate_outputs(&outputs, None, &|_, _| ())?.first() {
        None => Ok(()),
        Some(refusal) => Err(format!("{refusal:?}").into()),
    }
}

fn generated(folder: &Path, more: &[&str]) -> Result<Bundle, Failed> {
    let out = tempfile::tempdir()?;
    let bundle = out.path().join("bundle.lamplight");
    let path = bundle.to_string_lossy();
    let mut arguments = vec!["gen", "--no-cache", "-o", &path];
    arguments.extend(more);
    lamplight(&arguments, folder)?;
    Ok(Bundle::from_bytes(std::fs::read(&bundle)?)?)
}

fn for_each_output(bundle: &Bundle, check: &dyn Fn(&str, Target, &Found) -> Outcome) -> Outcome {
    for name in bundle.programs() {
        let program = bundle.program(name)?;
        for (language, entry) in program.entries() {
            let shader = program.entry(language, entry)?;
            for key in shader.keys()? {
                for target in shader.targets(&key)? {
                    let target = Target::find(&target).ok_or("a target without a name")?;
                    check(&format!("{name} {entry} {key}"), target, &shader.get(&key, target)?)?;
                }
            }
        }
    }
    Ok(())
}

/// What the outputs of `sizes.wesl` say about the size of a workgroup and the lengths of arrays: 8
/// is twice the default of `count`, and 4 the larger of `count` and 2.
fn sizes() -> Outcome {
    let bundle = generated(&folder("shaders"), &["--program", "sizes"])?;
    let shader = bundle.program("sizes")?.shader("cs_main")?;
    for (target, expected) in [
        (Target::WGSL, "@workgroup_size((count * 2u), most, 1)"),
        (Target::WGSL, "array<array<f32, 3>, (count * 2u)>"),
        (Target::WGSL, "override most: u32 = max(count, 2u);"),
        (Target::GLSL450, "local_size_x = 8, local_size_y = 4, local_size_z = 1"),
        (Target::GLSL450, "shared float rows[8][3];"),
        (Target::HLSL, "[numthreads(8, 4, 1)]"),
        (Target::HLSL, "groupshared float rows[8][3];"),
        // The other override stays open.
        (Target::HLSL, "#define LAMPLIGHT_WEIGHT 0.5"),
        (Target::MSL, "LAMPLIGHT_WEIGHT [[function_constant("),
    ] {
        let found = shader.get("default", target)?;
        if found.reflection.workgroup_size != Some([8, 4, 1]) {
            return Err(format!("the size is {:?}", found.reflection.workgroup_size).into());
        }
        let text = String::from_utf8(found.bytes)?;
        if !text.contains(expected) {
            return Err(format!("{target}: expected `{expected}` in\n{text}").into());
        }
    }
    Ok(())
}

/// An axis of the mode `spec` that decides a size is a constant of each permutation.
fn spec_sizes() -> Outcome {
    let bundle = generated(&folder("shaders"), &["--program", "samples"])?;
    let shader = bundle.program("samples")?.shader("cs_main")?;
    for (key, size) in [("default", 4), ("samples=8", 8), ("samples=16", 16)] {
        let found = shader.get(key, Target::WGSL)?;
        let text = String::from_utf8(found.bytes)?;
        let size_text = format!("@workgroup_size({size}, 1, 1)");
        let is_right = found.reflection.workgroup_size == Some([size, 1, 1])
            && found.constants.is_empty()
            && text.contains(&size_text)
            && text.contains(&format!("array<u32, {size}>"));
        if !is_right {
            return Err(format!("`{key}`: expected {size} everywhere in\n{text}").into());
        }
    }
    Ok(())
}

/// The comparison with the reflection fails where a text has another size.
fn other_sizes() -> Outcome {
    let bundle = generated(&folder("shaders"), &["--program", "samples"])?;
    let found = bundle.program("samples")?.shader("cs_main")?.get("default", Target::WGSL)?;
    let text = String::from_utf8(found.bytes.clone())?;
    let other = text.replace("@workgroup_size(4, 1, 1)", "@workgroup_size(1, 1, 1)");
    let (reflection, native) = (&found.reflection, &found.native);
    let differences = output_differences(Target::WGSL, other.as_bytes(), reflection, native);
    match differences.is_empty() || other == text {
        false => Ok(()),
        true => Err("a wrong size was not noticed".into()),
    }
}
