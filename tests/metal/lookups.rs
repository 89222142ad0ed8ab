//! Lookups in textures, and derivatives: the emitted MSL, run on the CPU, must give the evaluator's
//! results for the same quads.

use std::fs;
use std::path::{Path, PathBuf};

use lamplight::bundle::{BindingKind, Language, Native, Reflection, Target};
use lamplight::compose::Composed;
use lamplight::emit;
use lamplight::eval::{
    self, Address, Compare, Filter, Machine, MipLevel, Number, Resources, Sampler, Texels, Texture,
    TextureDimension,
};
use lamplight::execute::compiled::CompiledProgram;
use lamplight::execute::compiled::request::{FragmentInput, MetalResources};
use lamplight::validate::{Validated, validate};

use super::{Outcome, fail_with, scrambled};

/// The number of quads for each text and each variant of samplers.
const QUADS: u32 = 64;
/// The largest relative error. Both sides compute lookups in f64, and sums of them in f32.
const SHARE: f64 = 2e-6;

struct Text {
    name: String,
    validated: Validated,
    reflection: Reflection,
    native: Native,
    emitted: String,
}

pub fn compare(files: &[PathBuf]) -> Outcome {
    let texts = files.iter().map(|file| read(file)).collect::<Result<Vec<_>, _>>()?;
    let emitted: Vec<&str> = texts.iter().map(|text| text.emitted.as_str()).collect();
    let mut program = CompiledProgram::build(&emitted).map_err(|missing| missing.reason)?;
    let mut wrong = Vec::new();
    for (index, text) in texts.iter().enumerate() {
        for variant in 0..12 {
            if let Err(error) = agrees(&mut program, index, text, variant) {
                wrong.push(format!("{}, variant {variant}: {error}", text.name));
            }
        }
    }
    fail_with(&wrong)
}

fn read(file: &Path) -> Result<Text, String> {
    let text = fs::read_to_string(file).map_err(|error| error.to_string())?;
    let composed = Composed::of_text(Language::Wesl, None, text);
    let validated = validate(&composed).map_err(|errors| format!("{errors:?}"))?;
    let reflection = emit::reflect(&validated, "fs").map_err(|error| error.message)?;
    let emitted = emit::emit(&validated, "fs", Target::MSL).map_err(|error| error.message)?;
    Ok(Text {
        name: file.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
        validated,
        reflection,
        native: emitted.native,
        emitted: String::from_utf8(emitted.bytes).map_err(|error| error.to_string())?,
    })
}

fn agrees(
    program: &mut CompiledProgram,
    index: usize,
    text: &Text,
    variant: u32,
) -> Result<(), String> {
    let resources = resources(&text.reflection, variant);
    let bound = MetalResources::new(&resources, &text.native, &text.reflection);
    let quads: Vec<[FragmentInput; 4]> = (0..QUADS).map(|quad| quad_of(quad, variant)).collect();
    let found = program.quads(index, &bound, &quads)?;
    let evaluated = eval::Program::new(&text.validated.module, &text.validated.info)
        .map_err(|error| error.to_string())?;
    let function = evaluated.function("fs").ok_or("no entry point")?;
    let mut machine = Machine::<f32>::new(&evaluated).map_err(|error| error.to_string())?;
    machine.bind(resources).map_err(|error| error.to_string())?;
    for (quad, found) in quads.iter().zip(found) {
        let arguments = quad.each_ref().map(|fragment| {
            fragment
                .locations
                .iter()
                .flatten()
                .map(|word| f32::from_bits(*word))
                .collect::<Vec<_>>()
        });
        let wanted = machine
            .quad(function, arguments.each_ref().map(Vec::as_slice))
            .map_err(|error| error.to_string())?;
        for lane in 0..4 {
            let given = found[lane].targets[0].map(f32::from_bits);
            let is_off = |i: usize| {
                let (given, wanted) = (f64::from(given[i]), wanted[lane][i].value());
                (given - wanted).is_nan() || (given - wanted).abs() > SHARE * (wanted.abs() + 40.0)
            };
            if (0..4).any(is_off) {
                let arguments = &arguments[lane];
                return Err(format!("{arguments:?} gives {given:?}, expected {:?}", wanted[lane]));
            }
        }
    }
    Ok(())
}

/// Four fragments whose inputs differ by a random step, so that derivatives select different levels.
fn quad_of(quad: u32, variant: u32) -> [FragmentInput; 4] {
    let random = |place: u32| {
        f64::from(scrambled(place + 100 * quad + 100_000 * variant)) / f64::from(u32::MAX)
    };
    let step = 0.2 * random(99);
    [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)].map(|(x, y)| {
        let value = |place: u32| {
            let moved = step * (x * (random(place + 20) - 0.5) + y * (random(place + 40) - 0.5));
            ((random(place) * 2.0 - 0.5 + moved) as f32).to_bits()
        };
        let location = |first: u32| std::array::from_fn(|i| value(first + i as u32));
        FragmentInput { locations: vec![location(0), location(4)], ..FragmentInput::default() }
    })
}

/// A resource for every binding. The variant decides sizes, texels, filters and address modes.
fn resources(reflection: &Reflection, variant: u32) -> Resources {
    let mut resources = Resources::default();
    for (index, binding) in reflection.bindings.iter().enumerate() {
        let (place, seed) = ((binding.group, binding.binding), 1000 * variant + 50 * index as u32);
        match binding.kind {
            BindingKind::Uniform => {
                let number = |i| (f64::from(scrambled(seed + i)) / f64::from(u32::MAX)) as f32;
                let bytes = (0..4).flat_map(|i| number(i).to_le_bytes()).collect();
                drop(resources.buffers.insert(place, bytes));
            }
            BindingKind::Sampler => {
                let _ = resources.samplers.insert(place, sampler(variant, false));
            }
            BindingKind::ComparisonSampler => {
                let _ = resources.samplers.insert(place, sampler(variant, true));
            }
            _ => drop(resources.textures.insert(place, texture(&binding.ty, seed, variant))),
        }
    }
    resources
}

fn sampler(variant: u32, compares: bool) -> Sampler {
    let filter = |bit: u32| if variant >> bit & 1 == 0 { Filter::Nearest } else { Filter::Linear };
    let addresses = [Address::Clamp, Address::Repeat, Address::Mirror];
    let address = |shift: u32| addresses[((variant + shift) % 3) as usize];
    let comparisons = [
        Compare::LessEqual,
        Compare::Less,
        Compare::Greater,
        Compare::GreaterEqual,
        Compare::NotEqual,
        Compare::Equal,
    ];
    Sampler {
        address: [address(0), address(1), address(0)],
        mag: filter(0),
        min: filter(if compares { 0 } else { 1 }),
        mipmap: filter(2),
        levels: if variant % 5 == 4 { (0.5, 1.5) } else { (0.0, 32.0) },
        compare: compares.then(|| comparisons[(variant % 6) as usize]),
    }
}

fn texture(ty: &str, seed: u32, variant: u32) -> Texture {
    let shape = match ty {
        _ if ty.contains("_1d") => TextureDimension::D1,
        _ if ty.contains("_3d") => TextureDimension::D3,
        _ if ty.contains("cube") => TextureDimension::Cube,
        _ => TextureDimension::D2,
    };
    let (width, height) = match shape {
        TextureDimension::D1 => (7, 1),
        TextureDimension::Cube => (8, 8),
        _ => (9, 6),
    };
    let layers = match (shape, ty.contains("array")) {
        (TextureDimension::D3, _) => 5,
        (TextureDimension::Cube, true) => 12,
        (TextureDimension::Cube, false) => 6,
        (_, true) => 3,
        (_, false) => 1,
    };
    // naga writes a comparison in level 0 without the level, so Metal derives the level from
    // neighbouring fragments. The results agree only if there is one level and one filter.
    let is_single = shape == TextureDimension::D1 || ty.contains("depth") || variant % 4 == 3;
    let count = if is_single { 1 } else { 3 };
    let level = |level: u32| {
        let half = |size: u32| (size >> level).max(1);
        let depth = if shape == TextureDimension::D3 { half(layers) } else { layers };
        let (width, height) = (half(width), half(height));
        let texels = (0..width * height * depth).map(|texel| {
            std::array::from_fn(|i| {
                value(ty, scrambled(seed + 7919 * (4 * texel + i as u32) + level))
            })
        });
        MipLevel {
            width,
            height,
            layers: depth,
            texels: std::sync::Arc::new(Texels::Whole(texels.collect())),
        }
    };
    Texture { shape, levels: (0..count).map(level).collect() }
}

/// A component of a texel, in the number type of the texture.
fn value(ty: &str, word: u32) -> f64 {
    match ty {
        _ if ty.contains("u32") => f64::from(word),
        _ if ty.contains("i32") => f64::from(word as i32 >> 16),
        _ => f64::from((f64::from(word) / f64::from(u32::MAX)) as f32),
    }
}
