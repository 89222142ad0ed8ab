//! What branches, lamps and loops cost, and the files that the command takes.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use lamplight_testing::commands::stderr_text;
use libtest_mimic::Failed;
use serde_json::Value;

use super::{Outcome, figure, lamplight, objects};

/// Four lamps cost more than one, and ten more than four, whether the compiler unrolls the loop or
/// not. No lamp costs the same in all of them.
pub fn lamps() -> Outcome {
    let keys = ["max_lights=1", "default", "max_lights=10"];
    let found = objects(&[&keys[..], &["--gpu", "navi21,gfx1100"]].concat())?;
    for gpu in ["navi21", "gfx1100"] {
        let mut cycles = Vec::new();
        for key in keys {
            let is_it = |object: &&Value| {
                object["name"] == key && object["gpu"] == gpu && object["stage"] == "fragment"
            };
            let object = found.iter().find(is_it).ok_or("a permutation is missing")?;
            cycles.push(figure(object, "figures", "cycles")?);
            if figure(object, "figures", "open_loops")? != 0 {
                return Err(
                    format!("the length of the loop over lamps is unknown: {object}").into()
                );
            }
        }
        let [one, four, ten] = cycles[..] else { return Err("three keys".into()) };
        let lamp = (ten - four) as f64 / 6.0;
        if one >= four || four >= ten || ((four - one) as f64 / 3.0 - lamp).abs() > 0.25 * lamp {
            return Err(format!("{gpu}: {cycles:?} cycles for 1, 4 and 10 lamps").into());
        }
    }
    Ok(())
}

const GUARDED: &str = "
fn plain(x: f32, y: f32) -> f32 {
    let one = sqrt(x) * sin(x) * exp2(x * y) + log2(x) * cos(y);
    return one * sqrt(y) * sin(y) * exp2(one) + log2(y) * cos(one);
}
fn guarded(x: f32, y: f32) -> f32 {
    if (!(x > 0.0 && y > 0.0)) {
        return 0.0;
    }
    let one = sqrt(x) * sin(x) * exp2(x * y) + log2(x) * cos(y);
    return one * sqrt(y) * sin(y) * exp2(one) + log2(y) * cos(one);
}
";

/// A guard with a branch costs more than none on the dearest path, and less on the cheapest.
pub fn guards() -> Outcome {
    let folder = tempfile::tempdir()?;
    let file = folder.path().join("guards.wesl");
    fs::write(&file, GUARDED)?;
    let name = file.to_string_lossy();
    let found = objects(&[&name, "--gpu", "navi21"])?;
    let of = |function: &str, key: &str| {
        let name = format!("{name} {function}");
        let object = found.iter().find(|object| object["name"] == name.as_str());
        figure(object.ok_or("a function is missing")?, "net", key)
    };
    let (plain, guarded) = (of("plain", "cycles")?, of("guarded", "cycles")?);
    let (shortest, transcendental) =
        (of("guarded", "least_cycles")?, of("guarded", "transcendental")?);
    // Ten functions of four cycles each.
    match guarded > plain && shortest < plain && transcendental == 10 * 4 && plain > 40 {
        true => Ok(()),
        false => {
            let what = format!("plain {plain}, guarded {shortest} to {guarded}");
            Err(format!("{what}, of which {transcendental} are transcendental").into())
        }
    }
}

/// A loop of unknown length counts once, is listed, and costs as much as the caller says.
pub fn iterations() -> Outcome {
    let name = "shadow::compare::pcf_vogel";
    let cycles = |iterations: &[&str]| -> Result<(i64, i64), Failed> {
        let found = objects(&[&[name, "--gpu", "navi21"], iterations].concat())?;
        let object = found.first().ok_or("there are no figures")?;
        Ok((figure(object, "net", "cycles")?, figure(object, "net", "open_loops")?))
    };
    let (once, open) = cycles(&[])?;
    let (again, _) = cycles(&["--iterations", "1"])?;
    let ((two, closed), (sixteen, _)) =
        (cycles(&["--iterations", "2"])?, cycles(&["--iterations", "16"])?);
    let told = lamplight(&[name, "--gpu", "navi21"])?;
    let listed = String::from_utf8_lossy(&told.stdout).contains("Loops of unknown length");
    let one = two - once;
    if (open, closed) != (1, 0)
        || once != again
        || one < 10
        || sixteen - once != 15 * one
        || !listed
    {
        let what =
            format!("{once}, {again}, {two}, {sixteen} cycles for once, 1, 2 and 16 iterations");
        return Err(format!("{what}; {open} and {closed} open loops, listed: {listed}").into());
    }
    Ok(())
}

const SHADER: &str = "import lamplight::brdf::specular::blinn_phong;
@group(0) @binding(0) var map: texture_2d<f32>;
@group(0) @binding(1) var smp: sampler;
@fragment fn fs(@location(0) n: vec3f, @location(1) l: vec3f, @location(2) v: vec3f) -> @location(0) vec4f {
    return textureSample(map, smp, n.xy) * vec4f(blinn_phong(normalize(n), normalize(l), normalize(v), 9.0));
}
";

/// SPIR-V has the figures of the text that it was compiled from, as a file and as standard input.
pub fn modules() -> Outcome {
    let folder = tempfile::tempdir()?;
    fs::write(folder.path().join("shader.wesl"), SHADER)?;
    let compiled = Command::new(env!("CARGO_BIN_EXE_lamplight"))
        .args(["compile", "shader.wesl", "--target", "spirv", "-o", "."])
        .current_dir(folder.path())
        .output()?;
    if !compiled.status.success() {
        return Err(stderr_text(&compiled).into());
    }
    let cost = |arguments: &[&str], input: Option<&str>| -> Result<Value, Failed> {
        let input = input.map(|name| fs::File::open(folder.path().join(name))).transpose()?;
        let output = Command::new(env!("CARGO_BIN_EXE_lamplight"))
            .args(["cost", "--no-cache", "--json", "--gpu", "navi21"])
            .args(arguments)
            .current_dir(folder.path())
            .stdin(input.map_or_else(Stdio::null, Stdio::from))
            .output()?;
        if output.status.code() != Some(0) {
            return Err(stderr_text(&output).into());
        }
        Ok(serde_json::from_slice::<Value>(&output.stdout)?[0]["figures"].clone())
    };
    let text = cost(&["shader.wesl"], None)?;
    let given = [
        cost(&["shader.fs.frag.spv"], None)?,
        cost(&["-"], Some("shader.fs.frag.spv"))?,
        cost(&["-", "--lang", "wesl"], Some("shader.wesl"))?,
    ];
    match text["cycles"].as_i64() > Some(50) && given.iter().all(|figures| *figures == text) {
        true => Ok(()),
        false => Err(format!("the text has {text}, the others {given:?}").into()),
    }
}

/// What another compiler writes: a texture with its sampler, an array of them, push constants, a
/// matrix between the stages, two outputs.
const FOREIGN: &str = "#version 450
layout(location = 0) in vec2 uv;
layout(location = 1) flat in ivec3 whole;
layout(location = 2) in mat3 turn;
layout(set = 0, binding = 0) uniform sampler2D maps[4];
layout(set = 1, binding = 2) uniform Block { vec4 color; } block;
layout(push_constant) uniform Push { vec4 sum; } push;
layout(location = 0) out vec4 lit;
layout(location = 1) out uint id;
void main() {
    lit = texture(maps[1], uv) * block.color + push.sum * sin(uv.x) + vec4(turn * vec3(whole), 1);
    id = uint(whole.x);
}
";

pub fn foreign_modules() -> Outcome {
    let folder = tempfile::tempdir()?;
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    fs::write(path("foreign.frag"), FOREIGN)?;
    let compiled = Command::new("glslangValidator")
        .args(["-V", &path("foreign.frag"), "-o", &path("foreign.spv")])
        .output()?;
    if !compiled.status.success() {
        return Err(String::from_utf8_lossy(&compiled.stdout).into_owned().into());
    }
    let found = objects(&[&path("foreign.spv"), "--gpu", "navi21"])?;
    let object = found.first().ok_or("there are no figures")?;
    let of = |key: &str| figure(object, "figures", key);
    // One texture, one sine, two outputs.
    let counts = [of("texture")?, of("transcendental")?, of("export")?];
    if counts != [1, 4, 2] || of("cycles")? < 20 {
        return Err(format!("textures, transcendental cycles, exports: {object}").into());
    }
    refused_modules(folder.path())
}

fn refused_modules(folder: &Path) -> Outcome {
    let whole = fs::read(folder.join("foreign.spv"))?;
    let mut wrong = whole.clone();
    // The number of a type, behind the length and the opcode of the last instructions.
    let at = wrong.len() - 8;
    wrong[at..at + 4].copy_from_slice(&[0xff; 4]);
    let cases = [
        ("none.spv", b"float4 main()".to_vec(), "not SPIR-V"),
        ("cut.spv", whole.get(..200).unwrap_or_default().to_vec(), "error"),
        ("wrong.spv", wrong, "error"),
        ("empty.spv", whole.get(..20).unwrap_or_default().to_vec(), "no entry points"),
    ];
    for (name, bytes, expected) in cases {
        fs::write(folder.join(name), bytes)?;
        let output = lamplight(&[&folder.join(name).to_string_lossy(), "--gpu", "navi21"])?;
        if output.status.code() != Some(1) || !stderr_text(&output).contains(expected) {
            let found = format!("{:?}: {}", output.status, stderr_text(&output));
            return Err(format!("{name}: expected exit code 1 and `{expected}`, {found}").into());
        }
    }
    Ok(())
}
