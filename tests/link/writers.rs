//! Names and functions that naga's writers change. The validators must accept the outputs, and some
//! are searched for a certain text.

use lamplight::bundle::write_directory;
use lamplight::generate::Generated;
use libtest_mimic::Failed;

use super::{Outcome, made, package, units, validate_all};

/// Makes a program of one file in some targets, and fails if a validator refuses an output.
fn accepted(text: &str, targets: &str) -> Result<Generated, Failed> {
    let folder = tempfile::tempdir()?;
    let manifest = format!("[program.one]\nwesl = \"one.wesl\"\n{targets}\n");
    let (mut sources, packages, manifest) = package(folder.path(), "one", &manifest, text)?;
    let mut made = made(&mut sources, &packages, &manifest, None)?;
    let contents = std::mem::take(&mut made.contents);
    let out = folder.path().join("out");
    write_directory(&contents, &out)?;
    validate_all(&out)?;
    made.contents = contents;
    Ok(made)
}

/// naga changes the name of an entry point that ends with a digit, and the reflection has the name
/// in the output. A variable and a parameter whose changed names would be equal get different
/// names.
pub fn entry_points() -> Outcome {
    let text = "
@group(0) @binding(0) var<uniform> metal_2: vec4f;
fn read() -> vec4f { return metal_2; }
@fragment fn metal_2_(@location(0) metal_2: vec2f) -> @location(0) vec4f { return read() + metal_2.xyxy; }
@vertex fn main_1() -> @builtin(position) vec4f { return vec4f(); }
";
    let made = accepted(text, "")?;
    for ((_, entry, _), unit) in units(&made) {
        let wgsl = &unit.targets["wgsl"];
        let (text, name) = (String::from_utf8_lossy(&wgsl.bytes), &wgsl.native.entry_name);
        let declared = format!("fn {name}(");
        if text.matches(&declared).count() != 1 || text.contains("var<uniform> metal_2_:") {
            let what = format!("the reflection names it `{name}`, or a variable has its name");
            return Err(format!("{entry}: {what}:\n{text}").into());
        }
        lamplight::validate::validate(&lamplight::compose::Composed::of_text(
            lamplight::bundle::Language::Wesl,
            None,
            text.clone().into_owned(),
        ))
        .map_err(|problems| format!("{problems:?}\n{text}"))?;
    }
    Ok(())
}

/// Names of the author's that are also names of naga's helpers, or keywords that naga's lists lack,
/// give outputs that the validators accept.
pub fn kept_names() -> Outcome {
    let text = "
struct Pair { sampler2D: f32, turn: mat2x2f, kind: vec3f }
struct int64_t { f32vec2: vec4f, gl: f32 }
// Underscores that naga leaves out.
struct Kept { sampler2D_: f32, int64__t: f32, sampler2D__: f32 }
const TABLE = array<vec2f, 2>(vec2f(0.5), vec2f(0.25));
const PAIRS = array<Pair, 2>(
    Pair(0.5, mat2x2f(vec2f(1.0), vec2f(2.0)), vec3f(1.0)),
    Pair(0.25, mat2x2f(vec2f(3.0), vec2f(4.0)), vec3f(2.0)),
);
const ONE = Pair(1.0, mat2x2f(vec2f(1.0), vec2f(2.0)), vec3f(0.0));
var<private> list: array<i32, 3> = array<i32, 3>(1, 2, 3);
fn gl(x: f32) -> int64_t { return int64_t(vec4f(x), x); }
fn gl_1(x: f32) -> f32 { let gl = x; return gl; }
@fragment fn ZeroValue(@location(0) at: vec2f, @location(1) @interpolate(flat) i: u32) -> @location(0) vec4f {
    let ConstructPair = at.x;
    let Constructarray2_float2_ = array<vec2f, 2>(at, TABLE[i & 1u]);
    let pair = Pair(ConstructPair, mat2x2f(at, at), vec3f(f32(list[i & 1u])));
    let found = gl(gl_1(pair.sampler2D + PAIRS[i & 1u].turn[1].x + ONE.kind.y));
    let kept = Kept(at.x, at.y, found.gl);
    let more = vec4f(kept.sampler2D_, kept.int64__t, kept.sampler2D__, 0.0);
    return more + found.f32vec2 + Constructarray2_float2_[i & 1u].xyxy;
}
@vertex fn vs_main() -> @builtin(position) vec4f { return vec4f(); }
";
    accepted(text, "").map(|_| ())
}

/// In HLSL, an array of matrices of two rows within a structure has a structure of columns as its
/// element type. naga's declaration of this structure ends with its name. The output must have it.
pub fn matrices_of_two_rows() -> Outcome {
    let text = "
struct Turns { all: array<mat3x2f, 4>, one: mat4x2f }
var<private> turns: Turns;
@fragment fn fs_main(@location(0) at: vec2f) -> @location(0) vec4f {
    turns.one = mat4x2f(at, at, at, at);
    return vec4f(turns.one * at.xyxy, at);
}
@vertex fn vs_main() -> @builtin(position) vec4f { return vec4f(); }
";
    let made = accepted(text, "")?;
    let whole = units(&made).into_values().filter_map(|unit| unit.targets.get("hlsl"));
    let texts: Vec<String> =
        whole.map(|artifact| String::from_utf8_lossy(&artifact.bytes).into_owned()).collect();
    match texts.iter().any(|text| text.contains("} __mat3x2_f32;")) {
        true => Ok(()),
        false => Err(format!("no HLSL output has `}} __mat3x2_f32;`: {texts:?}").into()),
    }
}

/// Arrays of matrices of two rows can be read, written and passed as a whole in HLSL. A column is
/// changed in place, through an `inout` parameter: naga's own functions change a copy.
pub fn kept_matrices() -> Outcome {
    let text = "
struct Pair { two: array<mat2x2f, 2> }
struct Turns { scale: f32, all: array<mat3x2f, 4>, deep: array<Pair, 3> }
const FIXED = array<Turns, 1>(Turns(
    0.5,
    array<mat3x2f, 4>(mat3x2f(), mat3x2f(1.0, 2.0, 3.0, 4.0, 5.0, 6.0), mat3x2f(), mat3x2f()),
    array<Pair, 3>(),
));
var<private> turns: Turns;
fn changed(given: array<mat3x2f, 4>, i: u32) -> array<mat3x2f, 4> {
    turns = Turns(1.0, given, turns.deep);
    turns.all = given;
    turns.all[i] = turns.all[i + 1u];
    turns.all[1][i] = vec2f(2.0);
    turns.all[i][2].y = 3.0;
    turns.deep[2].two[i] = turns.deep[i].two[0];
    return turns.all;
}
@fragment fn fs_main(@location(0) at: vec2f, @location(1) @interpolate(flat) i: u32) -> @location(0) vec4f {
    let made = changed(turns.all, i);
    var fixed = FIXED[0];
    return vec4f(made[i] * at.xyx, fixed.all[i] * at.xyx) + turns.deep[i].two[i][0].xyxy;
}
@vertex fn vs_main() -> @builtin(position) vec4f { return vec4f(); }
";
    let made = accepted(text, "")?;
    let whole = units(&made).into_values().filter_map(|unit| unit.targets.get("hlsl"));
    let texts: Vec<String> =
        whole.map(|artifact| String::from_utf8_lossy(&artifact.bytes).into_owned()).collect();
    match texts.iter().any(|text| text.contains("(inout __mat3x2_f32 mat, ")) {
        true => Ok(()),
        false => {
            let what = "no HLSL output has a function with `inout __mat3x2_f32 mat`";
            Err(format!("{what}, so a column is changed in a copy: {texts:?}").into())
        }
    }
}

/// A matrix of two rows in the result of a function cannot be written in HLSL. It is refused at its
/// line, for that target only, and the message says to use a `var`.
pub fn matrices_from_values() -> Outcome {
    let text = "
struct Turns { all: array<mat3x2f, 4> }
fn made(at: vec2f) -> Turns { var turns: Turns; turns.all[1][0] = at; return turns; }
@fragment fn fs_main(@location(0) at: vec2f) -> @location(0) vec4f {
    return vec4f(made(at).all[1] * at.xyx, at);
}
@vertex fn vs_main() -> @builtin(position) vec4f { return vec4f(); }
";
    accepted(text, r#"targets = ["spirv", "glsl450", "msl", "wgsl"]"#)?;
    let Err(refused) = accepted(text, r#"targets = ["hlsl"]"#) else {
        return Err("HLSL should refuse a matrix of two rows in a function's result".into());
    };
    let words = refused.message().unwrap_or_default().to_owned();
    match words.contains("one.wesl:5:") && words.contains("`var`") {
        true => Ok(()),
        false => Err(format!("expected one.wesl:5: and `var` in:\n{words}").into()),
    }
}

/// GLSL has the lengths of arrays that a function returns before the function's name, and after the
/// names of variables. Such functions are translated once, as all others are.
pub fn returned_arrays() -> Outcome {
    let text = "
const WEIGHTS: array<f32, 2> = array<f32, 2>(0.25, 0.75);
var<private> kept: array<vec2f, 3>;
fn weights(x: f32) -> array<f32, 2> { return array<f32, 2>(x * WEIGHTS[0], x * WEIGHTS[1]); }
fn pairs(x: f32) -> array<array<f32, 2>, 3> {
    return array<array<f32, 2>, 3>(weights(x), weights(2.0 * x), weights(3.0 * x));
}
@fragment fn fs_main(@location(0) at: vec2f, @location(1) @interpolate(flat) i: u32) -> @location(0) vec4f {
    var all = pairs(at.x);
    kept[i % 3u] = at;
    return vec4f(all[i % 3u][0], all[1][i % 2u], kept[1]);
}
@vertex fn vs_main() -> @builtin(position) vec4f { return vec4f(); }
";
    // GLSL 3.30 and GLSL ES 3.00 have no arrays of arrays.
    let targets = r#"targets = ["spirv", "glsl450", "hlsl", "msl", "wgsl"]"#;
    let made = accepted(text, targets)?;
    match made.summary.whole.first() {
        None => Ok(()),
        Some(whole) => {
            Err(format!("expected every text to be linked; as a whole: {whole:?}").into())
        }
    }
}

/// Functions that GLSL 3.30 and GLSL ES 3.00 lack are refused at their line, for those targets
/// only.
pub fn lacking() -> Outcome {
    let text = "
@fragment fn fs_main(@location(0) at: vec2f) -> @location(0) vec4f {
    return vec4f(ldexp(at.x, 2), f32(countOneBits(u32(at.y))), 0.0, 0.0);
}
@vertex fn vs_main() -> @builtin(position) vec4f { return vec4f(); }
";
    accepted(text, r#"targets = ["spirv", "glsl450", "hlsl", "msl", "wgsl"]"#)?;
    for target in ["glsl330", "essl300"] {
        let targets = format!("targets = [\"{target}\"]");
        let Err(refused) = accepted(text, &targets) else {
            let what = "should refuse `ldexp` and `bitCount`, and compiles them";
            return Err(format!("{target} {what}").into());
        };
        let words = refused.message().unwrap_or_default().to_owned();
        for word in ["`ldexp`", "`bitCount`", "one.wesl:3:"] {
            if !words.contains(word) {
                return Err(format!("{target}: expected {word} in:\n{words}").into());
            }
        }
    }
    Ok(())
}

/// The reflection says that a texture is written, whichever function writes to it.
pub fn written_textures() -> Outcome {
    let text = "
@group(0) @binding(0) var stored: texture_storage_2d<rgba8unorm, write>;
fn put(at: vec2i) -> vec4f { textureStore(stored, at, vec4f(1.0)); return vec4f(); }
@fragment fn fs_main() -> @location(0) vec4f { return put(vec2i()); }
";
    let made = accepted(text, r#"targets = ["spirv", "glsl450", "hlsl", "msl", "wgsl"]"#)?;
    for (_, unit) in units(&made) {
        if !unit.reflection.bindings.iter().all(|binding| binding.writable) {
            return Err(format!("{:?}", unit.reflection.bindings).into());
        }
    }
    Ok(())
}

/// naga calls the block of a uniform that is no structure `type_block_0Fragment`, also where the
/// author has a structure of that name. The validators must accept the outputs.
pub fn blocks_beside_structures() -> Outcome {
    let text = "
struct type_block_0Fragment { half: vec4f }
@group(0) @binding(0) var<uniform> plain: vec4f;
@group(0) @binding(1) var<uniform> own: type_block_0Fragment;
// A name like this one is not linked, so that naga writes the text as a whole.
fn Zqbqz(x: vec4f) -> vec4f { return x; }
@fragment fn fs_main() -> @location(0) vec4f { return Zqbqz(own.half) + plain; }
@vertex fn vs_main() -> @builtin(position) vec4f { return vec4f(); }
";
    match accepted(text, "")?.summary.whole.is_empty() {
        true => Err("the text should be compiled as a whole".into()),
        false => Ok(()),
    }
}

/// Within a structure, C++ takes the name of a member for the member, so that a structure of that
/// name cannot be the type of another member.
pub fn types_like_members() -> Outcome {
    let text = "
struct size { width: vec4f, height: f32 }
struct Outer { size: size, other: size }
@group(0) @binding(0) var<uniform> outer: Outer;
// A name like this one is not linked, so that naga writes the text as a whole.
fn Zqbqz(x: vec4f) -> vec4f { return x; }
@fragment fn fs_main() -> @location(0) vec4f {
    let own = size(outer.size.width, 1.0);
    return Zqbqz(own.width) * outer.other.height;
}
@vertex fn vs_main() -> @builtin(position) vec4f { return vec4f(); }
";
    match accepted(text, "")?.summary.whole.is_empty() {
        true => Err("the text should be compiled as a whole".into()),
        false => Ok(()),
    }
}

/// HLSL has two variables for a structure that an entry point returns, which naga names after the
/// structure. A parameter may have the name of the second.
pub fn variables_named_after_structures() -> Outcome {
    let text = "
struct color { @builtin(position) at: vec4f, @location(0) shade: f32 }
fn shaded(number: u32) -> color { return color(vec4f(), f32(number)); }
@vertex fn color_1(@builtin(vertex_index) color_1: u32) -> color {
    return color(vec4f(f32(color_1)), shaded(color_1).shade);
}
@fragment fn fs_main() -> @location(0) vec4f { return vec4f(); }
";
    accepted(text, "").map(|_| ())
}
