//! Compares lookups in textures and buffers with values that were computed by hand.

use super::program;
use lamplight_eval::{
    Address, Compare, Filter, FindingKind, Machine, Resources, Sampler, Texture, TextureDimension,
};
use libtest_mimic::{Failed, Trial};

const SHADER: &str = "
@group(0) @binding(0) var flat: texture_2d<f32>;
@group(0) @binding(1) var smp: sampler;
@group(0) @binding(2) var depth: texture_depth_2d;
@group(0) @binding(3) var cmp: sampler_comparison;
@group(0) @binding(4) var layers: texture_2d_array<f32>;
@group(0) @binding(5) var cube: texture_cube<f32>;
@group(0) @binding(6) var words: texture_2d<u32>;
@group(0) @binding(7) var<uniform> u: Uniforms;
@group(0) @binding(8) var<storage> s: array<vec3f>;
@group(0) @binding(9) var chain: texture_2d<f32>;
@group(0) @binding(10) var missing: texture_2d<f32>;
struct Uniforms { a: f32, v: vec3f, m: mat3x3f, l: array<vec4f, 2> }

fn sample_flat(uv: vec2f) -> f32 { return textureSampleLevel(flat, smp, uv, 0.0).x; }
fn through(t: texture_2d<f32>, s: sampler, uv: vec2f) -> f32 { return textureSampleLevel(t, s, uv, 0.0).x; }
fn passed(uv: vec2f) -> f32 { return through(flat, smp, uv); }
fn offset(uv: vec2f) -> f32 { return textureSampleLevel(flat, smp, uv, 0.0, vec2i(1, 0)).x; }
fn compare(uv: vec2f, r: f32) -> f32 { return textureSampleCompareLevel(depth, cmp, uv, r); }
fn raw(x: i32, y: i32) -> f32 { return textureLoad(depth, vec2i(x, y), 0); }
fn gather(uv: vec2f) -> vec4f { return textureGather(0, flat, smp, uv); }
fn gather_compare(uv: vec2f, r: f32) -> vec4f { return textureGatherCompare(depth, cmp, uv, r); }
fn layer(uv: vec2f, i: i32) -> f32 { return textureSampleLevel(layers, smp, uv, i, 0.0).x; }
fn side(d: vec3f) -> f32 { return textureSampleLevel(cube, smp, d, 0.0).x; }
fn word(x: u32) -> u32 { return textureLoad(words, vec2u(x, 0u), 0).x; }
fn sizes() -> vec4u { return vec4u(textureDimensions(flat), textureNumLayers(layers), textureNumLevels(chain)); }
fn uniforms() -> vec4f { return vec4f(u.a, u.v.z, u.m[1].y, u.l[1].w); }
fn stored(i: u32) -> vec2f { return vec2f(s[i].y, f32(arrayLength(&s))); }
fn level(uv: vec2f, l: f32) -> f32 { return textureSampleLevel(chain, smp, uv, l).x; }
fn implicit(uv: vec2f) -> f32 { return textureSample(chain, smp, uv).x; }
fn grad(uv: vec2f, d: f32) -> f32 { return textureSampleGrad(chain, smp, uv, vec2f(d, 0), vec2f(0, 0)).x; }
fn none() -> f32 { return textureLoad(missing, vec2i(0), 0).x; }

struct Out { @builtin(position) p: vec4f, @location(0) n: vec3f }
@vertex fn vs(@builtin(vertex_index) i: u32, @location(0) p: vec3f) -> Out { return Out(vec4f(p, f32(i)), p * u.a); }
@fragment fn fs(@location(0) n: vec3f, @builtin(front_facing) f: bool) -> @location(0) vec4f {
    if !f { discard; }
    return vec4f(n, 1);
}
";

/// The function, whether filtering is linear, whether addresses repeat, the arguments, the result.
type Case = (&'static str, bool, bool, &'static [f64], &'static [f64]);

const CASES: &[Case] = &[
    ("sample_flat", false, false, &[0.2, 0.2], &[1.0]),
    ("sample_flat", false, false, &[0.8, 0.2], &[2.0]),
    ("sample_flat", false, false, &[0.2, 0.8], &[3.0]),
    ("sample_flat", false, false, &[-3.0, 9.0], &[3.0]),
    ("sample_flat", false, true, &[1.2, -0.2], &[3.0]),
    ("sample_flat", true, false, &[0.5, 0.5], &[2.5]),
    ("sample_flat", true, false, &[0.25, 0.25], &[1.0]),
    ("sample_flat", true, false, &[0.375, 0.25], &[1.25]),
    ("sample_flat", true, true, &[0.0, 0.25], &[1.5]),
    ("passed", true, false, &[0.5, 0.25], &[1.5]),
    ("offset", false, false, &[0.2, 0.2], &[2.0]),
    ("compare", true, false, &[0.5, 0.5, 0.5], &[0.5]),
    ("compare", true, false, &[0.5, 0.25, 0.5], &[0.5]),
    ("compare", true, false, &[0.25, 0.25, 0.5], &[0.0]),
    ("compare", true, false, &[0.75, 0.25, 0.5], &[1.0]),
    ("gather", true, false, &[0.5, 0.5], &[3.0, 4.0, 2.0, 1.0]),
    ("gather_compare", true, false, &[0.5, 0.5, 0.5], &[0.0, 1.0, 1.0, 0.0]),
    ("side", false, false, &[1.0, 0.2, 0.3], &[0.0]),
    ("side", false, false, &[-1.0, 0.2, 0.3], &[1.0]),
    ("side", false, false, &[0.1, 2.0, 0.3], &[2.0]),
    ("side", false, false, &[0.1, -2.0, 0.3], &[3.0]),
    ("side", false, false, &[0.1, 0.2, 0.3], &[4.0]),
    ("side", false, false, &[0.1, 0.2, -0.3], &[5.0]),
    // Halfway between +x and +z, the result is the mean of both faces.
    ("side", true, false, &[1.0, 0.0, 1.0], &[2.0]),
    // At a corner, where three faces meet, the result is their mean.
    ("side", true, false, &[1.0, 1.0, 1.0], &[2.0]),
    ("side", true, false, &[-1.0, -1.0, -1.0], &[3.0]),
    ("uniforms", false, false, &[], &[1.0, 7.0, 14.0, 28.0]),
    ("level", false, false, &[0.5, 0.5, 0.0], &[10.0]),
    ("level", false, false, &[0.5, 0.5, 1.0], &[20.0]),
    ("level", false, false, &[0.5, 0.5, 9.0], &[30.0]),
    ("level", true, false, &[0.5, 0.5, 0.5], &[15.0]),
    ("grad", true, false, &[0.5, 0.5, 0.5], &[20.0]),
    ("grad", true, false, &[0.5, 0.5, 0.25], &[10.0]),
];

pub fn tests() -> Vec<Trial> {
    let cases = CASES.iter().map(|case| {
        let name = format!(
            "eval/textures/{}({:?}){}{}",
            case.0,
            case.3,
            if case.1 { " linear" } else { "" },
            if case.2 { " repeat" } else { "" }
        );
        Trial::test(name, || check(case))
    });
    cases
        .chain([
            Trial::test("eval/textures/words", words),
            Trial::test("eval/textures/quad", quad),
            Trial::test("eval/entry_points", entries),
        ])
        .collect()
}

fn gray(values: &[f64]) -> Vec<[f64; 4]> {
    values.iter().map(|value| [*value, 0.0, 0.0, 1.0]).collect()
}

fn resources(linear: bool, repeat: bool) -> Resources {
    let filter = if linear { Filter::Linear } else { Filter::Nearest };
    let address = [if repeat { Address::Repeat } else { Address::Clamp }; 3];
    let sampler = Sampler {
        address,
        mag: filter,
        min: filter,
        mipmap: filter,
        levels: (0.0, 32.0),
        compare: None,
    };
    let mut chain = Texture::flat(TextureDimension::D2, 4, 4, 1, gray(&[10.0; 16]));
    chain.levels.extend(Texture::flat(TextureDimension::D2, 2, 2, 1, gray(&[20.0; 4])).levels);
    chain.levels.extend(Texture::flat(TextureDimension::D2, 1, 1, 1, gray(&[30.0])).levels);
    let faces: Vec<f64> = (0..6).flat_map(|face| [f64::from(face); 16]).collect();
    let bytes =
        |count: u16| (0..count).flat_map(|word| f32::from(word).to_le_bytes()).collect::<Vec<u8>>();
    // The words of the uniform buffer are 1, 2, 3 and so on, so that a value tells its offset.
    let counted = (1..=28u16).flat_map(|word| f32::from(word).to_le_bytes()).collect::<Vec<u8>>();
    Resources {
        buffers: [((0, 7), counted), ((0, 8), bytes(12))].into(),
        textures: [
            ((0, 0), Texture::flat(TextureDimension::D2, 2, 2, 1, gray(&[1.0, 2.0, 3.0, 4.0]))),
            ((0, 2), Texture::flat(TextureDimension::D2, 2, 2, 1, gray(&[0.2, 0.8, 0.3, 0.9]))),
            ((0, 4), Texture::flat(TextureDimension::D2, 1, 1, 3, gray(&[5.0, 6.0, 7.0]))),
            ((0, 5), Texture::flat(TextureDimension::Cube, 4, 4, 6, gray(&faces))),
            ((0, 6), Texture::flat(TextureDimension::D2, 2, 1, 1, gray(&[4294967295.0, 7.0]))),
            ((0, 9), chain),
        ]
        .into(),
        samplers: [
            ((0, 1), sampler),
            ((0, 3), Sampler { compare: Some(Compare::LessEqual), ..sampler }),
        ]
        .into(),
    }
}

fn check((name, linear, repeat, arguments, wanted): &Case) -> Result<(), Failed> {
    let program = program(SHADER)?;
    let mut machine = Machine::<f64>::new(&program)?;
    machine.bind(resources(*linear, *repeat))?;
    let found = machine.call(program.function(name).ok_or("function")?, arguments)?;
    let near = found.len() == wanted.len()
        && found.iter().zip(*wanted).all(|(found, wanted)| (found - wanted).abs() < 1e-9);
    if near { Ok(()) } else { Err(format!("found {found:?}, wanted {wanted:?}").into()) }
}

/// Functions called with words: loads of exact values, and a load out of bounds, which is clamped
/// and gives a finding. A texture that is not bound is an error.
fn words() -> Result<(), Failed> {
    let program = program(SHADER)?;
    let mut machine = Machine::<f32>::new(&program)?;
    machine.bind(resources(false, false))?;
    let mut call = |name: &str, arguments: &[u32]| -> Result<Vec<u32>, Failed> {
        let mut result = Vec::new();
        machine.call_words(program.function(name).ok_or("function")?, arguments, &mut result)?;
        Ok(result)
    };
    assert_eq!(call("word", &[0])?, [u32::MAX]);
    assert_eq!(call("word", &[5])?, [0]);
    assert_eq!(call("sizes", &[])?, [2, 2, 3, 3]);
    assert_eq!(call("layer", &[0, 0, 2])?, [7f32.to_bits()]);
    assert_eq!(call("raw", &[1, 0])?, [0.8f32.to_bits()]);
    assert_eq!(call("stored", &[1])?, [5f32.to_bits(), 3f32.to_bits()]);
    assert_eq!(call("stored", &[9])?, [9f32.to_bits(), 3f32.to_bits()]);
    assert_eq!(
        machine.findings().iter().map(|finding| finding.kind).collect::<Vec<_>>(),
        [FindingKind::OutOfBounds]
    );
    let none = machine.call(program.function("none").ok_or("none")?, &[]).map(<[f32]>::to_vec);
    assert_eq!(none.map_err(|error| error.code.name), Err("eval-unbound"));
    Ok(())
}

/// The level of detail comes from the differences within a quad. A step of half the texture is two
/// of its four texels, which gives level 1. A call of one lane has no differences, so level 0.
fn quad() -> Result<(), Failed> {
    let program = program(SHADER)?;
    let mut machine = Machine::<f64>::new(&program)?;
    machine.bind(resources(true, false))?;
    let implicit = program.function("implicit").ok_or("implicit")?;
    let wanted: [Vec<f64>; 4] = std::array::from_fn(|_| vec![20.0]);
    assert_eq!(
        machine.quad(implicit, [&[0.0, 0.0], &[0.5, 0.0], &[0.0, 0.25], &[0.5, 0.25]])?,
        wanted
    );
    assert_eq!(machine.call(implicit, &[0.3, 0.3])?, &[10.0]);
    Ok(())
}

/// Entry points: the locations of inputs and outputs, the results, and `discard`.
fn entries() -> Result<(), Failed> {
    let program = program(SHADER)?;
    let mut machine = Machine::<f64>::new(&program)?;
    machine.bind(resources(false, false))?;
    let (vs, fs) = (program.function("vs").ok_or("vs")?, program.function("fs").ok_or("fs")?);
    let location = |binding: &Option<naga::Binding>| match binding {
        Some(naga::Binding::Location { location, .. }) => Some(*location),
        _ => None,
    };
    let signature = program.signature(vs).ok_or("vs")?;
    assert_eq!(
        signature.inputs.iter().map(location).collect::<Vec<_>>(),
        [None, Some(0), Some(0), Some(0)]
    );
    assert_eq!(
        signature.outputs.iter().map(location).collect::<Vec<_>>(),
        [None, None, None, None, Some(0), Some(0), Some(0)]
    );
    let index = <f64 as lamplight_eval::Number>::from_word(3);
    assert_eq!(machine.call(vs, &[index, 4.0, 5.0, 6.0])?, &[4.0, 5.0, 6.0, 3.0, 4.0, 5.0, 6.0]);
    let front = <f64 as lamplight_eval::Number>::from_word(1);
    assert_eq!(machine.call(fs, &[1.0, 2.0, 3.0, front])?, &[1.0, 2.0, 3.0, 1.0]);
    assert!(!machine.discarded(), "a fragment of a front face is kept");
    machine.call(fs, &[1.0, 2.0, 3.0, 0.0])?;
    assert!(machine.discarded(), "a fragment of a back face is discarded");
    Ok(())
}
