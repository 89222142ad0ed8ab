//! Reads SPIR-V: entry points, bindings and layouts, by ids and decorations. Names are not needed,
//! so a module without them is read as well.

use std::collections::BTreeMap;

use lamplight_bundle::{Binding, BindingKind, BindingSlot, Stage};
use lamplight_emit::spirv::{SpirvInstruction, instructions, op, string, words};

use super::compare::{SlotRules, compare_reading};
use super::described::Described;
use super::reading::{ReadBinding, Reading};
use super::spirv_types::SpirvTypes;

/// Opcodes, beside those of [`op`].
const TYPE_SAMPLER: u16 = 26;
const TYPE_SAMPLED_IMAGE: u16 = 27;
const CONSTANT_COMPOSITE: u16 = 44;
const SPEC_CONSTANT_COMPOSITE: u16 = 51;

/// The execution mode with a workgroup's size.
const LOCAL_SIZE: u32 = 17;

/// The built-in that a constant with a workgroup's size is.
const WORKGROUP_SIZE: u32 = 25;

/// Storage classes.
const UNIFORM_CONSTANT: u32 = 0;
const UNIFORM: u32 = 2;
const PUSH_CONSTANT: u32 = 9;
const STORAGE_BUFFER: u32 = 12;

/// Decorations.
const BUFFER_BLOCK: u32 = 3;
const BUILT_IN: u32 = 11;
const BINDING: u32 = 33;
const DESCRIPTOR_SET: u32 = 34;

/// What differs between SPIR-V and what a bundle says of it.
pub fn spirv_differences(bytes: &[u8], described: Described<'_>) -> Result<Vec<String>, String> {
    let reading = read_spirv(bytes)?;
    let is_at = |_: &Binding, slot: &BindingSlot, found: &ReadBinding| {
        (slot.space, slot.index) == (found.space, found.index)
    };
    Ok(compare_reading(&reading, described, &SlotRules { is_at, leaves_out: true }))
}

/// Reads what stands before the first function.
pub fn read_spirv(bytes: &[u8]) -> Result<Reading, String> {
    let words = words(bytes);
    let mut module = SpirvModule::default();
    for instruction in instructions(&words).take_while(|one| one.op != op::FUNCTION) {
        module.see(instruction);
    }
    module.reading()
}

/// What stands before the first function.
#[derive(Default)]
struct SpirvModule<'w> {
    types: SpirvTypes<'w>,
    /// Stage and name of each entry point.
    entries: Vec<(u32, String)>,
    local_size: Option<[u32; 3]>,
    /// Id, type and storage class.
    variables: Vec<(u32, u32, u32)>,
    pointees: BTreeMap<u32, u32>,
    composites: BTreeMap<u32, &'w [u32]>,
}

impl<'w> SpirvModule<'w> {
    fn see(&mut self, SpirvInstruction { op, words }: SpirvInstruction<'w>) {
        match (op, words) {
            (op::ENTRY_POINT, [_, model, _, name @ ..]) => {
                self.entries.push((*model, string(name)));
            }
            (op::EXECUTION_MODE, [_, _, LOCAL_SIZE, x, y, z]) => {
                self.local_size = Some([*x, *y, *z])
            }
            (op::TYPE_POINTER, [_, id, _, pointee]) => _ = self.pointees.insert(*id, *pointee),
            (op::VARIABLE, [_, ty, id, class, ..]) => self.variables.push((*id, *ty, *class)),
            (CONSTANT_COMPOSITE | SPEC_CONSTANT_COMPOSITE, [_, _, id, parts @ ..]) => {
                self.composites.insert(*id, parts);
            }
            _ => self.types.see(op, words),
        }
    }

    fn reading(&self) -> Result<Reading, String> {
        let [(model, entry)] = self.entries.as_slice() else {
            return Err(format!("it has {} entry points", self.entries.len()));
        };
        let stage = match model {
            0 => Stage::Vertex,
            4 => Stage::Fragment,
            5 => Stage::Compute,
            other => return Err(format!("it has the execution model {other}")),
        };
        let bindings = self.variables.iter().map(|one| self.read_variable(*one));
        let bindings =
            bindings.collect::<Result<Vec<_>, String>>()?.into_iter().flatten().collect();
        let workgroup_size = self.composed_size().or(self.local_size);
        Ok(Reading { entry: Some(entry.clone()), stage: Some(stage), workgroup_size, bindings })
    }

    /// The size that a constant has, which goes before the execution mode.
    fn composed_size(&self) -> Option<[u32; 3]> {
        let is_size = |id: &u32| self.types.decoration(*id, BUILT_IN) == Some(WORKGROUP_SIZE);
        let (_, parts) = self.composites.iter().find(|(id, _)| is_size(id))?;
        let parts: Option<Vec<u32>> = parts.iter().map(|id| self.types.constant(*id)).collect();
        parts?.try_into().ok()
    }

    /// A variable, if a host binds it.
    fn read_variable(
        &self,
        (id, ty, class): (u32, u32, u32),
    ) -> Result<Option<ReadBinding>, String> {
        if ![UNIFORM_CONSTANT, UNIFORM, PUSH_CONSTANT, STORAGE_BUFFER].contains(&class) {
            return Ok(None);
        }
        let pointee = self.pointees.get(&ty).ok_or("a variable's type is no pointer")?;
        let (bound, count) = self.bound_type(*pointee);
        let kind = self.kind_of(bound, class);
        let is_buffer = kind.is_buffer();
        // The block has the name that hosts of OpenGL look up.
        let name = self.types.name(if is_buffer { bound } else { id });
        Ok(Some(ReadBinding {
            space: self.types.decoration(id, DESCRIPTOR_SET),
            index: self.types.decoration(id, BINDING),
            name: name.map(str::to_owned),
            kind: Some(kind),
            count,
            ty: is_buffer.then(|| self.types.read_type(bound)).transpose()?,
            dimension: self.types.dimension(bound),
            register: None,
        }))
    }

    /// What is bound, without the array of bindings that it may be in. An array of numbers in a
    /// buffer is always in a block.
    fn bound_type(&self, ty: u32) -> (u32, Option<u32>) {
        match self.types.array_parts(ty) {
            Some((element, count)) => (element, Some(count)),
            None => (ty, None),
        }
    }

    fn kind_of(&self, ty: u32, class: u32) -> BindingKind {
        let is_buffer_block = self.types.is_decorated(ty, BUFFER_BLOCK);
        match (class, self.types.opcode(ty)) {
            (STORAGE_BUFFER, _) => BindingKind::Storage,
            (PUSH_CONSTANT, _) => BindingKind::Immediate,
            (UNIFORM, _) if is_buffer_block => BindingKind::Storage,
            (UNIFORM, _) => BindingKind::Uniform,
            (_, Some(TYPE_SAMPLER)) => BindingKind::Sampler,
            (_, Some(TYPE_SAMPLED_IMAGE)) => BindingKind::Texture,
            _ if self.types.is_storage_image(ty) => BindingKind::StorageTexture,
            _ => BindingKind::Texture,
        }
    }
}
