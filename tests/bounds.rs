//! The checks of indices, texture loads and loops that a program may ask for.

mod loops;

use std::fs;

use lamplight::bundle::{Bundle, Target, blob_files};
use lamplight::emit::spirv::{SpirvInstruction, instructions, words};
use lamplight::validators;
use libtest_mimic::{Failed, Trial};

use crate::validators::{Package, expect};

type Outcome = Result<(), Failed>;
type Case = (&'static str, fn() -> Outcome);

pub fn tests() -> Vec<Trial> {
    let cases: [Case; 6] = [
        ("checks_by_target", checks_by_target),
        ("checks_are_measured", checks_are_measured),
        ("checks_are_those_of_the_manifest", checks_are_those_of_the_manifest),
        ("counted_loops_cost_nothing", loops::counted),
        ("no_endless_loop_is_proved", loops::random),
        ("loops_of_the_library", loops::library),
    ];
    let test = |(name, case): Case| Trial::test(format!("bounds::{name}"), case);
    cases.map(test).into()
}

/// An index into a uniform and into an array of its own, a texture load, and a loop that does not end
/// if the count is the largest number.
const SHADER: &str = "
struct Palette { values: array<vec4f, 3>, count: u32 }
@group(0) @binding(0) var<uniform> table: Palette;
@group(0) @binding(1) var image: texture_2d<f32>;
@fragment fn fs_main(@location(0) @interpolate(flat) at: vec2u) -> @location(0) vec4f {
    var own = array(0.25, 0.5, 0.75, 1.0);
    var sum = table.values[at.x] * own[at.y] + textureLoad(image, at, 0);
    for (var i = 0u; i <= table.count; i += 1u) {
        sum += vec4f(0.125);
    }
    return sum;
}
";

const MANIFEST: &str = "[program.one]\nwesl = \"one.wesl\"\n";

/// Text by which a target's output shows that array indices, texture loads and loops are checked.
/// `None` where naga's writer has no such check.
struct Signs {
    target: Target,
    array: Option<&'static str>,
    load: Option<&'static str>,
    round: Option<&'static str>,
}

/// The checks of naga's writers. WebGPU's implementations check by themselves, D3D defines loads
/// beyond a texture, and OpenGL's drivers are asked for robust access. GLSL 3.30 and GLSL ES 3.00
/// cannot ask for the number of a texture's levels.
const SIGNS: [Signs; 6] = [
    Signs {
        target: Target::MSL,
        array: Some("metal::min(unsigned("),
        load: Some(".get_width("),
        round: Some("loop_bound"),
    },
    Signs { target: Target::HLSL, array: Some("min(uint("), load: None, round: Some("loop_bound") },
    Signs { target: Target::GLSL450, array: None, load: Some("clamp("), round: None },
    Signs { target: Target::GLSL330, array: None, load: None, round: None },
    Signs { target: Target::ESSL300, array: None, load: None, round: None },
    Signs { target: Target::WGSL, array: None, load: None, round: None },
];

fn output(package: &Package, out: &str, target: Target) -> Result<Vec<u8>, Failed> {
    let bundle = Bundle::open(package.path(out))?;
    Ok(bundle.program("one")?.shader("fs_main")?.get("default", target)?.bytes.clone())
}

/// Outputs have the checks of their target if they are asked for, and none otherwise. The
/// validators accept both.
fn checks_by_target() -> Outcome {
    let package = Package::new(MANIFEST, SHADER)?;
    for bounds in ["unchecked", "restrict"] {
        let run = ["gen", "--no-cache", "--bounds", bounds, "-o", bounds];
        expect(&package.run(&run)?, 0, &[])?;
        let outputs = validators::outputs(blob_files(package.path(bounds))?)?;
        if let Some(refusal) = validators::validate_outputs(&outputs, None, &|_, _| ())?.first() {
            return Err(format!("{bounds}: {refusal:?}").into());
        }
    }
    for Signs { target, array, load, round } in SIGNS {
        let texts = ["unchecked", "restrict"].map(|out| output(&package, out, target));
        let [unchecked, restrict] = texts;
        let (unchecked, restrict) = (unchecked?, restrict?);
        let has = |bytes: &[u8], sign: &str| String::from_utf8_lossy(bytes).contains(sign);
        for sign in [array, load, round].into_iter().flatten() {
            if has(&unchecked, sign) || !has(&restrict, sign) {
                let text = String::from_utf8_lossy(&restrict);
                return Err(format!("{target}: `{sign}` is not just in:\n{text}").into());
            }
        }
        let is_same = [array, load, round].iter().all(Option::is_none);
        if is_same != (unchecked == restrict) {
            return Err(format!("{target}: the outputs should be equal: {is_same}").into());
        }
    }
    let [unchecked, restrict] =
        ["unchecked", "restrict"].map(|out| output(&package, out, Target::SPIRV));
    // Two array indices and the two coordinates of the texture load are clamped.
    let (without, with) = (minima(&unchecked?), minima(&restrict?));
    match (without, with) {
        (0, 4..) => Ok(()),
        _ => Err(format!("spirv: {without} minima without checks, {with} with them").into()),
    }
}

/// How often a module of SPIR-V takes the minimum of unsigned numbers, which clamps an index.
fn minima(bytes: &[u8]) -> usize {
    const EXTENDED: u16 = 12;
    const UNSIGNED_MINIMUM: u32 = 38;
    let words = words(bytes);
    let is_minimum = |found: &SpirvInstruction<'_>| {
        found.op == EXTENDED && found.words.get(4) == Some(&UNSIGNED_MINIMUM)
    };
    instructions(&words).filter(is_minimum).count()
}

/// The option overrides the manifest, the cache does not mix up outputs with checks and without,
/// and `compile` gives what `gen` gives.
fn checks_are_those_of_the_manifest() -> Outcome {
    let package = Package::new(&format!("{MANIFEST}bounds = \"restrict\"\n"), SHADER)?;
    let runs: [(&[&str], bool); 4] = [
        (&[], true),
        (&["--bounds", "unchecked"], false),
        (&["--bounds", "restrict"], true),
        (&[], true),
    ];
    for (arguments, expected) in runs {
        let all = [&["gen", "--cache", "cache", "-o", "out"], arguments].concat();
        expect(&package.run(&all)?, 0, &[])?;
        let made = output(&package, "out", Target::MSL)?;
        let compile = [&["compile", "one.wesl", "--target", "msl"], arguments].concat();
        let output = package.run(&compile)?;
        expect(&output, 0, &[])?;
        let is_checked = String::from_utf8_lossy(&made).contains("loop_bound");
        if is_checked != expected || output.stdout != made {
            let found = String::from_utf8_lossy(&output.stdout);
            return Err(format!("{arguments:?}: expected checks: {expected}\n{found}").into());
        }
    }
    let output = package.run(&["gen", "--bounds", "clamp"])?;
    expect(&output, 2, &["expected one of: unchecked, restrict"])?;
    fs::write(package.path("lamplight.toml"), format!("{MANIFEST}bounds = \"restict\"\n"))?;
    let words = ["error[unknown-bounds]", "lamplight.toml:3:10", "did you mean `restrict`?"];
    expect(&package.run(&["gen"])?, 1, &words)
}

/// `cost` measures the outputs that are asked for: functions, and stages of files.
fn checks_are_measured() -> Outcome {
    let package = Package::new(MANIFEST, SHADER)?;
    let function =
        "fn pick(at: u32) -> f32 { var own = array(0.25, 0.5, 0.75); return own[at]; }\n";
    fs::write(package.path("module.wesl"), function)?;
    for file in ["module.wesl", "one.wesl"] {
        let count = |bounds: &str| -> Result<String, Failed> {
            let output = package.run(&["cost", file, "--spirv", "--bounds", bounds])?;
            expect(&output, 0, &[])?;
            Ok(String::from_utf8_lossy(&output.stdout).into_owned())
        };
        let counts = [count("unchecked")?, count("restrict")?];
        if counts[0] == counts[1] {
            return Err(format!("{file}: checks change nothing:\n{}", counts[0]).into());
        }
    }
    Ok(())
}
