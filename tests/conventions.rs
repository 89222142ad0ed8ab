//! Compares a target's reflection, by which engines bind, with the text of its output.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use lamplight::bundle::{
    Binding, BindingKind, Bundle, ClipConvention, ClipSpace, Found, FrontFace, RowOrder, Target,
    Viewport, YAxis, blob_files, pack,
};
use lamplight::emit::targets;
use lamplight::validators;
use libtest_mimic::{Failed, Trial};

use crate::validators::{Package, expect};

type Outcome = Result<(), Failed>;
type Case = (&'static str, fn() -> Outcome);

pub fn tests() -> Vec<Trial> {
    let cases: [Case; 6] = [
        ("clip_spaces", clip_spaces),
        ("source_clip_spaces", source_clip_spaces),
        ("clip_in_manifest_and_cache", clip_in_manifest_and_cache),
        ("registers", registers),
        ("slots", slots),
        ("guide", guide),
    ];
    let test = |(name, case): Case| Trial::test(format!("conventions::{name}"), case);
    cases.map(test).into()
}

const SHADER: &str = "
struct View { matrix: mat4x4f, tint: vec4f }
@group(0) @binding(3) var<uniform> view: View;
@group(1) @binding(2) var<uniform> scale: vec4f;
@group(0) @binding(5) var image: texture_2d<f32>;
@group(2) @binding(1) var image_sampler: sampler;
@group(1) @binding(0) var depth: texture_depth_2d;
@group(2) @binding(4) var depth_sampler: sampler_comparison;
struct Carried { @builtin(position) at: vec4f, @location(2) uv: vec2f }
@vertex fn vs_main(@location(0) place: vec3f, @location(4) uv: vec2f) -> Carried {
    return Carried(view.matrix * vec4f(place, 1.0) * scale, uv);
}
@fragment fn fs_main(in: Carried) -> @location(0) vec4f {
    let lit = textureSampleCompareLevel(depth, depth_sampler, in.uv, 0.5);
    return view.tint * textureSample(image, image_sampler, in.uv) * lit;
}
";

const MANIFEST: &str = "[program.one]\nwesl = \"one.wesl\"\n";

/// The line of a GLSL output that converts wgpu's clip space to that of OpenGL.
const CONVERTS: &str =
    "    gl_Position.yz = vec2(-gl_Position.y, gl_Position.z * 2.0 - gl_Position.w);\n";

/// The targets that are versions of GLSL.
fn glsl_targets() -> Vec<Target> {
    let entries = targets::ALL.iter().filter(|entry| entry.glsl.is_some());
    entries.map(|entry| entry.target).collect()
}

/// A position that OpenGL and WebGPU place at other depths, and Vulkan and WebGPU at other heights.
const POSITION: &str = "in vec4 place;\nvoid main() { gl_Position = place; }\n";

/// What becomes of the position of a vertex shader in GLSL: by the first line of the shader, and the
/// options.
const SOURCE_CLIPS: &[(&str, &[&str], Converted)] = &[
    ("#version 330 core", &[], Converted::Depth),
    ("#version 300 es", &[], Converted::Depth),
    ("#version 330 core", &["--source-clip", "webgpu"], Converted::Nothing),
    ("#version 330 core", &["--source-clip", "vulkan"], Converted::Height),
    ("#version 330 core", &["--clip", "native"], Converted::Nothing),
    ("#version 450\nlayout(location = 0)", &[], Converted::Nothing),
    ("#version 450\nlayout(location = 0)", &["--source-clip", "opengl"], Converted::Depth),
    ("#version 450\nlayout(location = 0)", &["--source-clip", "vulkan"], Converted::Height),
];

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Converted {
    Nothing,
    /// From -1 to 1, to 0 to 1.
    Depth,
    /// From downwards to upwards.
    Height,
}

/// The clip space of a shader in GLSL is converted once, by its version or as somebody asks.
fn source_clip_spaces() -> Outcome {
    let package = Package::new(MANIFEST, SHADER)?;
    for (first, options, expected) in SOURCE_CLIPS {
        fs::write(package.path("place.vert"), format!("{first}\n{POSITION}"))?;
        let command = ["compile", "place.vert", "--target", "wgsl"];
        let output = package.run(&[&command[..], options].concat())?;
        expect(&output, 0, &[])?;
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let found = match (text.contains("0.5f"), text.contains("= -(")) {
            (false, false) => Converted::Nothing,
            (true, false) => Converted::Depth,
            (false, true) => Converted::Height,
            _ => return Err(format!("{first} {options:?}: both are converted:\n{text}").into()),
        };
        if found != *expected {
            let what = format!("{first} {options:?}: expected {expected:?}, found {found:?}");
            return Err(format!("{what}:\n{text}").into());
        }
    }
    Ok(())
}

fn found(package: &Package, out: &str, entry: &str, target: Target) -> Result<Found, Failed> {
    let bundle = Bundle::open(package.path(out))?;
    Ok(bundle.program("one")?.shader(entry)?.get("default", target)?)
}

fn text(found: &Found) -> Result<String, Failed> {
    Ok(String::from_utf8(found.bytes.clone())?)
}

/// Vertex stages for the two clip spaces differ by one line, in GLSL only, and the reflection says
/// which clip space they have. Fragment stages do not differ. The validators accept all outputs.
fn clip_spaces() -> Outcome {
    let package = Package::new(MANIFEST, SHADER)?;
    for clip in ["wgpu", "native"] {
        expect(&package.run(&["gen", "--no-cache", "--clip", clip, "-o", clip])?, 0, &[])?;
        let outputs = validators::outputs(blob_files(package.path(clip))?)?;
        if let Some(refusal) = validators::validate_outputs(&outputs, None, &|_, _| ())?.first() {
            return Err(format!("clip space {clip}: {refusal:?}").into());
        }
    }
    for target in Target::ALL {
        let is_glsl = glsl_targets().contains(target);
        let [wgpu, native] =
            ["wgpu", "native"].map(|clip| found(&package, clip, "vs_main", *target));
        let (wgpu, native) = (wgpu?, native?);
        let expected = match is_glsl {
            true => text(&wgpu)?.replacen(CONVERTS, "", 1).into_bytes(),
            false => wgpu.bytes.clone(),
        };
        if native.bytes != expected || is_glsl == (native.bytes == wgpu.bytes) {
            return Err(format!("{target}: wrong native text:\n{}", text(&native)?).into());
        }
        let spaces = targets::find(*target).ok_or("no such target")?.clip;
        if [wgpu.native.clip, native.native.clip]
            != [ClipConvention::Wgpu, ClipConvention::Native].map(|clip| Some(spaces.of(clip)))
        {
            let clips = [wgpu.native.clip, native.native.clip];
            return Err(format!("{target}: the reflection has the clip spaces {clips:?}").into());
        }
        if wgpu.native.clip.is_some_and(|clip| clip.is_converted) != is_glsl {
            return Err(format!("{target}: `is_converted` should be {is_glsl}").into());
        }
        let [wgpu, native] =
            ["wgpu", "native"].map(|clip| found(&package, clip, "fs_main", *target));
        if wgpu? != native? {
            return Err(format!("{target}: fragment stages differ").into());
        }
    }
    Ok(())
}

/// The option `--clip` overrides the manifest's clip space. The cache does not mix up the outputs
/// of the two, and both forms of a bundle say which clip space they have.
fn clip_in_manifest_and_cache() -> Outcome {
    let package = Package::new(&format!("{MANIFEST}clip = \"native\"\n"), SHADER)?;
    let is_converted = |out: &str| -> Result<bool, Failed> {
        let found = found(&package, out, "vs_main", Target::GLSL330)?;
        let is_converted = found.native.clip.ok_or("no clip space")?.is_converted;
        match text(&found)?.contains(CONVERTS) == is_converted {
            true => Ok(is_converted),
            false => {
                Err(format!("{out}: `is_converted` is {is_converted}, the text differs").into())
            }
        }
    };
    let runs: [(&[&str], bool); 4] =
        [(&[], false), (&["--clip", "wgpu"], true), (&["--clip", "native"], false), (&[], false)];
    for (arguments, expected) in runs {
        let all = [&["gen", "--cache", "cache", "-o", "out"], arguments].concat();
        expect(&package.run(&all)?, 0, &[])?;
        if is_converted("out")? != expected {
            return Err(format!("gen {arguments:?}: expected converted: {expected}").into());
        }
    }
    for (arguments, expected) in [(&[][..], false), (&["--clip", "wgpu"], true)] {
        let compile = ["compile", "one.wesl", "--target", "glsl330", "--entry", "vs_main"];
        let output = package.run(&[&compile, arguments].concat())?;
        expect(&output, 0, &["gl_Position = "])?;
        if String::from_utf8_lossy(&output.stdout).contains(CONVERTS) != expected {
            return Err(format!("compile {arguments:?}: expected converted: {expected}").into());
        }
    }
    let packed = pack(&Bundle::open(package.path("out"))?.contents()?)?;
    fs::write(package.path("one.lamplight"), packed)?;
    if is_converted("one.lamplight")? {
        return Err("the single file has another clip space".into());
    }
    let output = package.run(&["gen", "--clip", "opengl"])?;
    expect(&output, 2, &["expected one of: wgpu, native"])?;
    fs::write(package.path("lamplight.toml"), format!("{MANIFEST}clip = \"natve\"\n"))?;
    let words = ["error[unknown-clip]", "lamplight.toml:3:8", "did you mean `native`?"];
    expect(&package.run(&["gen"])?, 1, &words)
}

/// The text after a word, up to the first of some characters.
fn after<'t>(text: &'t str, word: &str, until: &[char]) -> Option<&'t str> {
    let (_, rest) = text.split_once(word)?;
    rest.split(until).next().map(str::trim)
}

/// A name, a register such as `t3`, and its space.
type Register = (String, String, u32);

/// HLSL: the reflection has the text's registers and spaces, sampler heaps with their index
/// buffers, and semantics.
fn registers() -> Outcome {
    let package = Package::new(MANIFEST, SHADER)?;
    expect(&package.run(&["gen", "--no-cache"])?, 0, &[])?;
    for (entry, semantics) in [("vs_main", &["LOC0", "LOC4"][..]), ("fs_main", &[])] {
        let found = found(&package, "bundle", entry, Target::HLSL)?;
        let text = text(&found)?;
        let (mut written, reflected) = (registers_in(&text)?, reflected_registers(&found, &text)?);
        // naga declares both heaps, even if only one is used.
        let heaps = reflected.iter().any(|(name, ..)| name.starts_with("naga"));
        written.retain(|(name, ..)| !name.starts_with("naga") || heaps);
        if written != reflected {
            let what = format!("the text has {written:?}, the reflection {reflected:?}");
            return Err(format!("{entry}: {what}:\n{text}").into());
        }
        let native = &found.native.semantics;
        let reflected_semantics: Vec<String> =
            native.iter().map(|one| format!("{}{}", one.name, one.index)).collect();
        let lost =
            reflected_semantics.iter().find(|semantic| !text.contains(&format!(": {semantic}")));
        if reflected_semantics != semantics || lost.is_some() {
            let what =
                format!("the reflection has {reflected_semantics:?}, expected {semantics:?}");
            return Err(format!("{entry}: semantics: {what}; not in the text: {lost:?}").into());
        }
    }
    Ok(())
}

/// The registers that the text declares.
fn registers_in(text: &str) -> Result<BTreeSet<Register>, Failed> {
    let mut written = BTreeSet::new();
    for line in text.lines() {
        let head = line.split_once(':').map(|(head, _)| head);
        let (Some(register), Some(head)) = (after(line, "register(", &[')']), head) else {
            continue;
        };
        let name = head.split_whitespace().last().unwrap_or_default().to_owned();
        let (register, space) = register.split_once(", space").unwrap_or((register, "0"));
        written.insert((name, register.to_owned(), space.parse()?));
    }
    Ok(written)
}

/// The registers of the reflection. The text must use each sampler at the place in its heap that
/// the reflection says.
fn reflected_registers(found: &Found, text: &str) -> Result<BTreeSet<Register>, Failed> {
    let mut registers = BTreeSet::new();
    for slot in &found.native.slots {
        let is_it =
            |binding: &&Binding| (binding.group, binding.binding) == (slot.group, slot.binding);
        let binding = found.reflection.bindings.iter().find(is_it).ok_or("no binding")?;
        let class = slot.register.clone().ok_or("no class of register")?;
        let number = slot.index.ok_or("no number")?;
        let space = slot.space.ok_or("no space")?;
        registers.insert((binding.name.clone(), format!("{class}{number}"), space));
    }
    for heap in &found.native.sampler_heaps {
        let name = format!("{}[{}]", heap.name, heap.size);
        registers.insert((name, format!("s{}", heap.register), heap.space));
        for sampler in &heap.samplers {
            let array = format!("nagaGroup{}SamplerIndexArray", sampler.group);
            let place = format!("{}[{array}[{}]]", heap.name, sampler.element);
            if !text.contains(&place) {
                return Err(format!("the text has no {place}").into());
            }
            registers.insert((
                array,
                format!("t{}", sampler.buffer_register),
                sampler.buffer_space,
            ));
        }
    }
    Ok(registers)
}

/// The name and the number of everything that a text in MSL or GLSL binds.
fn bound(target: Target, text: &str) -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    let last =
        |head: &str| head.split([' ', '*', '&']).rfind(|word| !word.is_empty()).map(str::to_owned);
    for line in text.lines().map(str::trim) {
        let pair = match target.name() {
            "msl" => ["buffer(", "texture(", "sampler("].iter().find_map(|kind| {
                let number = after(line, &format!("[[{kind}"), &[')'])?;
                let name = last(line.split("[[").next()?.trim())?;
                Some((name, format!("{kind}{number}")))
            }),
            // In GLSL a block is known by its name, anything else by that of the variable.
            _ if !line.contains("uniform ") => None,
            _ => {
                let number = after(line, "binding = ", &[')', ',']).unwrap_or("none").to_owned();
                // A block may have its members in the same line.
                let head = line.split('{').next().unwrap_or_default();
                let head = head.trim_end_matches([';', ' ']);
                last(head).map(|name| (name, number))
            }
        };
        found.extend(pair);
    }
    found
}

/// MSL and GLSL: the reflection has exactly the slots, combined samplers and buffer sizes of the
/// text.
fn slots() -> Outcome {
    let package = Package::new(MANIFEST, SHADER)?;
    expect(&package.run(&["gen", "--no-cache"])?, 0, &[])?;
    for target in [&[Target::MSL][..], &glsl_targets()].concat() {
        for entry in ["vs_main", "fs_main"] {
            let found = found(&package, "bundle", entry, target)?;
            let written = bound(target, &text(&found)?);
            let mut reflected = BTreeMap::new();
            for slot in &found.native.slots {
                let is_it = |one: &&Binding| (one.group, one.binding) == (slot.group, slot.binding);
                let binding = found.reflection.bindings.iter().find(is_it).ok_or("no binding")?;
                let kind = match binding.kind {
                    BindingKind::Uniform | BindingKind::Storage | BindingKind::Immediate => {
                        "buffer("
                    }
                    BindingKind::Texture | BindingKind::StorageTexture => "texture(",
                    BindingKind::Sampler | BindingKind::ComparisonSampler => "sampler(",
                };
                let number = slot.index.map_or("none".to_owned(), |index| index.to_string());
                match target.name() {
                    "msl" => reflected.insert(binding.name.clone(), format!("{kind}{number}")),
                    _ => reflected.insert(slot.name.clone().ok_or("no name")?, number),
                };
            }
            if written != reflected {
                return Err(
                    format!("{target} {entry}: text {written:?}, reflected {reflected:?}").into()
                );
            }
            let combined: BTreeSet<_> =
                found.native.combined.iter().map(|one| (one.texture, one.sampler)).collect();
            let pairs: BTreeSet<_> =
                found.reflection.pairs.iter().map(|one| (one.texture, Some(one.sampler))).collect();
            if target != Target::MSL && combined != pairs {
                return Err(format!("{target} {entry}: {combined:?}, expected {pairs:?}").into());
            }
        }
    }
    first_instance()?;
    sizes()
}

/// The reflection names GLSL's uniform for the first instance exactly if the text has one.
fn first_instance() -> Outcome {
    let shader = "@vertex fn vs_main(@builtin(instance_index) i: u32) -> @builtin(position) vec4f { return vec4f(f32(i)); }";
    for (shader, is_there) in [(shader, true), (SHADER, false)] {
        let package = Package::new(MANIFEST, shader)?;
        expect(&package.run(&["gen", "--no-cache"])?, 0, &[])?;
        let outputs = validators::outputs(blob_files(package.path("bundle"))?)?;
        if let Some(refusal) = validators::validate_outputs(&outputs, None, &|_, _| ())?.first() {
            return Err(format!("{refusal:?}").into());
        }
        for target in glsl_targets() {
            let found = found(&package, "bundle", "vs_main", target)?;
            let name = found.native.first_instance.clone().unwrap_or_default();
            if text(&found)?.contains("_first_instance;") != is_there
                || name.is_empty() == is_there
                || !text(&found)?.contains(&name)
            {
                let what = format!("first instance: found `{name}`, expected one: {is_there}");
                return Err(format!("{target}: {what}").into());
            }
        }
    }
    Ok(())
}

/// The reflection has the MSL argument with the sizes of buffers, as the text declares it.
fn sizes() -> Outcome {
    let shader = "
@group(0) @binding(1) var<storage> few: array<vec4f>;
@group(1) @binding(0) var<storage> many: array<f32>;
@fragment fn fs_main() -> @location(0) vec4f { return few[arrayLength(&many)] * f32(arrayLength(&few)); }
";
    let package = Package::new(&format!("{MANIFEST}targets = [\"msl\"]\n"), shader)?;
    expect(&package.run(&["gen", "--no-cache"])?, 0, &[])?;
    let found = found(&package, "bundle", "fs_main", Target::MSL)?;
    let text = text(&found)?;
    let sizes = found.native.buffer_sizes.as_ref().ok_or("no sizes of buffers")?;
    let argument = format!("_mslBufferSizes& _buffer_sizes [[buffer({})]]", sizes.index);
    let members = after(&text, "struct _mslBufferSizes {", &['}']).ok_or("no struct")?;
    if !text.contains(&argument) || members.matches("uint size").count() != sizes.buffers.len() {
        return Err(format!("the reflection has {sizes:?}, which is not in:\n{text}").into());
    }
    match sizes.buffers == [[0, 1], [1, 0]] {
        true => Ok(()),
        false => Err(format!("expected the buffers [[0, 1], [1, 0]], found {sizes:?}").into()),
    }
}

/// The guide's table of clip spaces agrees with the targets' own.
fn guide() -> Outcome {
    let page = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/guide/targets.md"))?;
    let (_, section) = page.split_once("## Clip space").ok_or("no section about clip space")?;
    let rows: Vec<Vec<&str>> = section
        .lines()
        .skip_while(|line| !line.starts_with('|'))
        .take_while(|line| line.starts_with('|'))
        .map(|line| line.trim_matches('|').split('|').map(str::trim).collect())
        .collect();
    let columns: Vec<Vec<&str>> = rows[0][1..]
        .iter()
        .map(|names| names.split(", ").map(|name| name.trim_matches('`')).collect())
        .collect();
    for target in Target::ALL {
        let column = columns.iter().position(|names| names.contains(&target.name()));
        let column = column.ok_or_else(|| format!("no column for {target}"))? + 1;
        let spaces = targets::find(*target).ok_or("no such target")?.clip;
        let expected: Vec<String> =
            [spaces.wgpu, spaces.native].iter().flat_map(in_words).collect();
        let documented: Vec<&str> = rows[2..].iter().map(|row| row[column]).collect();
        if expected != documented {
            return Err(format!(
                "{target}: the guide says {documented:?}, the target {expected:?}"
            )
            .into());
        }
    }
    Ok(())
}

fn in_words(clip: &ClipSpace) -> [String; 6] {
    let words = [
        match clip.y {
            YAxis::Up => "up",
            YAxis::Down => "down",
        },
        match clip.viewport {
            Viewport::Positive => "positive",
            Viewport::Negative => "negative",
        },
        if clip.is_converted { "yes" } else { "no" },
        match clip.rows {
            RowOrder::TopFirst => "top",
            RowOrder::BottomFirst => "bottom",
        },
        match clip.front_face {
            FrontFace::Same => "counter-clockwise",
            FrontFace::Reversed => "clockwise",
        },
    ];
    let [y, viewport, converted, rows, front_face] = words.map(str::to_owned);
    [y, format!("{} to {}", clip.near, clip.far), viewport, converted, rows, front_face]
}
