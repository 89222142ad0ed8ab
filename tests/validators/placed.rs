//! The refusal of an output is reported at the author's line that causes it.

use std::fs;

use lamplight::bundle::Bundle;

use super::{COUNTED, COUNTED_MANIFEST, Outcome, Package, expect};

/// A validator's refusal is shown at the author's line, with the permutation and the target. The
/// older bundle stays as it was, as a folder and as a file. Nothing is left among the temporary
/// files.
pub fn refusals_are_placed() -> Outcome {
    // No stage of GLSL has so many outputs.
    let many = "struct Colors {
    @location(0) first: vec4f,
    @if(bits) @location(40) last: vec4f,
}
@fragment fn fs_main(@location(0) at: vec2f) -> Colors {
    var colors: Colors;";
    let head = "@fragment fn fs_main(@location(0) at: vec2f) -> @location(0) vec4f {";
    let refused = COUNTED
        .replace("countOneBits", "abs")
        .replace(head, many)
        .replace("return vec4f(sum);", "colors.first = vec4f(sum);\n    return colors;");
    let sound = COUNTED.replace("countOneBits", "abs");
    let package = Package::new(COUNTED_MANIFEST, &sound)?;
    let temporary = package.path("temporary");
    fs::create_dir(&temporary)?;
    let run = |arguments: &[&str]| package.command(arguments).env("TMPDIR", &temporary).output();
    for out in ["bundle", "one.lamplight"] {
        fs::write(package.path("one.wesl"), &sound)?;
        let arguments = ["gen", "--validate", "--no-cache", "-o", out];
        expect(&run(&arguments)?, 0, &["4 outputs validated, 0 known to pass"])?;
        let before = Bundle::open(package.path(out))?.contents()?;
        fs::write(package.path("one.wesl"), &refused)?;
        let words = [
            "error[output-refused]: glslangValidator refuses the output for `essl300`",
            "one.wesl:12:1",
            "line ",
            "in permutation `bits` of one fs_main (wesl)",
        ];
        expect(&run(&arguments)?, 1, &words)?;
        let bundle = Bundle::open(package.path(out))?;
        bundle.verify()?;
        if bundle.contents()? != before {
            return Err(format!("{out} was replaced although an output was refused").into());
        }
        let left: Vec<_> = fs::read_dir(&temporary)?.flatten().map(|left| left.path()).collect();
        if !left.is_empty() {
            return Err(format!("after validating {out}, these are left: {left:?}").into());
        }
    }
    Ok(())
}

/// If naga's writer cannot write a function for a target, the error is at the author's function,
/// with the permutation and the target.
pub fn writers_are_placed() -> Outcome {
    let cubes = "
@group(0) @binding(0) var cubes: texture_cube_array<f32>;
@group(0) @binding(1) var smp: sampler;
fn plain(x: f32) -> f32 { return x; }
// Not in GLSL ES 3.00.
fn looked(at: vec3f) -> vec4f { return textureSample(cubes, smp, at, 1); }
@fragment fn fs_main(@location(0) at: vec3f) -> @location(0) vec4f {
    var sum = vec4f(plain(at.x));
    @if(bits) { sum += looked(at); }
    return sum;
}
";
    let package = Package::new(COUNTED_MANIFEST, cubes)?;
    let words = ["error[emit-failed]: target `essl300`", "one.wesl:6:1", "in permutation `bits`"];
    expect(&package.run(&["gen", "--no-cache"])?, 1, &words)
}

/// Vulkan 1.0 lays matrices of `f16` otherwise in uniform blocks, which naga does not tell.
pub fn matrices_of_halves() -> Outcome {
    let text = |space: &str| {
        format!(
            "enable f16;
struct Turn {{ by: f16, turns: mat3x4<f16> }}
@if(bits) @group(0) @binding(0) var<{space}> turn: Turn;
@fragment fn fs_main(@location(0) at: vec3f) -> @location(0) vec4f {{
    @if(bits) {{ return vec4f(turn.turns[2]); }}
    @else {{ return vec4f(at, 0.0); }}
}}
"
        )
    };
    let manifest = COUNTED_MANIFEST.replace("\"essl300\", \"hlsl\"", "\"spirv\"");
    let package = Package::new(&manifest, &text("uniform"))?;
    let words = ["target `spirv`: a matrix of `f16`", "one.wesl:3:", "in permutation `bits`"];
    expect(&package.run(&["gen", "--no-cache"])?, 1, &words)?;
    let package = Package::new(&manifest, &text("storage"))?;
    expect(&package.run(&["gen", "--no-cache"])?, 0, &[])?;
    let manifest = COUNTED_MANIFEST.replace("\"essl300\", \"hlsl\"", "\"msl\"");
    let package = Package::new(&manifest, &text("uniform"))?;
    expect(&package.run(&["gen", "--no-cache"])?, 0, &[])
}

/// Code is refused at the author's line if GLSL cannot express it, or if its GLSL output would be
/// valid and compute something else. For other targets it is compiled.
pub fn glsl_means_something_else() -> Outcome {
    let fragment = |body: &str| {
        format!(
            "struct Turn {{ turns: array<mat2x2f, 2>, by: vec4f }}
@if(bits) @group(0) @binding(0) var<uniform> turn: Turn;
@fragment fn fs_main(@location(0) at: vec3f) -> @location(0) vec4f {{
    @if(bits) {{ return {body}; }}
    @else {{ return vec4f(at, 0.0); }}
}}
"
        )
    };
    let columns = fragment("vec4f(turn.turns[1] * at.xy, turn.by.xy)");
    let fraction = fragment("vec4f(frexp(at.x).fract)");
    let depth = "@group(1) @binding(0) var depths: texture_depth_2d;
@group(1) @binding(1) var smp: sampler;
@group(1) @binding(2) var map: texture_2d<f32>;
@group(1) @binding(3) var compare: sampler_comparison;
";
    let both = "textureSampleLevel(depths, smp, at.xy, 0) + \
        textureSampleCompareLevel(depths, compare, at.xy, 0.5)";
    let plain = fragment(&format!("vec4f({both})")) + depth;
    let levels = fragment("vec4f(f32(textureNumLevels(map)))") + depth;
    let arrays = fragment("vec4f(array<array<f32, 2>, 2>()[i32(at.x) & 1][i32(at.y) & 1])");
    let cases = [
        (&columns, "glsl450", "target `glsl450`: a matrix of two rows", "one.wesl:2:"),
        (&columns, "essl300", "target `essl300`: a matrix of two rows", "one.wesl:2:"),
        (&fraction, "glsl330", "target `glsl330`: the language has no `frexp`", "one.wesl:4:"),
        (&fraction, "essl300", "target `essl300`: the language has no `frexp`", "one.wesl:4:"),
        (&plain, "essl300", "target `essl300`: the language has no depth texture", "one.wesl:4:"),
        (&plain, "glsl450", "target `glsl450`: the language has no depth texture", "one.wesl:4:"),
        (&levels, "glsl330", "the language has no `textureQueryLevels`", "one.wesl:4:"),
        (&arrays, "glsl330", "the language has no array of arrays", "one.wesl:4:"),
        (&arrays, "essl300", "the language has no array of arrays", "one.wesl:4:"),
    ];
    for (text, target, words, place) in cases {
        let manifest = COUNTED_MANIFEST.replace("essl300", target);
        let package = Package::new(&manifest, text)?;
        let arguments = ["gen", "--no-cache"];
        expect(&package.run(&arguments)?, 1, &[words, place, "in permutation `bits`"])?;
        let others = COUNTED_MANIFEST.replace("essl300", "spirv");
        fs::write(package.path("lamplight.toml"), others)?;
        expect(&package.run(&arguments)?, 0, &[])?;
    }
    Ok(())
}
