//! What one compilation takes: the SPIR-V of its stages and what lies around them.

use std::ffi::CString;
use std::fmt::Write as _;

use naga::ScalarKind;

use crate::bundle::{Kind, Reflection, Stage, Target, Varying};
use crate::emit;
use crate::validate::{CAPABILITIES, Validated};

/// A stage in SPIR-V.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Words {
    pub stage: Stage,
    pub entry: CString,
    pub words: Vec<u32>,
}

/// A resource by its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Slot {
    pub group: u32,
    pub binding: u32,
    pub kind: Kind,
}

/// A value by its location: an attribute of a vertex, or a colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Attribute {
    pub location: u32,
    pub scalar: ScalarKind,
    pub components: u8,
}

/// A pipeline to compile. Two equal ones have equal figures.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Pipeline {
    pub stages: Vec<Words>,
    pub slots: Vec<Slot>,
    pub attributes: Vec<Attribute>,
    /// By location; `None` where nothing is written to.
    pub colors: Vec<Option<Attribute>>,
}

/// A stage with what is known of it.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Known {
    pub words: Words,
    pub reflection: Reflection,
}

impl Known {
    /// From the bytes of a SPIR-V module.
    pub fn new(entry: &str, bytes: &[u8], reflection: Reflection) -> Option<Self> {
        let words = bytes.chunks_exact(4).map(|word| word.try_into().map(u32::from_le_bytes));
        let words = words.collect::<Result<Vec<u32>, _>>().ok()?;
        let entry = CString::new(entry).ok()?;
        Some(Self { words: Words { stage: reflection.stage, entry, words }, reflection })
    }

    /// From an entry point of a module.
    pub fn of_module(validated: &Validated, entry: &str) -> Option<Self> {
        let reflection = emit::reflect(validated, entry).ok()?;
        let emitted = emit::emit(validated, entry, Target::SPIRV).ok()?;
        Self::new(&emitted.native.entry_name, &emitted.bytes, reflection)
    }
}

impl Pipeline {
    /// The pipeline of a stage and the one that goes with it. Where a vertex or a fragment stage
    /// is alone, one is added that passes on, or uses, all that it shares with it.
    pub fn new(stage: Known, other: Option<Known>) -> Option<Self> {
        let other = match (stage.reflection.stage, other) {
            (Stage::Compute, _) => None,
            (_, Some(other)) => Some(other),
            (Stage::Fragment, None) => Some(partner(&before(&stage.reflection)?)?),
            (Stage::Vertex, None) => Some(partner(&after(&stage.reflection)?)?),
        };
        let mut stages: Vec<Known> = other.into_iter().chain([stage]).collect();
        stages.sort_by_key(|known| known.reflection.stage);
        let bindings = stages.iter().flat_map(|known| &known.reflection.bindings);
        let mut slots: Vec<Slot> = bindings
            .map(|found| Slot { group: found.group, binding: found.binding, kind: found.kind })
            .collect();
        slots.sort_unstable();
        slots.dedup();
        let of = |wanted: Stage| stages.iter().find(|known| known.reflection.stage == wanted);
        let inputs = of(Stage::Vertex).map_or(&[][..], |known| &known.reflection.inputs);
        let outputs = of(Stage::Fragment).map_or(&[][..], |known| &known.reflection.outputs);
        let attributes = inputs.iter().filter_map(Attribute::of).collect();
        let written: Vec<Attribute> = outputs.iter().filter_map(Attribute::of).collect();
        let count = written.iter().map(|color| color.location + 1).max().unwrap_or(0);
        let color = |location| written.iter().find(|color| color.location == location).copied();
        let colors = (0..count).map(color).collect();
        let stages = stages.into_iter().map(|known| known.words).collect();
        Some(Self { stages, slots, attributes, colors })
    }
}

impl Attribute {
    /// Of a value with a location; `None` for what is built in.
    fn of(varying: &Varying) -> Option<Self> {
        let (scalar, components) = shape(&varying.ty)?;
        Some(Self { location: varying.location?, scalar, components })
    }
}

/// Scalar and components of a scalar or vector type, as WGSL spells it.
fn shape(ty: &str) -> Option<(ScalarKind, u8)> {
    let (components, scalar) = match ty.strip_prefix("vec") {
        Some(rest) => {
            let (count, scalar) = rest.split_at_checked(1)?;
            (count.parse().ok()?, scalar.trim_matches(['<', '>']))
        }
        None => (1, ty),
    };
    let scalar = match scalar {
        "f32" | "f" => ScalarKind::Float,
        "i32" | "i" => ScalarKind::Sint,
        "u32" | "u" => ScalarKind::Uint,
        _ => return None,
    };
    Some((scalar, components))
}

/// A stage from a text of ours.
fn partner(text: &str) -> Option<Known> {
    let module = naga::front::wgsl::parse_str(text).ok()?;
    let flags = naga::valid::ValidationFlags::all();
    let info = naga::valid::Validator::new(flags, CAPABILITIES).validate(&module).ok()?;
    let validated = Validated { language: crate::bundle::Language::Wesl, module, info };
    Known::of_module(&validated, PARTNER)
}

const PARTNER: &str = "lamplight_partner";

/// The text of a vertex stage that gives a fragment stage its inputs, each from an attribute.
fn before(fragment: &Reflection) -> Option<String> {
    let mut members = "@builtin(position) position: vec4f,\n".to_owned();
    let (mut parameters, mut values) = (String::new(), String::new());
    let mut next = 0;
    for input in &fragment.inputs {
        let Some(location) = input.location else { continue };
        let ty = &input.ty;
        next = next.max(location + 1);
        let interpolation = match (input.interpolation.as_deref(), input.sampling.as_deref()) {
            (Some("flat"), _) => "@interpolate(flat) ".to_owned(),
            (Some(kind), Some(sampling)) => format!("@interpolate({kind}, {sampling}) "),
            (Some(kind), None) => format!("@interpolate({kind}) "),
            (None, _) => String::new(),
        };
        writeln!(members, "@location({location}) {interpolation}v{location}: {ty},").ok()?;
        write!(parameters, "@location({location}) a{location}: {ty}, ").ok()?;
        write!(values, ", a{location}").ok()?;
    }
    Some(format!(
        "struct Passed {{\n{members}}}\n@vertex fn {PARTNER}({parameters}@location({next}) at: vec4f) \
         -> Passed {{\n    return Passed(at{values});\n}}\n"
    ))
}

/// The text of a fragment stage that uses every output of a vertex stage.
fn after(vertex: &Reflection) -> Option<String> {
    let (mut parameters, mut sum) = (String::new(), String::new());
    for output in &vertex.outputs {
        let Some(location) = output.location else { continue };
        let (scalar, components) = shape(&output.ty)?;
        let flat = if scalar == ScalarKind::Float { "" } else { "@interpolate(flat) " };
        write!(parameters, "@location({location}) {flat}v{location}: {}, ", output.ty).ok()?;
        for component in ["x", "y", "z", "w"].iter().take(usize::from(components)) {
            let part = if components == 1 { String::new() } else { format!(".{component}") };
            write!(sum, " + f32(v{location}{part})").ok()?;
        }
    }
    Some(format!(
        "@fragment fn {PARTNER}({parameters}) -> @location(0) vec4f {{\n    return vec4f(0.0{sum});\n}}\n"
    ))
}
