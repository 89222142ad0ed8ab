//! Texture lookups within one image have a fast path. Runs with error bounds ([`Bounded`]) never
//! take it, so the two paths are compared: their values must be bit-identical.

use std::sync::Arc;

use super::lockstep::Dice;
use super::program;
use lamplight_eval::{
    Address, Bounded, Compare, Filter, Machine, Number, Resources, Sampler, Texels, Texture,
    TextureDimension,
};
use libtest_mimic::{Failed, Trial};

/// How many sets of textures and samplers there are, and how many lookups of each function.
const SETS: u32 = 60;
const LOOKUPS: u32 = 60;

const SHADER: &str = "
@group(0) @binding(0) var flat: texture_2d<f32>;
@group(0) @binding(1) var smp: sampler;
@group(0) @binding(2) var layers: texture_2d_array<f32>;
@group(0) @binding(3) var cube: texture_cube<f32>;
@group(0) @binding(4) var depth: texture_depth_2d;
@group(0) @binding(5) var depth_cube: texture_depth_cube;
@group(0) @binding(6) var cmp: sampler_comparison;
@group(0) @binding(7) var volume: texture_3d<f32>;
fn of_flat(p: vec3f, i: i32) -> vec4f { return textureSampleLevel(flat, smp, p.xy, p.z); }
fn moved(p: vec3f, i: i32) -> vec4f { return textureSampleLevel(flat, smp, p.xy, p.z, vec2i(-3, 2)); }
fn of_layer(p: vec3f, i: i32) -> vec4f { return textureSampleLevel(layers, smp, p.xy, i, p.z); }
fn of_cube(p: vec3f, i: i32) -> vec4f { return textureSampleLevel(cube, smp, p, f32(i) / 2.0); }
fn of_volume(p: vec3f, i: i32) -> vec4f { return textureSampleLevel(volume, smp, p, 0.0); }
fn of_depth(p: vec3f, i: i32) -> vec4f { return vec4f(textureSampleCompareLevel(depth, cmp, p.xy, p.z)); }
fn of_depths(p: vec3f, i: i32) -> vec4f { return vec4f(textureSampleCompareLevel(depth_cube, cmp, p, 0.5)); }
fn gathered(p: vec3f, i: i32) -> vec4f { return textureGather(1, flat, smp, p.xy); }
";

pub fn tests() -> Vec<Trial> {
    vec![Trial::test("eval/filters", compare_ways)]
}

fn compare_ways() -> Result<(), Failed> {
    let program = program(SHADER)?;
    let mut dice = Dice(4711);
    let mut different = 0;
    for set in 0..SETS {
        let resources = random_resources(&mut dice);
        let mut short = Machine::<f64>::new(&program)?;
        let mut long = Machine::<Bounded>::new(&program)?;
        short.bind(resources.clone())?;
        long.bind(resources)?;
        for (id, function) in program.functions() {
            for _ in 0..LOOKUPS {
                let place: [f64; 3] = std::array::from_fn(|_| random_place(&mut dice));
                let layer = dice.roll(4);
                let given = |place: f64| f64::from(place as f32);
                let [x, y, z] = place.map(given);
                let found = short.call(id, &[x, y, z, f64::from_word(layer)])?.to_vec();
                let numbers = [x, y, z].map(Bounded::from_f64);
                let [x, y, z] = numbers;
                let wanted = long.call(id, &[x, y, z, Bounded::from_word(layer)])?;
                let same = |(found, wanted): (&f64, &Bounded)| {
                    let wanted = wanted.value();
                    found.to_bits() == wanted.to_bits() || found.is_nan() && wanted.is_nan()
                };
                if !found.iter().zip(wanted).all(same) {
                    let name = &function.name;
                    return Err(format!(
                        "set {set}: {name}{place:?}, layer {layer}: {found:?}, wanted {wanted:?}"
                    )
                    .into());
                }
                different += u32::from(found.iter().any(|value| *value != found[0]));
            }
        }
    }
    assert!(different > SETS * LOOKUPS, "the textures have too little in them");
    Ok(())
}

/// A texture coordinate: mostly inside of the texture, but also far outside, at its edges, infinite
/// or NaN.
fn random_place(dice: &mut Dice) -> f64 {
    let fine = f64::from(dice.roll(10_000)) / 10_000.0;
    match dice.roll(14) {
        0 => f64::INFINITY,
        1 => f64::NEG_INFINITY,
        2 => f64::NAN,
        3 => 0.0,
        4 => 1.0,
        5 => -1.0,
        6 => 1e30 * (fine - 0.5),
        7 | 8 => 8.0 * (fine - 0.5),
        9 => f64::from(dice.roll(9)) / 8.0,
        10 => -fine,
        _ => fine,
    }
}

fn random_resources(dice: &mut Dice) -> Resources {
    let filter = |dice: &mut Dice| [Filter::Nearest, Filter::Linear][dice.roll(2) as usize];
    let address =
        |dice: &mut Dice| [Address::Clamp, Address::Repeat, Address::Mirror][dice.roll(3) as usize];
    let sampler = Sampler {
        address: [address(dice), address(dice), address(dice)],
        mag: filter(dice),
        min: filter(dice),
        mipmap: filter(dice),
        levels: (0.0, 32.0),
        compare: None,
    };
    let compare = [Compare::LessEqual, Compare::Greater, Compare::NotEqual][dice.roll(3) as usize];
    let comparison = Sampler { compare: Some(compare), ..sampler };
    let (width, height) = (1 + dice.roll(7), 1 + dice.roll(7));
    let edge = 1 + dice.roll(5);
    let textures = [
        (0, chain(dice, TextureDimension::D2, [width, height, 1])),
        (2, chain(dice, TextureDimension::D2, [width, height, 3])),
        (3, chain(dice, TextureDimension::Cube, [edge, edge, 6])),
        (4, random_texture(dice, TextureDimension::D2, [width, height, 1], 1)),
        (5, random_texture(dice, TextureDimension::Cube, [edge, edge, 6], 1)),
        (7, random_texture(dice, TextureDimension::D3, [width, height, 2], 4)),
    ];
    Resources {
        buffers: [].into(),
        textures: textures.map(|(binding, texture)| ((0, binding), texture)).into(),
        samplers: [((0, 1), sampler), ((0, 6), comparison)].into(),
    }
}

/// A texture of two levels.
fn chain(dice: &mut Dice, shape: TextureDimension, [width, height, layers]: [u32; 3]) -> Texture {
    let count = 1 + dice.roll(4) as usize;
    let mut texture = random_texture(dice, shape, [width, height, layers], count);
    let half = [width.div_ceil(2), height.div_ceil(2), layers];
    texture.levels.extend(random_texture(dice, shape, half, count).levels);
    texture
}

/// Texels of `count` components, in one of the two forms of [`Texels`]. Some are negative zeros.
fn random_texture(
    dice: &mut Dice,
    shape: TextureDimension,
    [width, height, layers]: [u32; 3],
    count: usize,
) -> Texture {
    let all = count * (width * height * layers) as usize;
    let values: Vec<f32> = (0..all)
        .map(|_| if dice.roll(9) == 0 { -0.0 } else { dice.roll(999) as f32 / 999.0 })
        .collect();
    let mut texture = Texture::of(shape, width, height, layers, Texels::Channels { count, values });
    if dice.roll(2) == 0 {
        let whole = texture.levels[0].texels.iter().collect();
        texture.levels[0].texels = Arc::new(Texels::Whole(whole));
    }
    texture
}
