//! What is written is read again: every output has the entry point, bindings and layouts that its
//! reflection says.
//!
//! Here reflections are damaged, each in one way, and each damage must be reported for each target.
//! That sound outputs are accepted is a part of other tests: `outputs::shaders_are_valid`,
//! `link::random`, `emit::valid` and those that validate the library's outputs.

mod damage;

use std::collections::BTreeMap;
use std::fs;
use std::process::Command;

use lamplight::bundle::{Target, blob_files};
use lamplight::validators::agreement::AGREEMENT;
use lamplight::validators::{self, Extent, Output, Tint, verdict};
use libtest_mimic::{Failed, Trial};

use damage::{DAMAGES, Damage};

type Outcome = Result<(), Failed>;

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("agreement::sound_outputs", sound_outputs),
        Trial::test("agreement::every_damage_is_reported", every_damage),
        Trial::test("agreement::stripped_names", stripped_names),
        Trial::test("agreement::lines_do_not_decide_layouts", lines_do_not_decide),
    ]
}

/// Layouts with everything that moves members: vectors of three with and without a number behind
/// them, matrices of three rows, structures and arrays in each other, and attributes.
const DRAWN: &str = "
struct Weight { color: vec3f, level: f32, table: array<vec4f, 3> }
struct Lamp {
    near: mat3x3f,
    far: mat4x3f,
    place: vec3f,
    power: f32,
    weights: array<Weight, 2>,
    one: Weight,
    cells: vec2u,
    turns: array<mat4x4f, 2>,
    moved: i32,
    last: vec2f,
}
@group(0) @binding(3) var<uniform> lamp: Lamp;
@group(1) @binding(2) var<uniform> plain: array<vec4f, 7>;
@group(0) @binding(1) var image: texture_2d_array<f32>;
@group(1) @binding(5) var image_sampler: sampler;

@vertex fn vs_main(@location(0) at: vec3f, @location(3) index: u32) -> @builtin(position) vec4f {
    return vec4f(lamp.near * at, lamp.turns[1][2].x + plain[index].y);
}
@fragment fn fs_main(@location(0) at: vec2f) -> @location(0) vec4f {
    let color = textureSample(image, image_sampler, at, 1);
    return color * lamp.weights[1].level + lamp.one.table[2] + plain[2] + lamp.last.xyxy;
}
";

/// Layouts of storage buffers, which GLSL 3.30 and ES 3.00 do not have.
const COMPUTED: &str = "
struct Item { place: vec3f, count: u32, turn: mat2x2f, marks: array<array<u32, 3>, 2> }
struct Items { total: atomic<u32>, first: vec3f, all: array<Item> }
@group(2) @binding(0) var<storage, read_write> items: Items;
@group(2) @binding(1) var<storage> numbers: array<vec2f>;
@group(2) @binding(4) var picture: texture_storage_2d<rgba8unorm, write>;

@compute @workgroup_size(8, 4, 2) fn cs_main(@builtin(global_invocation_id) id: vec3u) {
    let item = items.all[id.x];
    atomicAdd(&items.total, item.marks[1][2]);
    let sum = item.turn * numbers[id.y] + items.first.xy;
    textureStore(picture, id.xy, vec4f(sum, item.place.xy));
}
";

/// A member with the name of a texture that nothing uses. naga declares it in WGSL.
const NAMED: &str = "#version 450
struct Item { vec4 picture; };
layout(set = 0, binding = 0) uniform texture2D picture;
layout(set = 0, binding = 1) uniform Level { vec4 level; };
layout(location = 0) out vec4 color;
vec4 first = level;
vec4 second = first;
Item made() { Item item; item.picture = second; return item; }
void main() { color = made().picture; }
";

const MANIFEST: &str = "
[program.drawn]
wesl = \"drawn.wesl\"

[program.computed]
wesl = \"computed.wesl\"
targets = [\"spirv\", \"glsl450\", \"msl\", \"hlsl\", \"wgsl\"]

[program.named]
glsl = { fragment = \"named.frag.glsl\" }
";

/// The outputs of both texts in a folder that lives as long as they do.
struct Written {
    outputs: Vec<Output>,
    folder: tempfile::TempDir,
}

fn written() -> Result<Written, Failed> {
    let files = [
        ("lamplight.toml", MANIFEST),
        ("drawn.wesl", DRAWN),
        ("computed.wesl", COMPUTED),
        ("named.frag.glsl", NAMED),
    ];
    generated(&files)
}

fn generated(files: &[(&str, &str)]) -> Result<Written, Failed> {
    let folder = tempfile::tempdir()?;
    for (name, text) in files {
        fs::write(folder.path().join(name), text)?;
    }
    let mut command = Command::new(env!("CARGO_BIN_EXE_lamplight"));
    let output = command.current_dir(folder.path()).args(["gen", "--no-cache"]).output()?;
    if !output.status.success() {
        let text = [output.stdout, output.stderr].concat();
        return Err(String::from_utf8_lossy(&text).into_owned().into());
    }
    let outputs = validators::outputs(blob_files(folder.path().join("bundle"))?)?;
    Ok(Written { outputs, folder })
}

fn sound_outputs() -> Outcome {
    let written = written()?;
    for target in Target::ALL {
        if !written.outputs.iter().any(|output| output.target == *target) {
            return Err(format!("no output for {target}").into());
        }
    }
    let refusals = validators::read_again(&written.outputs)?;
    let first = refusals.first();
    first.map_or(Ok(()), |refusal| {
        Err(format!("{}: {}", refusal.output.target, refusal.message).into())
    })
}

/// Every damage of every output is reported, but for what the languages do not say; and each entry
/// of that table is needed.
fn every_damage() -> Outcome {
    let written = written()?;
    let mut damaged: Vec<(&Damage, Output)> = Vec::new();
    for output in &written.outputs {
        for damage in DAMAGES {
            damaged.extend(damage.of(output).map(|output| (damage, output)));
        }
    }
    let outputs: Vec<Output> = damaged.iter().map(|(_, output)| output.clone()).collect();
    let refusals = validators::read_again(&outputs)?;
    let mut reported: BTreeMap<&str, &str> = BTreeMap::new();
    for refusal in &refusals {
        assert_eq!(refusal.validator, AGREEMENT);
        reported.insert(&refusal.output.description, &refusal.message);
    }
    let mut problems = Vec::new();
    // Damages, and those that are reported.
    let mut counts: BTreeMap<Target, (usize, usize)> = BTreeMap::new();
    for (damage, output) in &damaged {
        let count = counts.entry(output.target).or_default();
        count.0 += 1;
        let message = reported.get(output.description.as_str());
        match (message, damage.is_hidden(output)) {
            (Some(_), false) => count.1 += 1,
            (None, true) => {}
            (None, false) => problems.push(format!("{} is not reported", output.description)),
            (Some(message), true) => {
                problems.push(format!("{} is reported: {message}", output.description));
            }
        }
    }
    println!("damages and reports: {counts:?}");
    if problems.is_empty() { Ok(()) } else { Err(problems.join("\n").into()) }
}

/// SPIR-V without names is read as well.
fn stripped_names() -> Outcome {
    const NAMES: [u16; 2] = [5, 6];
    let written = written()?;
    let folder = tempfile::tempdir()?;
    let mut stripped = Vec::new();
    for output in written.outputs.iter().filter(|output| output.target == Target::SPIRV) {
        let words = lamplight::emit::spirv::words(&fs::read(&output.file)?);
        let mut kept = words[..5].to_vec();
        for one in lamplight::emit::spirv::instructions(&words) {
            if !NAMES.contains(&one.op) {
                kept.extend(one.words);
            }
        }
        let file = folder.path().join(format!("{}.spv", stripped.len()));
        fs::write(&file, lamplight::emit::spirv::bytes(&kept))?;
        stripped.push(Output { file, ..output.clone() });
    }
    if let Some(refusal) = validators::read_again(&stripped)?.first() {
        return Err(refusal.message.clone().into());
    }
    let offset = DAMAGES.iter().find(|damage| damage.name == "offset").ok_or("no damage")?;
    let damaged: Vec<Output> = stripped.iter().filter_map(|output| offset.of(output)).collect();
    match validators::read_again(&damaged)?.len() == damaged.len() && !damaged.is_empty() {
        true => Ok(()),
        false => Err("another offset is not reported without names".into()),
    }
}

/// Members that move those behind them, each in some permutations.
const MOVED: &str = "
struct Lamp { @if(first) one: f32, @if(second) two: vec3f, @if(third) three: f32, last: vec4f }
@group(0) @binding(0) var<uniform> lamp: Lamp;
@fragment fn fs_main() -> @location(0) vec4f { return lamp.last; }
";

const MOVED_MANIFEST: &str = "[program.moved]
wesl = \"moved.wesl\"
axis.first = { values = [false, true] }
axis.second = { values = [false, true] }
axis.third = { values = [false, true] }
";

/// `--validate lines` reads each layout, although fewer permutations have all lines; and no more
/// outputs than there are layouts.
fn lines_do_not_decide() -> Outcome {
    let written = generated(&[("lamplight.toml", MOVED_MANIFEST), ("moved.wesl", MOVED)])?;
    let damage = DAMAGES.iter().find(|damage| damage.name == "larger offset").ok_or("no damage")?;
    let tint = Tint::at(written.folder.path().join("no-tint"));
    let judged = |outputs: Vec<Output>| verdict(outputs, Extent::Lines, None, &tint, &|_, _| ());
    let sound = judged(written.outputs.clone())?;
    if let Some(refusal) = sound.refusals.first() {
        return Err(format!("a sound output is refused: {refusal:?}").into());
    }
    for target in Target::ALL {
        let ours = sound.validation.targets.iter().find(|one| one.target == target.name());
        let ours = ours.ok_or_else(|| format!("{target} is not validated"))?;
        if ours.now >= ours.outputs {
            return Err(format!("{target}: all {} outputs are validated", ours.outputs).into());
        }
    }
    let damaged: Option<Vec<Output>> = written.outputs.iter().map(|one| damage.of(one)).collect();
    let damaged = damaged.ok_or("there is nothing to damage")?;
    let found = judged(damaged.clone())?.refusals;
    match found.iter().all(|one| one.validator == AGREEMENT) && found.len() == damaged.len() {
        true => Ok(()),
        false => {
            let count = found.len();
            Err(format!("{count} of {} damages are reported: {found:?}", damaged.len()).into())
        }
    }
}
