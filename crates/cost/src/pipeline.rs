//! A pipeline to compile: the SPIR-V of its stages, and the state around them.

use std::collections::BTreeSet;
use std::ffi::CString;

use naga::ScalarKind;

use lamplight_bundle::{Binding, BindingKind, Conventions, Reflection, Stage, Target, Varying};
use lamplight_diagnostic::Diagnostic;
use lamplight_emit as emit;
use lamplight_emit::spirv;
use lamplight_validate::{Validated, info_of};

/// A stage in SPIR-V.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct SpirvStage {
    pub stage: Stage,
    pub entry: CString,
    pub words: Vec<u32>,
    /// Specialisation constants: the number, and the 32 bits of the value. Those that are not
    /// listed have their defaults.
    pub constants: Vec<(u32, u32)>,
}

/// A resource by its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ResourceSlot {
    pub group: u32,
    pub binding: u32,
    pub kind: SlotKind,
    /// The length of an array of resources, else 1.
    pub count: u32,
}

/// What is bound at a place. Shaders of other compilers have kinds that the project's have not.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum SlotKind {
    Plain(BindingKind),
    /// A texture with its sampler.
    Combined,
    TexelBuffer,
    StorageTexelBuffer,
    InputAttachment,
}

/// A value at a location: a vertex attribute or a colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct LocationAttribute {
    pub location: u32,
    pub scalar: ScalarKind,
    pub components: u8,
}

/// A pipeline to compile. Equal pipelines have equal figures.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Pipeline {
    pub stages: Vec<SpirvStage>,
    pub slots: Vec<ResourceSlot>,
    pub attributes: Vec<LocationAttribute>,
    /// By location; `None` where nothing is written.
    pub colors: Vec<Option<LocationAttribute>>,
    /// Whether a stage reads push constants.
    pub has_push: bool,
}

/// A stage, with its reflection.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct ReflectedStage {
    pub words: SpirvStage,
    pub reflection: Reflection,
    /// The resources.
    pub slots: Vec<ResourceSlot>,
    /// Whether it reads push constants.
    pub has_push: bool,
}

impl ReflectedStage {
    /// From the bytes of a SPIR-V module.
    ///
    /// # Errors
    /// They are no words, or the entry point's name has a zero.
    pub fn new(entry: &str, bytes: &[u8], reflection: Reflection) -> Result<Self, String> {
        if !bytes.len().is_multiple_of(4) {
            return Err(format!("{} bytes of SPIR-V are not a whole number of words", bytes.len()));
        }
        let words = spirv::words(bytes);
        let entry = CString::new(entry).map_err(|error| error.to_string())?;
        let stage = reflection.stage;
        let words = SpirvStage { stage, entry, words, constants: Vec::new() };
        let is_push = |one: &&Binding| one.kind == BindingKind::Immediate;
        let has_push = reflection.bindings.iter().any(|one| is_push(&one));
        let bound = reflection.bindings.iter().filter(|one| !is_push(one));
        let slots = bound.map(binding_slot).collect();
        Ok(Self { words, reflection, slots, has_push })
    }

    /// From an entry point of a module, with these conventions.
    ///
    /// # Errors
    /// What the writer of SPIR-V says.
    pub fn of_module(
        validated: &Validated,
        entry: &str,
        conventions: Conventions,
    ) -> Result<Self, String> {
        let message_of = |error: Diagnostic| error.message;
        let reflection = emit::reflect(validated, entry).map_err(message_of)?;
        let emitted =
            emit::emit_for(validated, entry, Target::SPIRV, conventions).map_err(message_of)?;
        Self::new(&emitted.native.entry_name, &emitted.bytes, reflection)
    }
}

impl Pipeline {
    /// The pipeline of a stage and its partner. A vertex or a fragment stage without a partner gets
    /// one that provides, or uses, everything that passes between them.
    ///
    /// # Errors
    /// No partner can be written for it, because of a type that passes between the two.
    pub fn new(stage: ReflectedStage, other: Option<ReflectedStage>) -> Result<Self, String> {
        let other = match (stage.reflection.stage, other) {
            (Stage::Compute, _) => None,
            (_, Some(other)) => Some(other),
            (Stage::Fragment, None) => Some(partner_stage(&vertex_text(&stage.reflection))?),
            (Stage::Vertex, None) => Some(partner_stage(&fragment_text(&stage.reflection)?)?),
        };
        let mut stages: Vec<ReflectedStage> = other.into_iter().chain([stage]).collect();
        stages.sort_by_key(|known| known.reflection.stage);
        let of = |wanted: Stage| stages.iter().find(|known| known.reflection.stage == wanted);
        let inputs = of(Stage::Vertex).map_or(&[][..], |known| &known.reflection.inputs);
        let outputs = of(Stage::Fragment).map_or(&[][..], |known| &known.reflection.outputs);
        let attributes = located_values(inputs)?;
        let colors = color_targets(&located_values(outputs)?);
        let slots: BTreeSet<ResourceSlot> =
            stages.iter().flat_map(|known| known.slots.iter().copied()).collect();
        let slots = each_place(slots);
        let has_push = stages.iter().any(|known| known.has_push);
        let stages = stages.into_iter().map(|known| known.words).collect();
        Ok(Self { stages, slots, attributes, colors, has_push })
    }
}

fn binding_slot(found: &Binding) -> ResourceSlot {
    let Binding { group, binding, kind, .. } = found;
    let kind = SlotKind::Plain(*kind);
    ResourceSlot { group: *group, binding: *binding, kind, count: 1 }
}

/// Resources with each place once, as a layout needs it. Two names may have one place.
fn each_place(slots: BTreeSet<ResourceSlot>) -> Vec<ResourceSlot> {
    let mut slots: Vec<ResourceSlot> = slots.into_iter().collect();
    slots.dedup_by_key(|slot| (slot.group, slot.binding));
    slots
}

/// The values that have a location. The others are built-ins.
fn located_values(values: &[Varying]) -> Result<Vec<LocationAttribute>, String> {
    let located = values.iter().filter_map(|value| Some((value.location?, &value.ty)));
    let attribute = |(location, ty): (u32, &String)| {
        let (scalar, components) = scalar_and_count(ty)?;
        Ok(LocationAttribute { location, scalar, components })
    };
    located.map(attribute).collect()
}

fn color_targets(written: &[LocationAttribute]) -> Vec<Option<LocationAttribute>> {
    let count = written.iter().map(|color| color.location + 1).max().unwrap_or(0);
    let color = |location| written.iter().find(|color| color.location == location).copied();
    (0..count).map(color).collect()
}

/// Scalar and components of a scalar or vector type, as WGSL spells it.
fn scalar_and_count(ty: &str) -> Result<(ScalarKind, u8), String> {
    let (components, scalar) =
        match ty.strip_prefix("vec").and_then(|rest| rest.split_at_checked(1)) {
            Some((count, scalar)) => (count, scalar.trim_matches(['<', '>'])),
            None => ("1", ty),
        };
    let scalar = match scalar {
        "f32" | "f" => Some(ScalarKind::Float),
        "i32" | "i" => Some(ScalarKind::Sint),
        "u32" | "u" => Some(ScalarKind::Uint),
        _ => None,
    };
    let shape = scalar.zip(components.parse().ok());
    shape.ok_or_else(|| format!("a value of type `{ty}` at a location has no format of 32 bits"))
}

/// Compiles the WGSL text of a partner stage.
fn partner_stage(text: &str) -> Result<ReflectedStage, String> {
    let with_context = |error: &dyn std::fmt::Display| format!("the stage added to it: {error}");
    let module = naga::front::wgsl::parse_str(text).map_err(|error| with_context(&error))?;
    let info = info_of(&module).map_err(|error| with_context(&error))?;
    let validated = Validated { module, info, portable: true };
    ReflectedStage::of_module(&validated, PARTNER, Conventions::default())
}

const PARTNER: &str = "lamplight_partner";

/// The text of a vertex stage that provides the inputs of a fragment stage, each from an attribute.
fn vertex_text(fragment: &Reflection) -> String {
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
        members += &format!("@location({location}) {interpolation}v{location}: {ty},\n");
        parameters += &format!("@location({location}) a{location}: {ty}, ");
        values += &format!(", a{location}");
    }
    format!(
        "struct Passed {{\n{members}}}\n@vertex fn {PARTNER}({parameters}@location({next}) at: vec4f) \
         -> Passed {{\n    return Passed(at{values});\n}}\n"
    )
}

/// The text of a fragment stage that uses every output of a vertex stage.
fn fragment_text(vertex: &Reflection) -> Result<String, String> {
    let (mut parameters, mut sum) = (String::new(), String::new());
    for LocationAttribute { location, scalar, components } in located_values(&vertex.outputs)? {
        let ty = vertex.outputs.iter().find(|output| output.location == Some(location));
        let ty = ty.map_or("", |output| &output.ty);
        let flat = if scalar == ScalarKind::Float { "" } else { "@interpolate(flat) " };
        parameters += &format!("@location({location}) {flat}v{location}: {ty}, ");
        for component in ["x", "y", "z", "w"].iter().take(usize::from(components)) {
            let part = if components == 1 { String::new() } else { format!(".{component}") };
            sum += &format!(" + f32(v{location}{part})");
        }
    }
    Ok(format!(
        "@fragment fn {PARTNER}({parameters}) -> @location(0) vec4f {{\n    return vec4f(0.0{sum});\n}}\n"
    ))
}
