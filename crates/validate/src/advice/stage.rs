//! Advice about what enters and leaves stages, and about variables of the module.

use lamplight_rules::{Declared, Lookup};

use super::convert::short_type;
use super::{Mistake, Source};

/// What is wrong with an input or an output, or with a variable of the module.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Interface {
    /// Neither `@location` nor `@builtin`.
    Unplaced { is_vertex: bool },
    /// An integer without `@interpolate(flat)`.
    Interpolated,
    /// A location that another one has.
    Taken,
    /// A builtin with another type.
    Typed { built_in: String },
    /// A builtin of another stage.
    Foreign { stage: &'static str },
}

/// Where an input or an output is.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Port {
    pub entry: String,
    /// The parameter, by its number from 0; the result without one.
    pub parameter: Option<usize>,
    pub member: Option<usize>,
}

/// A variable of the module that is declared wrongly.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Variable {
    /// Without `@group` and `@binding`, or with them where it has none.
    Unbound,
    /// `var` without an address space.
    Spaceless,
    /// Numbers closer together than a uniform buffer has them.
    Strided,
    /// Booleans in a buffer.
    Boolean,
    /// The place of another variable.
    Collides,
    /// A value where memory has none.
    Initialised,
}

/// Types of builtins, for those that are often declared with another one.
const BUILT_IN_TYPES: [(&str, &str); 11] = [
    ("position", "vec4f"),
    ("frag_depth", "f32"),
    ("front_facing", "bool"),
    ("vertex_index", "u32"),
    ("instance_index", "u32"),
    ("sample_index", "u32"),
    ("sample_mask", "u32"),
    ("local_invocation_index", "u32"),
    ("local_invocation_id", "vec3u"),
    ("global_invocation_id", "vec3u"),
    ("workgroup_id", "vec3u"),
];

/// The builtins that a stage is given.
const BUILT_INS_OF: [(&str, &str); 3] = [
    ("vertex", "`vertex_index` and `instance_index`"),
    ("fragment", "`position`, `front_facing`, `sample_index` and `sample_mask`"),
    (
        "compute",
        "`global_invocation_id`, `local_invocation_id`, `local_invocation_index`, `workgroup_id` \
         and `num_workgroups`",
    ),
];

/// Adds the place of an input or output, and what to write there.
pub fn advise_port(text: &str, port: &Port, wrong: &Interface, mistake: &mut Mistake) {
    let source = Source::new(text);
    let Some(lookup) = &source.lookup else { return };
    let Some(head) = lookup.head_named(&port.entry) else { return };
    let parameter = port.parameter.and_then(|at| head.parameters.get(at)).copied();
    let held = parameter.and_then(|one| one.of_type).or(head.result);
    let member = port.member.and_then(|at| {
        let members = lookup.members(source.part(held?));
        members.get(at).copied()
    });
    let (declared, used) = match member.or(parameter) {
        Some(found) => {
            let end = found.of_type.map_or(found.place.end, |of_type| of_type.end) as usize;
            let range = found.place.start as usize..end;
            mistake.place(range.clone(), label_of(wrong));
            (source.slice(&range).to_owned(), locations(&source, lookup, &port.entry, held))
        }
        None => {
            let Some(result) = head.result else { return };
            mistake.place(result.range(), label_of(wrong));
            (source.part(result).to_owned(), Vec::new())
        }
    };
    mistake.labels.truncate(1);
    let free = (0..).find(|location| !used.contains(location)).unwrap_or(0);
    let is_result = port.parameter.is_none() && member.is_none();
    write_port(wrong, &declared, free, is_result, mistake);
}

/// What to write in place of a declaration.
fn write_port(
    wrong: &Interface,
    declared: &str,
    free: u32,
    is_result: bool,
    mistake: &mut Mistake,
) {
    match wrong {
        Interface::Unplaced { is_vertex: true } if is_result => {
            mistake.write(format!("-> @builtin(position) {declared}"));
        }
        Interface::Unplaced { .. } if is_result => {
            mistake.write(format!("-> @location(0) {declared}"));
        }
        Interface::Unplaced { .. } => mistake.write(format!("@location({free}) {declared}")),
        Interface::Interpolated => mistake.write(format!("@interpolate(flat) {declared}")),
        Interface::Taken => mistake.write(format!("@location({free}) {declared}")),
        Interface::Typed { built_in } => {
            let of = BUILT_IN_TYPES.iter().find(|(name, _)| name == built_in);
            if let Some((_, of_type)) = of {
                let name = declared.split(':').next().unwrap_or_default().trim();
                mistake.write(match is_result {
                    true => format!("@builtin({built_in}) {of_type}"),
                    false => format!("@builtin({built_in}) {name}: {of_type}"),
                });
            }
        }
        Interface::Foreign { stage } => {
            if let Some((_, names)) = BUILT_INS_OF.iter().find(|(name, _)| name == stage) {
                mistake.help(format!("a {stage} shader is given {names}"));
            }
        }
    }
}

fn label_of(wrong: &Interface) -> &'static str {
    match wrong {
        Interface::Unplaced { .. } => "neither `@location` nor `@builtin`",
        Interface::Interpolated => "an integer",
        Interface::Taken => "its location is taken",
        Interface::Typed { .. } => "of another type",
        Interface::Foreign { .. } => "not in this stage",
    }
}

/// The numbers of the locations that a head, or a structure, writes.
fn locations(
    source: &Source<'_>,
    lookup: &Lookup<'_>,
    entry: &str,
    held: Option<lamplight_rules::Place>,
) -> Vec<u32> {
    let name = held.map_or("", |held| source.part(held));
    let text = match lookup.members(name).as_slice() {
        [] => lookup.head_named(entry).map_or("", |head| {
            let rest = &source.text[head.place.start as usize..];
            rest.split("->").next().unwrap_or(rest)
        }),
        [first, ..] => {
            let rest = &source.text[..first.place.start as usize];
            let start = rest.rfind("struct").unwrap_or(0);
            source.text[start..].split('}').next().unwrap_or_default()
        }
    };
    let numbers = text.split("@location(").skip(1);
    numbers.filter_map(|rest| rest.split(')').next()?.trim().parse().ok()).collect()
}

/// Adds what to write in place of a variable's declaration.
pub fn advise_variable(text: &str, name: &str, wrong: &Variable, mistake: &mut Mistake) {
    let source = Source::new(text);
    let Some(lookup) = &source.lookup else { return };
    let Some(declared) = lookup.declared(name, 0) else { return };
    let of_type = declared.of_type.map_or("", |of_type| source.part(of_type));
    match wrong {
        Variable::Unbound => {
            let rest = &source.text[declaration_start(&source, &declared)..];
            let line = rest.split(';').next().unwrap_or_default().trim();
            let free = free_binding(source.text);
            mistake.write(format!("@group(0) @binding({free}) {line};"));
        }
        Variable::Spaceless => {
            let value =
                declared.value.map_or(String::new(), |value| format!(" = {}", source.part(value)));
            let of = if of_type.is_empty() { String::new() } else { format!(": {of_type}") };
            mistake.write(format!("var<private> {name}{of}{value};"));
        }
        Variable::Strided => {
            let length = of_type.strip_prefix("array<").and_then(|inner| inner.rsplit(',').next());
            let length = length.map(|length| length.trim_end_matches('>').trim());
            let what = match length.filter(|length| !length.is_empty()) {
                Some(length) => format!("write `array<vec4f, {length}>` and read `{name}[i].x`"),
                None => "make them `vec4f`".to_owned(),
            };
            mistake.help(format!(
                "elements of a uniform array are 16 bytes apart: {what}, or `var<storage>`"
            ));
        }
        Variable::Boolean => boolean(&source, lookup, &declared, of_type, mistake),
        Variable::Collides => {
            let free = free_binding(source.text);
            mistake.help(format!("write `@binding({free})` for `{name}`"));
        }
        Variable::Initialised => {
            let value = declared.value.map_or("...", |value| source.part(value));
            mistake.help(format!("leave `= {value}` out: this memory begins as zero"));
        }
    }
}

/// The first free binding of group 0.
fn free_binding(text: &str) -> u32 {
    let numbers = text.split("@binding(").skip(1);
    let used: Vec<u32> =
        numbers.filter_map(|rest| rest.split(')').next()?.trim().parse().ok()).collect();
    (0..).find(|binding| !used.contains(binding)).unwrap_or(0)
}

/// Where the `var` of a declaration is.
fn declaration_start(source: &Source<'_>, declared: &Declared<'_>) -> usize {
    let before = &source.text[..declared.place.start as usize];
    before.rfind("var").unwrap_or(before.len())
}

/// A boolean in a buffer: the member that is one.
fn boolean(
    source: &Source<'_>,
    lookup: &Lookup<'_>,
    declared: &Declared<'_>,
    of_type: &str,
    mistake: &mut Mistake,
) {
    let members = lookup.members(of_type);
    let is_bool = |one: &&Declared<'_>| one.of_type.is_some_and(|of| source.part(of) == "bool");
    let name = declared.name;
    mistake.message = "a buffer cannot hold booleans".to_owned();
    match members.iter().find(is_bool) {
        Some(member) => {
            let end = member.of_type.map_or(member.place.end, |of| of.end) as usize;
            mistake.place(member.place.start as usize..end, "a boolean");
            mistake.labels.truncate(1);
            mistake.labels.push((declared.place.range(), "in this buffer".to_owned()));
            mistake.help(format!(
                "write `{}: u32`, and `{name}.{} != 0` where it is read",
                member.name, member.name
            ));
        }
        None => mistake.help(format!(
            "write `{}`, and compare it with `!= 0`",
            short_type(&of_type.replace("bool", "u32"))
        )),
    }
}

/// A texture that is a member: what to write beside the structure.
pub fn advise_held(text: &str, structure: &str, mistake: &mut Mistake) {
    let source = Source::new(text);
    let Some(lookup) = &source.lookup else { return };
    let members = lookup.members(structure);
    let is_binding = |one: &&Declared<'_>| {
        let of_type = one.of_type.map_or("", |of| source.part(of));
        of_type.starts_with("texture") || of_type.starts_with("sampler")
    };
    let Some(member) = members.iter().find(is_binding) else { return };
    let of_type = member.of_type.map_or("", |of| source.part(of));
    let end = member.of_type.map_or(member.place.end, |of| of.end) as usize;
    mistake.message = format!("`{of_type}` cannot be a member: textures and samplers are bindings");
    mistake.labels = vec![(member.place.start as usize..end, "not in a structure".to_owned())];
    let free = free_binding(source.text);
    mistake.write(format!("@group(0) @binding({free}) var {}: {of_type};", member.name));
}
