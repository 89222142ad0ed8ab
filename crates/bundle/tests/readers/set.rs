//! The bundle that all readers read: a program with each kind of axis, and what shaders can have.

use std::collections::BTreeMap;
use std::sync::Arc;

use lamplight_bundle::{
    Access, Artifact, Axis, Binding, BindingKind, BindingSlot, Combined, Contents, EntryContents,
    Language, Member, Native, Override, OverrideChoice, Pair, ProgramContents, Reflection,
    SampleType, Shape, Stage, TextureShape, Unit, Varying,
};

/// All of it.
pub fn contents() -> Contents {
    let blank = ProgramContents {
        axes: Vec::new(),
        languages: BTreeMap::from([(
            Language::Glsl,
            BTreeMap::from([("main".to_owned(), EntryContents::default())]),
        )]),
    };
    let programs = [("blank", blank), ("lit", lit()), ("write", write())];
    Contents {
        programs: programs.into_iter().map(|(name, made)| (name.to_owned(), made)).collect(),
        shard: None,
    }
}

fn axis(name: &str, values: &[&str], default: &str, mode: &str) -> Axis {
    Axis {
        name: name.to_owned(),
        values: values.iter().map(|value| (*value).to_owned()).collect(),
        default: default.to_owned(),
        mode: mode.to_owned(),
    }
}

/// Keys that differ in one axis, in two, and in a `spec` axis; without `fog,shadow=hard`.
fn lit() -> ProgramContents {
    let axes = vec![
        axis("shadow", &["none", "hard"], "none", "static"),
        axis("fog", &["false", "true"], "false", "static"),
        axis("taps", &["-4", "4", "8"], "4", "spec"),
        axis("exposure", &["1", "2"], "1", "dynamic"),
    ];
    let (mut vertex, mut fragment) = (EntryContents::default(), EntryContents::default());
    for key in ["default", "fog", "fog,taps=8", "shadow=hard", "shadow=hard,taps=-4", "taps=8"] {
        add_key(&mut vertex, key, vertex_unit());
        add_key(&mut fragment, key, fragment_unit(key.contains("hard"), key.contains("fog")));
    }
    let glsl = BTreeMap::from([("fs_main".to_owned(), fragment.clone())]);
    let wesl = BTreeMap::from([("fs_main".to_owned(), fragment), ("vs_main".to_owned(), vertex)]);
    let languages = BTreeMap::from([(Language::Wesl, wesl), (Language::Glsl, glsl)]);
    ProgramContents { axes, languages }
}

/// One compute shader without axes.
fn write() -> ProgramContents {
    let mut entry = EntryContents::default();
    let texture = TextureShape {
        dimension: "2d_array".to_owned(),
        multisampled: false,
        sample_type: None,
        format: Some("rgba8unorm".to_owned()),
        access: Some(Access::Write),
    };
    let mut picture = binding(0, 0, "picture", BindingKind::StorageTexture);
    (picture.texture, picture.writable) = (Some(texture), true);
    let mut cells = binding(0, 1, "cells", BindingKind::Storage);
    (cells.size, cells.shape) = (Some(0), Some(Shape { count: Some(0), ..shape("u32", 0, 0) }));
    let reflection = Reflection {
        workgroup_size: Some([8, 4, 1]),
        bindings: vec![picture, cells],
        ..Reflection::of(Stage::Compute)
    };
    add_key(&mut entry, "default", unit("write", reflection, &["spirv"]));
    let wesl = BTreeMap::from([("write_all".to_owned(), entry)]);
    ProgramContents { axes: Vec::new(), languages: BTreeMap::from([(Language::Wesl, wesl)]) }
}

fn add_key(entry: &mut EntryContents, key: &str, unit: Unit) {
    let hash = entry.add(unit).unwrap();
    entry.keys.insert(key.to_owned(), hash);
}

fn vertex_unit() -> Unit {
    let mut camera = binding(0, 0, "camera", BindingKind::Uniform);
    camera.size = Some(112);
    camera.members = vec![
        member("clip_from_world", "mat4x4<f32>", 0, 64, matrix(4, 4, 16)),
        member("normal", "mat3x3<f32>", 64, 48, matrix(3, 3, 16)),
    ];
    let input = Varying {
        name: Some("position".to_owned()),
        location: Some(0),
        builtin: None,
        ty: "vec3<f32>".to_owned(),
        shape: Some(shape("f32", 3, 0)),
        interpolation: None,
        sampling: None,
        blend_src: None,
    };
    let reflection =
        Reflection { inputs: vec![input], bindings: vec![camera], ..Reflection::of(Stage::Vertex) };
    unit("vertex", reflection, &["spirv", "glsl330", "wgsl"])
}

fn fragment_unit(is_shadowed: bool, is_foggy: bool) -> Unit {
    let mut lamps = binding(0, 1, "lamps", BindingKind::Uniform);
    let size = if is_foggy { 80 } else { 64 };
    lamps.size = Some(size);
    let mut all = member("all", "array<Lamp, 4>", 0, size, Shape::default());
    (all.stride, all.shape) =
        (Some(16), Some(Shape { count: Some(size / 16), ..Shape::default() }));
    all.members = vec![
        member("color", "vec3<f32>", 0, 12, shape("f32", 3, 0)),
        member("kind", "u32", 12, 4, shape("u32", 0, 0)),
    ];
    lamps.members = vec![all];
    let mut bindings =
        vec![lamps, texture("image", 0, SampleType::Float), binding(1, 1, "smooth", SAMPLER)];
    let mut pairs = vec![Pair { texture: [1, 0], sampler: [1, 1] }];
    if is_shadowed {
        bindings.push(texture("shadow_map", 2, SampleType::Depth));
        bindings.push(binding(1, 3, "compare", BindingKind::ComparisonSampler));
        pairs.push(Pair { texture: [1, 2], sampler: [1, 3] });
    }
    let taps = Override {
        name: Some("taps".to_owned()),
        id: None,
        ty: "i32".to_owned(),
        default: Some("4".to_owned()),
    };
    let reflection =
        Reflection { bindings, pairs, overrides: vec![taps], ..Reflection::of(Stage::Fragment) };
    let name = format!("fragment {is_shadowed} {is_foggy}");
    unit(&name, reflection, &["spirv", "glsl330", "wgsl"])
}

const SAMPLER: BindingKind = BindingKind::Sampler;

fn binding(group: u32, binding: u32, name: &str, kind: BindingKind) -> Binding {
    Binding {
        group,
        binding,
        name: name.to_owned(),
        kind,
        ty: "T".to_owned(),
        count: None,
        size: None,
        writable: false,
        shape: None,
        texture: None,
        members: Vec::new(),
    }
}

fn texture(name: &str, place: u32, sample_type: SampleType) -> Binding {
    let texture = TextureShape {
        dimension: "2d".to_owned(),
        multisampled: false,
        sample_type: Some(sample_type),
        format: None,
        access: None,
    };
    Binding { texture: Some(texture), ..binding(1, place, name, BindingKind::Texture) }
}

fn member(name: &str, ty: &str, offset: u32, size: u32, shape: Shape) -> Member {
    Member {
        name: name.to_owned(),
        ty: ty.to_owned(),
        offset,
        size,
        stride: None,
        shape: Some(shape),
        members: Vec::new(),
    }
}

fn shape(scalar: &str, rows: u32, columns: u32) -> Shape {
    let some = |count: u32| Some(count).filter(|count| *count > 0);
    Shape {
        scalar: Some(scalar.to_owned()),
        rows: some(rows),
        columns: some(columns),
        ..Shape::default()
    }
}

fn matrix(columns: u32, rows: u32, stride: u32) -> Shape {
    Shape { matrix_stride: Some(stride), ..shape("f32", rows, columns) }
}

fn unit(name: &str, reflection: Reflection, targets: &[&str]) -> Unit {
    let artifact = |target: &&str| {
        let extension = if *target == "spirv" { "spv.txt" } else { "txt" };
        let artifact = Artifact {
            bytes: match *target {
                "spirv" => module(name).into(),
                _ => shader_text(name, target).into_bytes().into(),
            },
            extension: extension.to_owned(),
            native: Arc::new(native(&reflection, target)),
        };
        ((*target).to_owned(), artifact)
    };
    let targets = targets.iter().map(artifact).collect();
    Unit { reflection: Arc::new(reflection), targets }
}

/// A text that compresses as shaders do: lines that differ a little.
fn shader_text(name: &str, target: &str) -> String {
    let lines = (0..60_u32).map(|line| {
        let number = line.wrapping_mul(2_654_435_761) >> (line % 20);
        format!("let value_{line} = {name}_{target}(input.position * {number}.0);\n")
    });
    format!("// {name} for {target}\n") + &lines.collect::<String>()
}

/// A module of SPIR-V as far as a bundle reads it: a type, constants and functions, whose ids depend
/// on the name.
fn module(name: &str) -> Vec<u8> {
    let first = name.bytes().fold(0, |sum, byte| (sum * 31 + u32::from(byte)) % 4096);
    let [float, ty] = [first, first + 1];
    let mut words = vec![0x0723_0203, 0x0001_0000, 28, first + 1000, 0];
    let mut add = |op: u32, operands: &[u32]| {
        words.push((operands.len() as u32 + 1) << 16 | op);
        words.extend_from_slice(operands);
    };
    add(22, &[float, 32]);
    add(33, &[ty, float]);
    (0..20).for_each(|number| {
        add(43, &[float, first + 2 + number, number.wrapping_mul(2_654_435_761)])
    });
    for function in 0..name.len() as u32 {
        let id = first + 100 + 20 * function;
        add(54, &[float, id, 0, ty]);
        add(248, &[id + 1]);
        (0..8).for_each(|step| add(129, &[float, id + 2 + step, id + 1 + step, first + 2 + step]));
        add(254, &[id + 9]);
        add(56, &[]);
    }
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

fn native(reflection: &Reflection, target: &str) -> Native {
    let is_text = target == "glsl330";
    let slot = |binding: &Binding| BindingSlot {
        group: binding.group,
        binding: binding.binding,
        space: (!is_text).then_some(binding.group),
        index: (!is_text).then_some(binding.binding),
        register: None,
        name: is_text.then(|| format!("{}_block", binding.name)),
    };
    let choice = |found: &Override| OverrideChoice {
        name: found.name.clone().unwrap_or_default(),
        id: (!is_text).then_some(7),
        symbol: is_text.then(|| "TAPS".to_owned()),
    };
    let combined = |pair: &Pair| Combined {
        texture: pair.texture,
        sampler: Some(pair.sampler),
        name: format!("combined_{}", pair.texture[1]),
    };
    let combined = reflection.pairs.iter().filter(|_| is_text).map(combined);
    Native {
        entry_name: if is_text { "main".to_owned() } else { "entry".to_owned() },
        slots: reflection.bindings.iter().map(slot).collect(),
        choices: reflection.overrides.iter().map(choice).collect(),
        combined: combined.collect(),
        ..Native::default()
    }
}
