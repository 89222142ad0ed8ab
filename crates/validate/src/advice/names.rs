//! Advice about names: members, builtins, reserved words, and names that are declared elsewhere.

use lamplight_diagnostic::nearest_name;
use lamplight_rules::{Piece, Step};

use super::convert::short_type;
use super::parser::declared_type;
use super::{Mistake, Source};

/// A member that there is not.
pub fn member(source: &Source<'_>, name: &str, mistake: &mut Mistake) {
    let at = mistake.labels.first().map_or(0..0, |(range, _)| range.clone());
    mistake.message = format!("there is no member `{name}`");
    mistake.labels.iter_mut().for_each(|(_, label)| *label = "not a member".to_owned());
    let Some(lookup) = &source.lookup else { return };
    let before = source.text.get(..at.start).unwrap_or_default();
    let Some(dot) = before.rfind('.') else { return };
    // The base ends at the dot.
    let base = (0..dot).rev().find_map(|start| {
        let piece = lookup.piece(&(start..dot))?;
        Some((start..dot, piece))
    });
    let Some((base, piece)) = widest(source, base) else { return };
    let text = source.slice(&base);
    let of_type = match piece {
        Piece::Name(of) => declared_type(source, lookup, of, at.start).map(short_type),
        Piece::Call { name, .. } => lookup
            .head_named(name)
            .and_then(|head| head.result)
            .map(|result| short_type(source.part(result))),
        _ => None,
    };
    let of_type = of_type.unwrap_or_default();
    if name == "length" && of_type.starts_with("array") {
        return mistake.write(format!("arrayLength(&{text})"));
    }
    if let Some(size) = of_type.strip_prefix("vec").and_then(|rest| rest.chars().next()) {
        let size = size.to_digit(10).unwrap_or(4).min(4) as usize;
        let parts: Vec<String> =
            "xyzw"[..size].chars().map(|one| format!("`{text}.{one}`")).collect();
        mistake.message = format!("`{text}` is `{of_type}`, and has no `.{name}`");
        match component_names(name, size) {
            Some(swizzle) => mistake.help(format!(
                "components are `xyzw` or `rgba`, not both: write `{text}.{swizzle}`"
            )),
            None => mistake.help(format!("it has {}", parts.join(", "))),
        }
        return;
    }
    if matches!(of_type.as_str(), "f32" | "i32" | "u32" | "bool") || is_depth(source, &piece) {
        let of_type = if of_type.is_empty() { "f32".to_owned() } else { of_type };
        mistake.message = format!("`{text}` is one `{of_type}`, without components");
        return mistake.help(format!("leave `.{name}` out"));
    }
    let members = lookup.members(&of_type);
    if !members.is_empty() {
        let names: Vec<String> = members.iter().map(|one| format!("`{}`", one.name)).collect();
        mistake.notes.push(format!("`{of_type}` has {}", names.join(", ")));
    }
}

/// The largest expression that ends where one ends.
fn widest<'t>(
    source: &Source<'t>,
    found: Option<(std::ops::Range<usize>, Piece<'t>)>,
) -> Option<(std::ops::Range<usize>, Piece<'t>)> {
    let (base, piece) = found?;
    let lookup = source.lookup.as_ref()?;
    let wider = (0..base.start).find_map(|start| {
        let piece = lookup.piece(&(start..base.end))?;
        let is_one = !matches!(piece, Piece::Binary { .. } | Piece::Unary { .. });
        is_one.then_some((start..base.end, piece))
    });
    Some(wider.unwrap_or((base, piece)))
}

/// Whether a lookup of a depth texture gives a value: one number.
fn is_depth(source: &Source<'_>, piece: &Piece<'_>) -> bool {
    let Piece::Call { name, arguments } = piece else { return false };
    let (Some(lookup), Some(texture)) = (&source.lookup, arguments.first()) else { return false };
    let texture = declared_type(source, lookup, source.part(*texture), 0).unwrap_or_default();
    name.starts_with("textureSample")
        && (texture.starts_with("texture_depth") || name.contains("Compare"))
}

/// Components of mixed or other names, as `xyzw`.
pub fn component_names(name: &str, size: usize) -> Option<String> {
    let at = |letter: char| ["xyzw", "rgba", "stpq"].iter().find_map(|set| set.find(letter));
    let all: Option<Vec<usize>> = name.chars().map(at).collect();
    let all = all.filter(|all| all.len() <= 4 && all.iter().all(|at| *at < size))?;
    Some(all.into_iter().map(|at| &"xyzw"[at..=at]).collect())
}

pub fn redefined(source: &Source<'_>, name: &str, mistake: &mut Mistake) {
    mistake.labels.sort_by_key(|(range, _)| std::cmp::Reverse(range.start));
    let at = mistake.labels.first().map_or(0..0, |(range, _)| range.clone());
    mistake.message = format!("`{name}` is declared twice");
    let labels = ["declared again", "declared before"];
    mistake.labels.iter_mut().zip(labels).for_each(|((_, old), new)| *old = new.to_owned());
    let lookup = source.lookup.as_ref();
    match lookup.and_then(|lookup| lookup.step(&at)) {
        Some((_, Step::Declare { value: Some(value), .. })) => mistake.help(format!(
            "declare the first one with `var`, and write `{name} = {};` here; or take another name",
            source.part(value)
        )),
        _ => mistake.help("take another name, or leave one out"),
    }
}

pub fn reserved(_: &Source<'_>, name: &str, mistake: &mut Mistake) {
    if mistake.message.ends_with("is a reserved keyword") {
        mistake.message = format!("`{name}` is a word that WGSL reserves");
        mistake.labels.iter_mut().for_each(|(_, label)| *label = "not a name".to_owned());
        mistake.help(format!("take another name, such as `{name}_`"));
    }
}

pub fn prefixed(_: &Source<'_>, name: &str, mistake: &mut Mistake) {
    mistake.message = format!("`{name}` begins with two underscores, which names must not");
    mistake.help(format!("take another name, such as `{}`", name.trim_start_matches('_')));
}

/// Builtins of WGSL, and what other languages call them.
const BUILT_INS: [(&str, &[&str]); 16] = [
    ("vertex_index", &["vertex_id", "VertexID", "gl_VertexID", "gl_VertexIndex", "SV_VertexID"]),
    ("instance_index", &["instance_id", "gl_InstanceID", "gl_InstanceIndex", "SV_InstanceID"]),
    ("position", &["frag_coord", "FragCoord", "gl_FragCoord", "gl_Position", "SV_Position", "pos"]),
    ("front_facing", &["gl_FrontFacing", "SV_IsFrontFace", "is_front"]),
    ("frag_depth", &["depth", "gl_FragDepth", "SV_Depth"]),
    ("sample_index", &["sample_id", "gl_SampleID", "SV_SampleIndex"]),
    ("sample_mask", &["gl_SampleMask", "SV_Coverage"]),
    ("local_invocation_id", &["thread_position_in_threadgroup", "SV_GroupThreadID", "local_id"]),
    ("local_invocation_index", &["thread_index_in_threadgroup", "SV_GroupIndex", "local_index"]),
    ("global_invocation_id", &["thread_position_in_grid", "SV_DispatchThreadID", "global_id"]),
    ("workgroup_id", &["threadgroup_position_in_grid", "SV_GroupID", "gl_WorkGroupID"]),
    ("num_workgroups", &["threadgroups_per_grid", "gl_NumWorkGroups"]),
    ("primitive_index", &["primitive_id", "gl_PrimitiveID"]),
    ("clip_distances", &["gl_ClipDistance"]),
    ("subgroup_size", &[]),
    ("subgroup_invocation_id", &[]),
];

pub fn built_in(_: &Source<'_>, name: &str, mistake: &mut Mistake) {
    mistake.message = format!("there is no `@builtin({name})`");
    let foreign = BUILT_INS.iter().find(|(_, others)| others.contains(&name)).map(|one| one.0);
    match foreign.or_else(|| nearest_name(name, BUILT_INS.iter().map(|one| one.0))) {
        Some(near) => mistake.write(format!("@builtin({near})")),
        None => {
            let all: Vec<String> = BUILT_INS.iter().map(|one| format!("`{}`", one.0)).collect();
            mistake.help(format!("there are {}", all.join(", ")));
        }
    }
}

const ATTRIBUTES: [&str; 15] = [
    "align",
    "binding",
    "builtin",
    "compute",
    "const",
    "diagnostic",
    "fragment",
    "group",
    "id",
    "interpolate",
    "invariant",
    "location",
    "must_use",
    "vertex",
    "workgroup_size",
];

pub fn attribute(_: &Source<'_>, name: &str, mistake: &mut Mistake) {
    mistake.message = format!("there is no attribute `@{name}`");
    let near = match name {
        "stage" => Some("vertex"),
        "set" => Some("group"),
        "numthreads" | "local_size" => Some("workgroup_size"),
        "flat" => return mistake.write("@interpolate(flat)"),
        _ => nearest_name(name, ATTRIBUTES),
    };
    if let Some(near) = near {
        mistake.write(format!("@{near}"));
    }
}

pub fn address_space(source: &Source<'_>, name: &str, mistake: &mut Mistake) {
    let at = mistake.start();
    mistake.message = format!("`{name}` is not an address space");
    let before = source.text.get(..at).unwrap_or_default().trim_end();
    if before.ends_with("ptr<") {
        return mistake.write(format!("ptr<function, {name}>"));
    }
    let spaces = ["function", "private", "workgroup", "uniform", "storage"];
    match (name, nearest_name(name, spaces)) {
        ("shared" | "groupshared" | "threadgroup", _) => mistake.write("workgroup"),
        ("constant" | "cbuffer", _) => mistake.write("uniform"),
        ("device" | "buffer", _) => mistake.write("storage"),
        (_, Some(near)) => mistake.write(near),
        _ => mistake.help("`private`, `workgroup`, `uniform` and `storage` are"),
    }
}

/// Numbers that other languages have names for.
const NUMBERS: [(&str, &str); 9] = [
    ("PI", "3.141592653589793"),
    ("M_PI", "3.141592653589793"),
    ("pi", "3.141592653589793"),
    ("TAU", "6.283185307179586"),
    ("TWO_PI", "6.283185307179586"),
    ("HALF_PI", "1.5707963267948966"),
    ("M_PI_2", "1.5707963267948966"),
    ("EPSILON", "1e-6"),
    ("INV_PI", "0.3183098861837907"),
];

/// What an unknown name of a WGSL text may mean, where no other advice is known: a name that is
/// declared in another block, or behind the place.
pub fn note_unknown(text: &str, name: &str, at: usize) -> Option<String> {
    if let Some((_, value)) = NUMBERS.iter().find(|(known, _)| *known == name) {
        return Some(format!("help: declare it: `const {name} = {value};`"));
    }
    let source = Source::new(text);
    let lookup = source.lookup.as_ref()?;
    let declared = lookup.all_declared(name, at);
    let one = declared.first()?;
    let value = one.value.map_or("...", |value| source.part(value));
    Some(match one.place.range().start < at {
        true => {
            let zero = match value.contains('.') {
                true => "0.0",
                false => "...",
            };
            format!(
                "help: `{name}` is gone where its block ends: write `var {name} = {zero};` before \
                 the block, and `{name} = {value};` in it"
            )
        }
        false => {
            format!("help: it is declared below: move `{} {name} = {value};` up", one.keyword)
        }
    })
}
