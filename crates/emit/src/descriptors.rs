//! What naga leaves out of SPIR-V with arrays of descriptors: their capabilities, and that the
//! structures in arrays of uniform buffers are blocks.

use std::collections::{BTreeMap, BTreeSet};

use super::spirv::{HEADER_WORDS, SpirvInstruction, first_word, instructions, op};

/// Storage classes.
const UNIFORM_CONSTANT: u32 = 0;
const UNIFORM: u32 = 2;
const STORAGE_BUFFER: u32 = 12;

/// The operand of an image's type that says whether it is sampled, and its value for storage.
const SAMPLED: usize = 7;
const STORAGE: u32 = 2;

/// Decorations.
const BLOCK: u32 = 2;
const BUFFER_BLOCK: u32 = 3;

/// Capabilities.
const NON_UNIFORM: u32 = 5301;
const RUNTIME_ARRAY: u32 = 5302;

const EXTENSION: &str = "SPV_EXT_descriptor_indexing";

/// Kinds of descriptors: the capability for indices that are not constant, and that for indices
/// that differ within a draw.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum ArrayKind {
    UniformBuffer,
    SampledImage,
    StorageBuffer,
    StorageImage,
}

impl ArrayKind {
    fn dynamic(self) -> u32 {
        28 + self as u32
    }

    fn non_uniform(self) -> u32 {
        5306 + self as u32
    }
}

/// What the instructions before the first function say.
#[derive(Default)]
struct Declared {
    /// Element types of arrays, and whether the array has no length.
    arrays: BTreeMap<u32, (u32, bool)>,
    storage_images: BTreeSet<u32>,
    structures: BTreeSet<u32>,
    pointees: BTreeMap<u32, u32>,
    blocks: BTreeSet<u32>,
    kinds: BTreeSet<ArrayKind>,
    unsized_arrays: bool,
    uniform_structures: BTreeSet<u32>,
    non_uniform: bool,
}

impl Declared {
    fn of(words: &[u32]) -> Self {
        let mut found = Self::default();
        for instruction in instructions(words) {
            if instruction.op == op::FUNCTION {
                break;
            }
            found.see(instruction);
        }
        found
    }

    fn see(&mut self, SpirvInstruction { op, words }: SpirvInstruction<'_>) {
        match (op, words) {
            (op::CAPABILITY, [_, NON_UNIFORM]) => self.non_uniform = true,
            (op::DECORATE, [_, id, BLOCK | BUFFER_BLOCK]) => {
                self.blocks.insert(*id);
            }
            (op::TYPE_IMAGE, [_, id, ..]) if words.get(SAMPLED) == Some(&STORAGE) => {
                self.storage_images.insert(*id);
            }
            (op::TYPE_ARRAY, [_, id, element, _]) => {
                self.arrays.insert(*id, (*element, false));
            }
            (op::TYPE_RUNTIME_ARRAY, [_, id, element]) => {
                self.arrays.insert(*id, (*element, true));
            }
            (op::TYPE_STRUCT, [_, id, ..]) => {
                self.structures.insert(*id);
            }
            (op::TYPE_POINTER, [_, id, _, pointee]) => {
                self.pointees.insert(*id, *pointee);
            }
            (op::VARIABLE, [_, pointer, _, class, ..]) => self.see_variable(*pointer, *class),
            _ => {}
        }
    }

    fn see_variable(&mut self, pointer: u32, class: u32) {
        let array = self.pointees.get(&pointer).and_then(|pointee| self.arrays.get(pointee));
        let Some((element, is_unsized)) = array.copied() else { return };
        let is_structure = self.structures.contains(&element);
        let kind = match class {
            UNIFORM_CONSTANT if self.storage_images.contains(&element) => ArrayKind::StorageImage,
            UNIFORM_CONSTANT => ArrayKind::SampledImage,
            UNIFORM if is_structure => {
                self.uniform_structures.insert(element);
                ArrayKind::UniformBuffer
            }
            STORAGE_BUFFER if is_structure => ArrayKind::StorageBuffer,
            _ => return,
        };
        self.kinds.insert(kind);
        self.unsized_arrays |= is_unsized;
    }
}

/// The module with the capabilities that its arrays of descriptors need.
pub fn with_capabilities(words: &[u32]) -> Vec<u32> {
    let declared = Declared::of(words);
    if declared.kinds.is_empty() {
        return words.to_vec();
    }
    let mut out = words.get(..HEADER_WORDS).unwrap_or_default().to_vec();
    let capability = |out: &mut Vec<u32>, number: u32| {
        out.extend([first_word(op::CAPABILITY, 2), number]);
    };
    for kind in &declared.kinds {
        let number = if declared.non_uniform { kind.non_uniform() } else { kind.dynamic() };
        capability(&mut out, number);
    }
    if declared.unsized_arrays {
        capability(&mut out, RUNTIME_ARRAY);
    }
    let needs_extension = declared.unsized_arrays || declared.non_uniform;
    let (mut extended, mut decorated) = (!needs_extension, false);
    for SpirvInstruction { op, words } in instructions(words) {
        if op != op::CAPABILITY && !extended {
            extended = true;
            out.extend(extension(EXTENSION));
        }
        if is_type(op) && !decorated {
            decorated = true;
            for id in declared.uniform_structures.difference(&declared.blocks) {
                out.extend([first_word(op::DECORATE, 3), *id, BLOCK]);
            }
        }
        let is_known = op == op::EXTENSION && words == extension(EXTENSION) && needs_extension;
        if !is_known {
            out.extend_from_slice(words);
        }
    }
    out
}

/// Whether an instruction declares a type, which no decoration may follow.
fn is_type(op: u16) -> bool {
    (19..=39).contains(&op)
}

/// `OpExtension`.
pub fn extension(name: &str) -> Vec<u32> {
    let mut bytes = name.as_bytes().to_vec();
    bytes.resize(name.len() / 4 * 4 + 4, 0);
    let text = super::spirv::words(&bytes);
    let mut words = vec![first_word(op::EXTENSION, text.len() + 1)];
    words.extend(text);
    words
}
