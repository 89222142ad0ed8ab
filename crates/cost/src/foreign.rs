//! Stages of SPIR-V that another compiler wrote: what passes between them, and their resources.

use std::collections::HashMap;
use std::ffi::CString;

use lamplight_bundle::{BindingKind, Reflection, Stage, Varying};
use lamplight_emit::spirv::{self, HEADER_WORDS, op};

use crate::pipeline::{ReflectedStage, ResourceSlot, SlotKind, SpirvStage};

/// The first word of a module.
pub const MAGIC: u32 = 0x0723_0203;

/// Why no stages could be made of a module.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ForeignError {
    /// It does not begin as SPIR-V in little-endian words does.
    NoModule,
    /// An instruction is shorter than its kind, or cut off.
    CutOff,
    /// It has no entry points.
    NoEntry,
    /// A stage that no pipeline of this crate has.
    UnknownStage(String),
    /// A resource of a kind that no layout of this crate has.
    UnknownResource(String),
    /// A type that cannot pass between stages here.
    UnknownType(String),
}

impl std::fmt::Display for ForeignError {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NoModule => write!(out, "this is not SPIR-V in little-endian words"),
            Self::CutOff => write!(out, "the SPIR-V is cut off"),
            Self::NoEntry => write!(out, "the SPIR-V has no entry points"),
            Self::UnknownStage(name) => {
                write!(out, "`{name}` is neither a vertex nor a fragment nor a compute stage")
            }
            Self::UnknownResource(place) => {
                write!(out, "the resource at {place} is of a kind that is not measured")
            }
            Self::UnknownType(what) => {
                write!(out, "`{what}` is no scalar or vector of 32 bits, nor an array of them")
            }
        }
    }
}

impl std::error::Error for ForeignError {}

/// The stages of a module, one for each entry point.
///
/// # Errors
/// What the module lacks. It is read as a valid one: ask `spirv-val` first.
pub fn foreign_stages(bytes: &[u8]) -> Result<Vec<ReflectedStage>, ForeignError> {
    let words = spirv::words(bytes);
    if words.first() != Some(&MAGIC) || !bytes.len().is_multiple_of(4) {
        return Err(ForeignError::NoModule);
    }
    let module = Module::read(&words)?;
    if module.entries.is_empty() {
        return Err(ForeignError::NoEntry);
    }
    module.entries.iter().map(|entry| module.stage(entry, &words)).collect()
}

/// The names of numbers in the specification of SPIR-V.
mod number {
    pub const VERTEX: u32 = 0;
    pub const FRAGMENT: u32 = 4;
    pub const COMPUTE: u32 = 5;

    pub const BLOCK: u32 = 2;
    pub const BUFFER_BLOCK: u32 = 3;
    pub const BUILT_IN: u32 = 11;
    pub const NO_PERSPECTIVE: u32 = 13;
    pub const FLAT: u32 = 14;
    pub const CENTROID: u32 = 16;
    pub const SAMPLE: u32 = 17;
    pub const LOCATION: u32 = 30;
    pub const BINDING: u32 = 33;
    pub const DESCRIPTOR_SET: u32 = 34;

    pub const INPUT: u32 = 1;
    pub const OUTPUT: u32 = 3;
    pub const UNIFORM_CONSTANT: u32 = 0;
    pub const UNIFORM: u32 = 2;
    pub const PUSH_CONSTANT: u32 = 9;
    pub const STORAGE_BUFFER: u32 = 12;

    pub const BUFFER_DIMENSION: u32 = 5;
    pub const SUBPASS_DIMENSION: u32 = 6;
    /// An image that is read and written without a sampler.
    pub const STORAGE_IMAGE: u32 = 2;
}

struct Entry {
    model: u32,
    name: String,
    interface: Vec<u32>,
}

#[derive(Debug, Clone)]
enum Type {
    Scalar(&'static str),
    Vector(u32, u32),
    Matrix(u32, u32),
    Array(u32, u32),
    /// An array whose length the host chooses.
    Unsized(u32),
    Struct(Vec<u32>),
    Image {
        dimension: u32,
        sampled: u32,
    },
    Sampler,
    SampledImage,
    Pointer(u32),
    Other,
}

struct Variable {
    id: u32,
    pointer: u32,
    storage: u32,
}

#[derive(Default)]
struct Module {
    entries: Vec<Entry>,
    types: HashMap<u32, Type>,
    constants: HashMap<u32, u32>,
    variables: Vec<Variable>,
    /// By id and decoration.
    decorations: HashMap<(u32, u32), u32>,
    /// By id, member and decoration.
    members: HashMap<(u32, u32, u32), u32>,
}

impl Module {
    fn read(words: &[u32]) -> Result<Self, ForeignError> {
        let mut module = Self::default();
        let mut rest = words.get(HEADER_WORDS..).ok_or(ForeignError::CutOff)?;
        while let Some((instruction, after)) =
            spirv::split_first(rest).map_err(|_| ForeignError::CutOff)?
        {
            if instruction.op == op::FUNCTION {
                break;
            }
            module.take(instruction.op, instruction.words).ok_or(ForeignError::CutOff)?;
            rest = after;
        }
        Ok(module)
    }

    /// Takes one instruction; nothing where it has too few words.
    fn take(&mut self, code: u16, words: &[u32]) -> Option<()> {
        let at = |index: usize| words.get(index).copied();
        match code {
            op::ENTRY_POINT => {
                let name = spirv::string(words.get(3..)?);
                let interface = words.get(3 + name.len() / 4 + 1..)?.to_vec();
                self.entries.push(Entry { model: at(1)?, name, interface });
            }
            op::DECORATE => {
                self.decorations.insert((at(1)?, at(2)?), at(3).unwrap_or_default());
            }
            op::MEMBER_DECORATE => {
                self.members.insert((at(1)?, at(2)?, at(3)?), at(4).unwrap_or_default());
            }
            op::CONSTANT | op::SPEC_CONSTANT => {
                self.constants.insert(at(2)?, at(3)?);
            }
            op::VARIABLE => {
                self.variables.push(Variable { id: at(2)?, pointer: at(1)?, storage: at(3)? });
            }
            19..=39 => {
                self.types.insert(at(1)?, read_type(code, words)?);
            }
            _ => {}
        }
        Some(())
    }

    fn stage(&self, entry: &Entry, words: &[u32]) -> Result<ReflectedStage, ForeignError> {
        let stage = match entry.model {
            number::VERTEX => Stage::Vertex,
            number::FRAGMENT => Stage::Fragment,
            number::COMPUTE => Stage::Compute,
            _ => return Err(ForeignError::UnknownStage(entry.name.clone())),
        };
        let mut reflection = Reflection::of(stage);
        if stage != Stage::Compute {
            reflection.inputs = self.values(entry, number::INPUT)?;
            reflection.outputs = self.values(entry, number::OUTPUT)?;
        }
        // A string of SPIR-V ends at its first zero.
        let name = CString::new(entry.name.as_str()).unwrap_or_default();
        let words = SpirvStage { stage, entry: name, words: words.to_vec(), constants: Vec::new() };
        let slots = self.variables.iter().map(|variable| self.slot(variable));
        let slots = slots.filter_map(Result::transpose).collect::<Result<Vec<_>, _>>()?;
        let has_push = self.variables.iter().any(|found| found.storage == number::PUSH_CONSTANT);
        Ok(ReflectedStage { words, reflection, slots, has_push })
    }

    /// The values of an entry point at locations, in their order.
    fn values(&self, entry: &Entry, storage: u32) -> Result<Vec<Varying>, ForeignError> {
        let mut values: Vec<Varying> = Vec::new();
        for variable in &self.variables {
            if variable.storage != storage || !entry.interface.contains(&variable.id) {
                continue;
            }
            let of = |decoration: u32| self.decorations.get(&(variable.id, decoration)).copied();
            if of(number::BUILT_IN).is_some() {
                continue;
            }
            let ty = self.pointee(variable.pointer);
            match self.types.get(&ty) {
                Some(Type::Struct(members)) => {
                    self.block_values(&mut values, ty, members, of(number::LOCATION))?;
                }
                _ => {
                    let location = of(number::LOCATION).unwrap_or_default();
                    self.push_values(&mut values, ty, location, &of)?;
                }
            }
        }
        values.sort_by_key(|value| value.location);
        values.dedup_by_key(|value| value.location);
        Ok(values)
    }

    /// The values of a block. Members without a location of their own follow the one before.
    fn block_values(
        &self,
        values: &mut Vec<Varying>,
        block: u32,
        members: &[u32],
        first: Option<u32>,
    ) -> Result<(), ForeignError> {
        let mut next = first.unwrap_or_default();
        for (member, ty) in (0..).zip(members) {
            let of = |decoration: u32| self.members.get(&(block, member, decoration)).copied();
            if of(number::BUILT_IN).is_some() {
                continue;
            }
            let location = of(number::LOCATION).unwrap_or(next);
            next = self.push_values(values, *ty, location, &of)?;
        }
        Ok(())
    }

    /// Adds the values of a type from a location on, and gives the location behind them.
    fn push_values(
        &self,
        values: &mut Vec<Varying>,
        ty: u32,
        location: u32,
        of: &dyn Fn(u32) -> Option<u32>,
    ) -> Result<u32, ForeignError> {
        match self.types.get(&ty) {
            Some(Type::Array(element, length)) | Some(Type::Matrix(element, length)) => {
                let length = match self.types.get(&ty) {
                    Some(Type::Array(..)) => self.constants.get(length).copied().unwrap_or(1),
                    _ => *length,
                };
                let mut next = location;
                for _ in 0..length.min(MOST_LOCATIONS) {
                    next = self.push_values(values, *element, next, of)?;
                }
                Ok(next)
            }
            _ => {
                let ty = self.written(ty)?;
                let is_integer = !ty.contains("f32");
                let interpolation = match (of(number::FLAT), of(number::NO_PERSPECTIVE)) {
                    (Some(_), _) => Some("flat"),
                    _ if is_integer => Some("flat"),
                    (None, Some(_)) => Some("linear"),
                    (None, None) => None,
                };
                let sampling = match (of(number::CENTROID), of(number::SAMPLE)) {
                    (Some(_), _) => Some("centroid"),
                    (None, Some(_)) => Some("sample"),
                    (None, None) => None,
                };
                let perspective = sampling.filter(|_| interpolation != Some("flat"));
                let interpolation = interpolation.or(perspective.map(|_| "perspective"));
                values.push(Varying {
                    name: None,
                    location: Some(location),
                    builtin: None,
                    ty,
                    shape: None,
                    interpolation: interpolation.map(str::to_owned),
                    sampling: perspective.map(str::to_owned),
                    blend_src: None,
                });
                Ok(location + 1)
            }
        }
    }

    /// A scalar or vector type as WGSL writes it.
    fn written(&self, ty: u32) -> Result<String, ForeignError> {
        let scalar = |ty: u32| match self.types.get(&ty) {
            Some(Type::Scalar(name)) => Some(*name),
            _ => None,
        };
        let found = match self.types.get(&ty) {
            Some(Type::Scalar(name)) => Some((*name).to_owned()),
            Some(Type::Vector(of, count)) => scalar(*of).map(|of| format!("vec{count}<{of}>")),
            _ => None,
        };
        let unknown = || format!("{:?}", self.types.get(&ty));
        found.ok_or_else(|| ForeignError::UnknownType(unknown()))
    }

    fn pointee(&self, pointer: u32) -> u32 {
        match self.types.get(&pointer) {
            Some(Type::Pointer(to)) => *to,
            _ => pointer,
        }
    }

    /// The place of a resource; nothing where a variable is none.
    fn slot(&self, variable: &Variable) -> Result<Option<ResourceSlot>, ForeignError> {
        let of = |decoration: u32| self.decorations.get(&(variable.id, decoration)).copied();
        let place = of(number::DESCRIPTOR_SET).zip(of(number::BINDING));
        let Some((group, binding)) = place else { return Ok(None) };
        let (ty, count) = match self.types.get(&self.pointee(variable.pointer)) {
            Some(Type::Array(of, length)) => {
                (*of, self.constants.get(length).copied().unwrap_or(1))
            }
            Some(Type::Unsized(of)) => (*of, 1),
            _ => (self.pointee(variable.pointer), 1),
        };
        let kind = self.slot_kind(variable.storage, ty).ok_or_else(|| {
            ForeignError::UnknownResource(format!("group {group}, binding {binding}"))
        })?;
        Ok(Some(ResourceSlot { group, binding, kind, count: count.clamp(1, MOST_DESCRIPTORS) }))
    }

    fn slot_kind(&self, storage: u32, ty: u32) -> Option<SlotKind> {
        let is_block = |decoration: u32| self.decorations.contains_key(&(ty, decoration));
        Some(match (storage, self.types.get(&ty)?) {
            (number::STORAGE_BUFFER, _) => SlotKind::Plain(BindingKind::Storage),
            (number::UNIFORM, _) if is_block(number::BUFFER_BLOCK) => {
                SlotKind::Plain(BindingKind::Storage)
            }
            (number::UNIFORM, _) if is_block(number::BLOCK) => {
                SlotKind::Plain(BindingKind::Uniform)
            }
            (number::UNIFORM_CONSTANT, Type::Sampler) => SlotKind::Plain(BindingKind::Sampler),
            (number::UNIFORM_CONSTANT, Type::SampledImage) => SlotKind::Combined,
            (number::UNIFORM_CONSTANT, Type::Image { dimension, sampled }) => {
                image_kind(*dimension, *sampled)
            }
            _ => return None,
        })
    }
}

/// No device has more locations between stages.
const MOST_LOCATIONS: u32 = 128;

/// A bound on arrays of resources, which only matters to inputs that are not valid.
const MOST_DESCRIPTORS: u32 = 1 << 16;

fn image_kind(dimension: u32, sampled: u32) -> SlotKind {
    match (dimension, sampled) {
        (number::SUBPASS_DIMENSION, _) => SlotKind::InputAttachment,
        (number::BUFFER_DIMENSION, number::STORAGE_IMAGE) => SlotKind::StorageTexelBuffer,
        (number::BUFFER_DIMENSION, _) => SlotKind::TexelBuffer,
        (_, number::STORAGE_IMAGE) => SlotKind::Plain(BindingKind::StorageTexture),
        _ => SlotKind::Plain(BindingKind::Texture),
    }
}

fn read_type(code: u16, words: &[u32]) -> Option<Type> {
    let at = |index: usize| words.get(index).copied();
    Some(match code {
        21 => match (at(2)?, at(3)?) {
            (32, 0) => Type::Scalar("u32"),
            (32, _) => Type::Scalar("i32"),
            _ => Type::Other,
        },
        22 if at(2)? == 32 => Type::Scalar("f32"),
        23 => Type::Vector(at(2)?, at(3)?),
        24 => Type::Matrix(at(2)?, at(3)?),
        25 => Type::Image { dimension: at(3)?, sampled: at(7)? },
        26 => Type::Sampler,
        27 => Type::SampledImage,
        28 => Type::Array(at(2)?, at(3)?),
        29 => Type::Unsized(at(2)?),
        30 => Type::Struct(words.get(2..)?.to_vec()),
        32 => Type::Pointer(at(3)?),
        _ => Type::Other,
    })
}
