//! Separate compilation: a text has the same bytes whether its functions are its own or were
//! taken from others, and whatever may not be taken apart is left whole.

use std::collections::BTreeMap;
use std::path::Path;

use lamplight::bundle::{Unit, write_directory};
use lamplight::diagnostic::render::{Form, render};
use lamplight::generate::{Generated, Request, in_memory};
use lamplight::judge;
use lamplight::link::Reason;
use lamplight::permute::{Manifest, Quoted};
use lamplight::project;
use lamplight::resolve::Packages;
use lamplight::source::SourceSet;
use libtest_mimic::{Failed, Trial};

use crate::link_compare as compare;

type Outcome = Result<(), Failed>;
type Case = (&'static str, fn() -> Outcome);

/// One permutation of `forward` in so many is also compiled by itself.
const STEP: usize = 23;

pub fn trials() -> Vec<Trial> {
    let cases: [Case; 10] = [
        ("forward_alone_and_together", forward),
        ("traps_alone_and_together", traps),
        ("names_alone_and_together", names),
        ("whole_and_linked", whole_and_linked),
        ("reasons", reasons),
        ("warnings_are_not_lost", warnings),
        ("an_entry_point_called_like_others", entry_points),
        ("names_of_hlsl_and_glsl", kept_names),
        ("functions_that_old_glsl_lacks", lacking),
        ("arrays_of_matrices_of_two_rows", matrices_of_two_rows),
    ];
    cases.into_iter().map(|(name, case)| Trial::test(format!("link::{name}"), case)).collect()
}

/// Makes a manifest's permutations, or one of them.
fn made(
    sources: &mut SourceSet,
    packages: &Packages,
    manifest: &Manifest,
    key: Option<&str>,
) -> Result<Generated, Failed> {
    let only = key.map(|key| {
        let id = sources.add("key", key);
        Quoted::whole(sources, id)
    });
    let request = Request { only, ..Request::default() };
    let made = in_memory(sources, packages, manifest, &request, &|_| ());
    Ok(made.map_err(|problems| render(sources, &problems, Form::Human))?)
}

/// Units by entry point and key.
fn units(generated: &Generated) -> BTreeMap<(String, String), &Unit> {
    let entries = generated
        .contents
        .programs
        .values()
        .flat_map(|program| program.languages.values().flatten());
    let units = entries.flat_map(|(name, entry)| {
        entry.keys.iter().map(move |(key, unit)| ((name.clone(), key.clone()), &entry.units[unit]))
    });
    units.collect()
}

/// Each text by itself has the bytes, the names and the reflection that it has among all others.
fn agree(
    sources: &mut SourceSet,
    packages: &Packages,
    manifest: &Manifest,
    step: usize,
) -> Result<Generated, Failed> {
    let together = made(sources, packages, manifest, None)?;
    let all = units(&together);
    let mut keys: Vec<&String> = all.keys().map(|(_, key)| key).collect();
    keys.sort();
    keys.dedup();
    for key in keys.into_iter().step_by(step) {
        let alone = made(sources, packages, manifest, Some(key))?;
        for ((entry, key), unit) in units(&alone) {
            differ(unit, all[&(entry.clone(), key.clone())])
                .map_or(Ok(()), |what| Err(format!("[{key}] {entry}: {what}")))?;
        }
    }
    Ok(together)
}

fn differ(alone: &Unit, together: &Unit) -> Option<String> {
    if alone.reflection != together.reflection {
        return Some("another reflection".to_owned());
    }
    let differ = |target: &&String| alone.targets[*target] != together.targets[*target];
    alone.targets.keys().find(differ).map(|target| {
        let text = |unit: &Unit| String::from_utf8_lossy(&unit.targets[target].bytes).into_owned();
        format!("{target} differs, alone:\n{}\ntogether:\n{}", text(alone), text(together))
    })
}

fn forward() -> Outcome {
    let (mut sources, mut manifest) = project::library_manifest()
        .map_err(|(sources, problems)| render(&sources, &problems, Form::Human))?;
    manifest.programs.retain(|program| program.name == "forward");
    let together = agree(&mut sources, &project::library(), &manifest, STEP)?;
    all_linked(&together)
}

fn all_linked(generated: &Generated) -> Outcome {
    match generated.summary.whole.first() {
        Some(whole) => Err(format!("compiled as a whole: {whole:?}").into()),
        None => Ok(()),
    }
}

/// What is linked has the declarations that naga writes for the whole text, up to their names and
/// their order: the functions all, of the others those that are named. This fails where a version
/// of naga writes a function in a way that depends on its module.
fn whole_and_linked() -> Outcome {
    let folder = tempfile::tempdir()?;
    for (name, manifest, text) in [
        ("traps", TRAPS_MANIFEST, TRAPS),
        ("rows", ROWS_MANIFEST, ROWS),
        ("names", NAMES_MANIFEST, NAMES),
    ] {
        let (mut sources, packages, manifest) = package(folder.path(), name, manifest, text)?;
        compare::all(&mut sources, &packages, &manifest, 1)?;
    }
    let (mut sources, mut manifest) = project::library_manifest()
        .map_err(|(sources, problems)| render(&sources, &problems, Form::Human))?;
    manifest.programs.retain(|program| program.name == "forward");
    // naga's GLSL front end numbers values and orders statements by what its module has, so that
    // texts of GLSL cannot be compared word by word: `frames` and `metal` draw them instead.
    manifest.programs.iter_mut().for_each(|program| program.glsl = None);
    compare::all(&mut sources, &project::library(), &manifest, STEP)
}

/// Names and functions that writers number, rename or add, in as many combinations as there are.
const TRAPS: &str = "
struct Material { color: vec3f, kind: i32, spread: array<vec4f, 3> }
struct Block { items: array<Material, 4>, turn: mat3x3f, counts: vec4i }
struct Carried { @builtin(position) clip: vec4f, @location(0) normal: vec3f, @location(1) @interpolate(flat) index: u32 }
@group(0) @binding(0) var<uniform> block: Block;
@group(0) @binding(1) var<uniform> other: vec4f;
@group(1) @binding(0) var map: texture_2d<f32>;
@group(1) @binding(1) var shadow: texture_depth_2d;
@group(1) @binding(2) var smooth_sampler: sampler;
@group(1) @binding(3) var compare: sampler_comparison;
@group(1) @binding(4) var whole: texture_2d<i32>;
const OFFSETS = array<vec2f, 4>(vec2f(0.1), vec2f(0.2), vec2f(0.3), vec2f(0.4));
const LIMIT: i32 = 7;
var<private> seen: i32;

// Keywords of other languages, and names that shadow declarations.
fn lit(float4: f32, main: f32) -> f32 { let fixed = float4 * main; let tap_3 = fixed + 1.0; return tap_3; }
fn helper(material: Material, lit: f32) -> vec3f { var at = material.color; { let at = lit; return at * material.color; } return at; }
// Functions that the writers add: of two kinds where both are used.
@if(sign == int) fn turned(v: i32, u: vec2i) -> i32 { return -v / (u.x | 1); }
@if(sign == vec) fn turned(v: i32, u: vec2i) -> i32 { let t = -u % vec2i(v | 1); return t.x + abs(t.y); }
@if(sign == both) fn turned(v: i32, u: vec2i) -> i32 { let t = -u / vec2i(3); return -v + t.x + i32(f32(v) * 0.5); }
fn table_4(i: i32) -> vec2f { return OFFSETS[i & 3]; }
fn loops(count: i32) -> f32 {
    var sum = 0.0;
    for (var i = 0; i < count; i++) { for (var j = 0; j < LIMIT; j++) { sum += table_4(i + j).x; } }
    for (var i = 0; i < 2; i++) { sum += f32(i); }
    switch count { case LIMIT: { sum += 1.0; } case 2, 3: { sum -= 1.0; } default: {} }
    return sum;
}
fn fresh(kind: i32) -> Material { return Material(vec3f(1.0), kind, array<vec4f, 3>(vec4f(1.0), vec4f(2.0), vec4f(3.0))); }
fn counted() -> i32 { seen += 1; return seen; }
@if(lookup == one) fn look(at: vec2f) -> f32 { return textureSampleLevel(map, smooth_sampler, at, 0.0).x; }
@if(lookup == two) fn look(at: vec2f) -> f32 { return textureSampleCompareLevel(shadow, compare, at, 0.5) + f32(textureDimensions(map).x); }
@if(lookup == three) fn look(at: vec2f) -> f32 { let size = textureDimensions(whole); return f32(textureLoad(whole, vec2i(at * vec2f(size)), 0).x); }
fn looked(at: vec2f, scale: f32) -> f32 { return scale * look(at); }
fn split(x: f32) -> f32 { let parts = modf(x); return parts.fract + parts.whole; }

@vertex fn vs_main(@location(0) place: vec3f, @builtin(vertex_index) number: u32) -> Carried {
    var out: Carried;
    out.clip = vec4f(place + block.items[number % 4u].color, 1.0);
    @if(sign != both) { out.normal = vec3f(f32(turned(i32(number), vec2i(1)))) + other.xyz; }
    @else { out.normal = fresh(3).color * loops(2); }
    out.index = number;
    return out;
}

@fragment fn fs_main(in: Carried, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let normal = normalize(in.normal);
    var material = block.items[in.index & 3u];
    @if(lookup == one) { material = fresh(turned(material.kind, block.counts.xy)); }
    @if(wide) { material.color *= split(normal.x) * f32(counted()); }
    let lit = lit(normal.x, looked(normal.xy, loops(material.kind)));
    if !front { discard; }
    return vec4f(helper(material, lit) + vec3f((block.turn * normal).xy, other.w), f32(turned(1, vec2i(2))));
}
";

const TRAPS_MANIFEST: &str = r#"
[program.traps]
wesl = "traps.wesl"
[program.traps.axis]
sign = { values = ["int", "vec", "both"] }
lookup = { values = ["one", "two", "three"] }
wide = { values = [false, true] }
"#;

/// What GLSL has no words for: matrices of two rows in blocks, and functions that are newer.
const ROWS: &str = "
struct Block { turn: mat3x2f, counts: vec4i }
@group(0) @binding(0) var<uniform> block: Block;
fn turned(v: vec3f, i: i32) -> vec2f { return block.turn * v + block.turn[i & 1]; }
fn split(x: f32) -> f32 { let parts = frexp(x); return ldexp(parts.fract, parts.exp + 1); }
@vertex fn vs_main(@location(0) place: vec3f) -> @builtin(position) vec4f {
    return vec4f(turned(place, block.counts.x), split(place.z), 1.0);
}
@fragment fn fs_main(@builtin(position) at: vec4f) -> @location(0) vec4f {
    @if(wide) { return vec4f(turned(at.xyz, 1), split(at.x), f32(countOneBits(block.counts.y))); }
    @else { return vec4f(turned(at.zyx, 0), at.xy); }
}
";

const ROWS_MANIFEST: &str = r#"
[program.rows]
wesl = "rows.wesl"
targets = ["spirv", "hlsl", "msl", "wgsl"]
[program.rows.axis]
wide = { values = [false, true] }
"#;

/// Names that mean something else to a writer, and an order of variables that depends on an axis.
const NAMES: &str = "
const MAX: f32 = 4.0;
const scale: f32 = 2.0;
@if(first) const TABLE = vec3u(1u, 2u, 3u);
struct Vertex { @location(0) at: vec2f, @location(1) light: f32 }
struct Float { value: f32, turn: vec2i }
@if(first) @group(0) @binding(0) var<uniform> x: vec4f;
@group(0) @binding(1) var<uniform> y: vec4f;
@if(!first) @group(0) @binding(0) var<uniform> x: vec4f;
@group(0) @binding(2) var<uniform> many: array<vec4f, 3>;
fn bounded(value: f32) -> f32 { return max(value, MAX); }
fn made(value: f32) -> Float { return Float(value, vec2i(1, 2)); }
fn threefold(scale: f32) -> f32 { return scale * 3.0; }
@if(first) fn mixed() -> vec4f { return x - y + f32(TABLE[2]); }
@else fn mixed() -> vec4f { return x + 2.0 * y; }
@if(kind == one || kind == both) fn third(v: f32) -> f32 { return f32(i32(v) / 3); }
@if(kind == two || kind == both) fn thirds(v: f32) -> f32 { return f32((vec2u(u32(v)) / vec2u(3u)).x); }
@if(scaled) fn held(value: f32) -> f32 { return value * scale; }
@else fn held(value: f32) -> f32 { return value; }
@vertex fn vs_main(in: Vertex) -> @builtin(position) vec4f { return mixed() + vec4f(in.at, bounded(in.light), many[1].x); }
@fragment fn fs_main(@location(0) at: vec2f) -> @location(0) vec4f {
    let float = made(at.x);
    var sum = threefold(held(float.value)) + many[float.turn.x].y;
    @if(kind == one || kind == both) { sum += third(sum); }
    @if(kind == two || kind == both) { sum += thirds(sum); }
    return mixed() * sum;
}
";

const NAMES_MANIFEST: &str = r#"
[program.names]
wesl = "names.wesl"
[program.names.axis]
first = { values = [false, true] }
scaled = { values = [false, true] }
kind = { values = ["none", "one", "two", "both"] }
"#;

/// A package of one module in a folder.
fn package(
    folder: &Path,
    name: &str,
    manifest: &str,
    text: &str,
) -> Result<(SourceSet, Packages, Manifest), Failed> {
    std::fs::write(folder.join("lamplight.toml"), manifest)?;
    std::fs::write(folder.join(format!("{name}.wesl")), text)?;
    let mut sources = SourceSet::default();
    let read = (|| {
        let manifest = project::read_manifest(&folder.join("lamplight.toml"), &mut sources)?;
        Ok((project::packages(folder, &mut sources)?, manifest))
    })();
    let (packages, manifest) = read.map_err(|problems: lamplight::diagnostic::Diagnostics| {
        render(&sources, &problems, Form::Human)
    })?;
    Ok((sources, packages, manifest))
}

fn traps() -> Outcome {
    alone_and_together("traps", TRAPS_MANIFEST, TRAPS)?;
    alone_and_together("rows", ROWS_MANIFEST, ROWS)
}

fn names() -> Outcome {
    alone_and_together("names", NAMES_MANIFEST, NAMES)
}

fn alone_and_together(name: &str, manifest: &str, text: &str) -> Outcome {
    let folder = tempfile::tempdir()?;
    let (mut sources, packages, manifest) = package(folder.path(), name, manifest, text)?;
    let mut together = agree(&mut sources, &packages, &manifest, 1)?;
    all_linked(&together)?;
    let contents = std::mem::take(&mut together.contents);
    let out = folder.path().join("out");
    write_directory(&contents, &out)?;
    judge_all(&out)
}

/// Every output of a bundle is well formed.
fn judge_all(out: &Path) -> Outcome {
    let outputs = judge::outputs(lamplight::bundle::blob_files(out)?)?;
    match judge::judge(&outputs, None, &|_, _| ())?.first() {
        None if !outputs.is_empty() => Ok(()),
        refusal => Err(format!("{refusal:?}").into()),
    }
}

/// A program of one fragment shader with something more in it.
fn fragment(more: &str, body: &str) -> String {
    format!(
        "@group(0) @binding(0) var map: texture_2d<f32>; @group(0) @binding(1) var smp: sampler;
@group(0) @binding(2) var<uniform> u: vec4f;
{more}
@fragment fn fs_main(@location(0) at: vec2f) -> @location(0) vec4f {{
    {body}
    return u + textureSampleLevel(map, smp, at, 0.0);
}}"
    )
}

/// Why targets of a program are compiled as a whole.
fn reasons_of(text: &str, targets: &str) -> Result<BTreeMap<String, Reason>, Failed> {
    let folder = tempfile::tempdir()?;
    let manifest = format!("[program.one]\nwesl = \"one.wesl\"\n{targets}\n");
    let (mut sources, packages, manifest) = package(folder.path(), "one", &manifest, text)?;
    let made = made(&mut sources, &packages, &manifest, None)?;
    Ok(made.summary.whole.into_iter().map(|whole| (whole.target, whole.reason)).collect())
}

/// Declarations and statements with which a text is linked.
const LINKED: &[(&str, &str)] = &[
    ("", "let d = dpdx(at.x); if d > 0.0 { discard; }"),
    ("fn f(x: f32) -> f32 { return fwidth(x); }", "let d = f(at.x);"),
    ("fn tap_3(x: f32) -> f32 { return x; }", "let d = tap_3(at.x);"),
    ("fn d(x: f32) -> f32 { return x; }", "let d = d(at.x);"),
    ("", "if at.x > 0.0 { let d = dpdx(at.x); }"),
    ("alias Map = texture_2d<f32>; fn f(m: Map) -> f32 { return 1.0; }", "let d = f(map);"),
    (
        "struct Light { a: f32, b: f32 } fn ConstructLight(x: f32) -> Light { return Light(x, x); }",
        "let d = ConstructLight(1.0);",
    ),
    ("fn member(x: f32) -> f32 { return x; }", "let d = member(1.0);"),
    ("fn fs_mainInput(x: f32) -> f32 { return x; }", "let d = fs_mainInput(1.0);"),
    ("const a = 1.0; struct S { a: f32 }", "let d = S(a);"),
    ("fn naga_f(x: f32) -> f32 { return x; }", "let d = naga_f(1.0);"),
    (
        "fn a_b_(x: f32) -> f32 { return x; } fn a_b(x: f32) -> f32 { return x; }",
        "let d = a_b(1.0) + a_b_(2.0);",
    ),
    ("const other = 0.5;", "let d = modf(at.x * other).fract;"),
    ("const value = 0.5;", "let d = i32(at.x * value);"),
    ("const ret = 0.5; struct Pair { a: f32, b: f32 }", "let d = Pair(at.x, ret);"),
    (
        "alias Color = vec4f; var<private> table: array<Color, 2>;",
        "let d = array<vec4f, 2>(u, u); table = d;",
    ),
    ("fn é(x: f32) -> f32 { return x; }", "let d = é(1.0);"),
    ("const_assert true;", ""),
    ("fn SamplerState(x: f32) -> f32 { return x; }", "let d = SamplerState(1.0);"),
];

/// Declarations and statements with which it is compiled as a whole, and why.
const WHOLE: &[(&str, &str, Reason)] = &[
    ("override o: f32 = 1.0;", "let d = o;", Reason::Override),
    ("@group(0) @binding(3) var<storage> s: array<f32>;", "let d = s[0];", Reason::StorageBuffer),
    (
        "@group(0) @binding(3) var< storage , read > s: vec4f;",
        "let d = s.x;",
        Reason::StorageBuffer,
    ),
    ("fn Zqbqz(x: f32) -> f32 { return x; }", "let d = Zqbqz(1.0);", Reason::MarkedName),
];

fn reasons() -> Outcome {
    for (more, body) in LINKED {
        let reasons = reasons_of(&fragment(more, body), "")?;
        if !reasons.is_empty() {
            return Err(format!("{more} {body}: {reasons:?}").into());
        }
    }
    for (more, body, reason) in WHOLE {
        // Not every target has storage buffers.
        let targets = "targets = [\"spirv\", \"wgsl\"]";
        let reasons = reasons_of(&fragment(more, body), targets)?;
        if reasons.len() != 2 || reasons.values().any(|found| found != reason) {
            return Err(format!("{more} {body}: {reasons:?} instead of {reason:?}").into());
        }
    }
    Ok(())
}

/// A derivative where fragments have parted is warned of, for the permutation alone and among others.
fn warnings() -> Outcome {
    let text = "
@group(0) @binding(0) var map: texture_2d<f32>;
@group(0) @binding(1) var smp: sampler;
@if(parted) fn far(at: vec2f) -> bool { return at.x > 0.5; }
@else fn far(at: vec2f) -> bool { return true; }
fn sampled(at: vec2f) -> vec4f { if far(at) { return textureSample(map, smp, at); } return vec4f(); }
@fragment fn fs_main(@location(0) at: vec2f) -> @location(0) vec4f { return sampled(at); }
";
    let manifest =
        "[program.small]\nwesl = \"small.wesl\"\naxis.parted = { values = [false, true] }\n";
    let folder = tempfile::tempdir()?;
    let (mut sources, packages, manifest) = package(folder.path(), "small", manifest, text)?;
    let together = made(&mut sources, &packages, &manifest, None)?.warnings.len();
    let alone = made(&mut sources, &packages, &manifest, Some("parted"))?.warnings.len();
    if (together, alone) == (1, 1) {
        Ok(())
    } else {
        Err(format!("{together} warnings together, {alone} alone").into())
    }
}

/// Makes a program of one file in some targets, and has every output judged.
fn judged(text: &str, targets: &str) -> Result<Generated, Failed> {
    let folder = tempfile::tempdir()?;
    let manifest = format!("[program.one]\nwesl = \"one.wesl\"\n{targets}\n");
    let (mut sources, packages, manifest) = package(folder.path(), "one", &manifest, text)?;
    let mut made = made(&mut sources, &packages, &manifest, None)?;
    let contents = std::mem::take(&mut made.contents);
    let out = folder.path().join("out");
    write_directory(&contents, &out)?;
    judge_all(&out)?;
    made.contents = contents;
    Ok(made)
}

/// naga adds to an entry point that ends with a digit, and the manifest says what it is called; a
/// variable and a parameter that become the same are told apart.
fn entry_points() -> Outcome {
    let text = "
@group(0) @binding(0) var<uniform> metal_2: vec4f;
fn read() -> vec4f { return metal_2; }
@fragment fn metal_2_(@location(0) metal_2: vec2f) -> @location(0) vec4f { return read() + metal_2.xyxy; }
@vertex fn main_1() -> @builtin(position) vec4f { return vec4f(); }
";
    let made = judged(text, "")?;
    for ((entry, _), unit) in units(&made) {
        let wgsl = &unit.targets["wgsl"];
        let (text, name) = (String::from_utf8_lossy(&wgsl.bytes), &wgsl.native.entry_name);
        let declared = format!("fn {name}(");
        if text.matches(&declared).count() != 1 || text.contains("var<uniform> metal_2_:") {
            return Err(format!("{entry} is told as `{name}`:\n{text}").into());
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

/// Names of an author's that naga's helpers have, or that its lists of words lack.
fn kept_names() -> Outcome {
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
    judged(text, "").map(|_| ())
}

/// HLSL has a structure for such a matrix in another structure, whose name stands at its end.
fn matrices_of_two_rows() -> Outcome {
    let text = "
struct Turns { all: array<mat3x2f, 4>, one: mat4x2f }
var<private> turns: Turns;
@fragment fn fs_main(@location(0) at: vec2f) -> @location(0) vec4f {
    turns.one = mat4x2f(at, at, at, at);
    return vec4f(turns.one * at.xyxy, at);
}
@vertex fn vs_main() -> @builtin(position) vec4f { return vec4f(); }
";
    let made = judged(text, "")?;
    let whole = units(&made).into_values().filter_map(|unit| unit.targets.get("hlsl"));
    let texts: Vec<String> =
        whole.map(|artifact| String::from_utf8_lossy(&artifact.bytes).into_owned()).collect();
    match texts.iter().any(|text| text.contains("} __mat3x2_f32;")) {
        true => Ok(()),
        false => Err(format!("the structure lacks its name: {texts:?}").into()),
    }
}

/// A function that GLSL 3.30 lacks is refused in its line, for those targets alone.
fn lacking() -> Outcome {
    let text = "
@fragment fn fs_main(@location(0) at: vec2f) -> @location(0) vec4f {
    return vec4f(ldexp(at.x, 2), f32(countOneBits(u32(at.y))), 0.0, 0.0);
}
@vertex fn vs_main() -> @builtin(position) vec4f { return vec4f(); }
";
    judged(text, r#"targets = ["spirv", "glsl450", "hlsl", "msl", "wgsl"]"#)?;
    for target in ["glsl330", "essl300"] {
        let targets = format!("targets = [\"{target}\"]");
        let Err(refused) = judged(text, &targets) else {
            return Err(format!("{target} has neither `ldexp` nor `bitCount`").into());
        };
        let words = refused.message().unwrap_or_default().to_owned();
        for word in ["`ldexp`", "`bitCount`", "one.wesl:3:"] {
            if !words.contains(word) {
                return Err(format!("{target}: no {word} in:\n{words}").into());
            }
        }
    }
    Ok(())
}
