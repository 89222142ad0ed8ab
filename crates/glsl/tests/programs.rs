//! Programs of two stages whose numbers are open: whatever branch is chosen, the stages fit.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use lamplight_diagnostic::source::SourceId;
use lamplight_glsl::tree::Stage;
use lamplight_glsl::{number_program, translate, wgsl};
use libtest_mimic::{Failed, Trial};
use naga::common::wgsl::TypeContext;
use naga::{Binding, Module, ShaderStage, TypeInner};

pub fn tests() -> Vec<Trial> {
    vec![Trial::test("glsl::programs/stages_fit", stages_fit)]
}

/// A generator of numbers: SplitMix64, by Steele, Lea and Flood, 2014.
struct Random(u64);

impl Random {
    fn below(&mut self, most: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (mixed ^ (mixed >> 31)) as usize % most
    }

    fn shuffled<T>(&mut self, mut list: Vec<T>) -> Vec<T> {
        for at in (1..list.len()).rev() {
            list.swap(at, self.below(at + 1));
        }
        list
    }
}

/// What both stages may declare: the type, the name with its sizes, and a `float` of it.
const SHARED: &[(&str, &str, &str)] = &[
    ("float", "a", "a"),
    ("vec2", "b", "b.x"),
    ("mat3", "c", "c[0].x"),
    ("vec4", "d[2]", "d[1].x"),
    ("Pair", "e", "e.y.x"),
    ("mat2", "f[SIZE]", "f[1][0].x"),
    ("vec3", "g", "g.z"),
];

const RESOURCES: &[(&str, &str)] = &[
    ("uniform sampler2D one;", "texture(one, vec2(0.5)).x"),
    ("uniform sampler2D two[2];", "texture(two[1], vec2(0.5)).x"),
    ("layout(std140) uniform Camera { vec4 eye; };", "eye.x"),
    ("uniform Material material;", "texture(material.map, vec2(0.5)).x * material.shine"),
    ("uniform float loose;", "loose"),
    ("uniform mat3 turn;", "turn[1].x"),
    ("uniform vec3 tint, more[SIZE];", "tint.x * more[1].y"),
    ("uniform Scaled scaled[2];", "scaled[1].by[1].x"),
    ("uniform vec4 many[AXIS];", "many[1].x"),
];

const START: &str = "struct Pair { vec2 x; vec3 y; };\n\
                     struct Material { sampler2D map; float shine; };\n\
                     struct Scaled { float one; mat2 by; vec3 at; };\n\
                     #define SIZE 2\n";

/// One stage: the source with its branches, and the same without those that are not chosen.
struct Written {
    source: String,
    chosen: String,
}

fn write_stage(random: &mut Random, vertex: bool, given: &BTreeMap<&str, u32>) -> Written {
    let mut lines: Vec<(String, String)> = Vec::new();
    let direction = if vertex { "out" } else { "in" };
    for (ty, name, value) in SHARED {
        let bare = name.split('[').next().unwrap_or(name);
        let layout = given.get(bare).map(|at| format!("layout(location = {at}) "));
        let layout = layout.unwrap_or_default();
        let line = format!("{layout}{direction} {ty} {name};");
        let used = if vertex { format!("{value} = sum;") } else { format!("sum += {value};") };
        lines.push((line, used));
    }
    for (line, value) in RESOURCES {
        lines.push(((*line).to_owned(), format!("sum += {value};")));
    }
    let (mut source, mut chosen) = (START.to_owned(), START.replace("#define SIZE 2\n", ""));
    let (mut body, mut outputs) = (String::new(), String::new());
    for (line, used) in random.shuffled(lines) {
        if random.below(6) == 0 {
            continue;
        }
        let is_open = random.below(3) == 0;
        let is_chosen = !is_open || random.below(2) == 0;
        if is_open {
            let _ = writeln!(source, "#if AXIS > {}\n{line}\n#endif", random.below(4));
        } else {
            let _ = writeln!(source, "{line}");
        }
        if is_chosen {
            let _ = writeln!(chosen, "{}", line.replace("SIZE", "2").replace("AXIS", "3"));
            let target = if line.contains("out ") { &mut outputs } else { &mut body };
            let _ = writeln!(target, "    {used}");
        }
    }
    let last = if vertex { "gl_Position = vec4(sum);" } else { "colour = vec4(sum);" };
    let head = if vertex { "" } else { "out vec4 colour;\n" };
    let main =
        format!("{head}void main() {{\n    float sum = 0.0;\n{body}{outputs}    {last}\n}}\n");
    source.push_str(&main);
    chosen.push_str(&main);
    Written { source, chosen }
}

/// What one stage binds: locations and types of what goes between the stages by number, and the
/// bindings of resources by name.
struct Interface {
    between: BTreeMap<u32, (String, String)>,
    bindings: BTreeMap<String, u32>,
    /// Where each uniform outside of blocks lies.
    offsets: BTreeMap<String, u32>,
}

fn interface(stage: Stage, text: &str) -> Result<Interface, Failed> {
    let text = format!("#version 330\n{text}");
    let written = translate(&text, stage, SourceId(0), wgsl::Options::default())
        .map_err(|problems| format!("{text}: {}", problems[0].message))?;
    let module = naga::front::wgsl::parse_str(&written.text)
        .map_err(|error| error.emit_to_string(&written.text))?;
    let mut between = BTreeMap::new();
    for (name, ty, location) in varyings(&module) {
        let name = name.trim_end_matches("_in").to_owned();
        if between.insert(location, (name, ty)).is_some() {
            return Err(format!("two have the location {location}: {}", written.text).into());
        }
    }
    let mut bindings = BTreeMap::new();
    let mut places = BTreeSet::new();
    for resource in &written.facts.names.resources {
        let names = [
            Some((String::new(), resource.binding)),
            resource.sampler.map(|at| (" sampler".to_owned(), at)),
        ];
        for (suffix, binding) in names.into_iter().flatten() {
            if !places.insert(binding) {
                return Err(format!("two have the binding {binding}: {}", written.text).into());
            }
            bindings.insert(format!("{}{suffix}", resource.name), binding);
        }
    }
    Ok(Interface { between, bindings, offsets: uniform_offsets(&module) })
}

fn uniform_offsets(module: &Module) -> BTreeMap<String, u32> {
    let block = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some("Uniforms"));
    let Some((_, naga::Type { inner: TypeInner::Struct { members, .. }, .. })) = block else {
        return BTreeMap::new();
    };
    members.iter().map(|one| (one.name.clone().unwrap_or_default(), one.offset)).collect()
}

/// Name, type and location of what a vertex shader returns, or of what a fragment shader takes.
fn varyings(module: &Module) -> Vec<(String, String, u32)> {
    let point = &module.entry_points[0];
    let located = |name: &Option<String>, ty, binding: &Option<Binding>| match binding {
        Some(Binding::Location { location, .. }) => {
            let ty = module.to_ctx().type_to_string(ty);
            Some((name.clone().unwrap_or_default(), ty, *location))
        }
        _ => None,
    };
    if point.stage == ShaderStage::Fragment {
        let arguments = point.function.arguments.iter();
        return arguments.filter_map(|one| located(&one.name, one.ty, &one.binding)).collect();
    }
    let Some(result) = &point.function.result else { return Vec::new() };
    match &module.types[result.ty].inner {
        TypeInner::Struct { members, .. } => {
            members.iter().filter_map(|one| located(&one.name, one.ty, &one.binding)).collect()
        }
        _ => Vec::new(),
    }
}

fn stages_fit() -> Result<(), Failed> {
    let mut shared = 0;
    for seed in 0..200 {
        let mut random = Random(seed);
        let given = match random.below(3) {
            0 => BTreeMap::from([("b", 3), ("g", 20)]),
            _ => BTreeMap::new(),
        };
        let stages = [true, false].map(|vertex| write_stage(&mut random, vertex, &given));
        let numbers = number_program(&[&stages[0].source], &[&stages[1].source]);
        let [vertex, fragment] = [(0, Stage::Vertex), (1, Stage::Fragment)]
            .map(|(at, stage)| interface(stage, &format!("{}{}", stages[at].chosen, numbers[at])));
        let with_seed = |error: Failed| format!("seed {seed}: {}", error.message().unwrap_or(""));
        let (vertex, fragment) = (vertex.map_err(with_seed)?, fragment.map_err(with_seed)?);
        for (location, taken) in &fragment.between {
            match vertex.between.get(location) {
                Some(sent) if sent != taken => {
                    let message = format!("seed {seed}: {location} is {sent:?} and {taken:?}");
                    return Err(message.into());
                }
                Some(_) => shared += 1,
                None => {}
            }
            let elsewhere =
                vertex.between.iter().find(|(at, sent)| *at != location && *sent == taken);
            if let Some((at, _)) = elsewhere {
                return Err(format!("seed {seed}: {taken:?} is at {at} and {location}").into());
            }
        }
        for (name, offset) in &vertex.offsets {
            if fragment.offsets.get(name).is_some_and(|other| other != offset) {
                return Err(format!("seed {seed}: `{name}` lies at two places").into());
            }
        }
        for (name, binding) in &vertex.bindings {
            if fragment.bindings.get(name).is_some_and(|other| other != binding) {
                return Err(format!("seed {seed}: `{name}` has two bindings").into());
            }
            let other = fragment.bindings.iter().find(|(_, other)| *other == binding);
            if other.is_some_and(|(other, _)| other != name) {
                return Err(format!("seed {seed}: {other:?} is `{name}` too").into());
            }
        }
    }
    if shared > 500 { Ok(()) } else { Err(format!("only {shared} are shared").into()) }
}
