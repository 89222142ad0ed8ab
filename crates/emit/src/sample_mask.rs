//! What naga writes otherwise than Vulkan wants it: the mask of samples, which is an array there,
//! and the size of a storage texture, which has no levels.

use std::collections::{BTreeMap, BTreeSet};

use super::spirv::{HEADER_WORDS, SpirvInstruction, first_word, instructions, op};

/// Decorations and built-ins.
const BUILT_IN: u32 = 11;
const SAMPLE_MASK: u32 = 20;

/// The operand of an image's type that says whether it is sampled, and its value for storage.
const SAMPLED: usize = 7;
const STORAGE: u32 = 2;

/// What a mask of samples needs.
struct Mask {
    /// The type of one element, and the type of a pointer to it.
    element: u32,
    pointer: u32,
    /// The constant 0.
    zero: u32,
}

/// The module with an array of one element for each mask of samples.
///
/// # Errors
/// Where a pointer has no type.
pub fn as_arrays(words: &[u32]) -> Result<Vec<u32>, String> {
    let masks = mask_variables(words);
    if masks.is_empty() {
        return Ok(words.to_vec());
    }
    let mut out = words.get(..HEADER_WORDS).ok_or("the module is too short")?.to_vec();
    let (mut pointees, mut known) = (BTreeMap::new(), BTreeMap::new());
    let mut next = out[3];
    let mut fresh = || {
        next += 1;
        next - 1
    };
    for SpirvInstruction { op, words } in instructions(words) {
        match (op, words) {
            (op::TYPE_POINTER, [_, pointer, _, pointee]) => {
                pointees.insert(*pointer, *pointee);
            }
            (op::VARIABLE, [_, pointer, id, class, ..]) if masks.contains(id) => {
                let element = *pointees.get(pointer).ok_or("a pointer has no type")?;
                let [zero, one, array, to_array] = [fresh(), fresh(), fresh(), fresh()];
                declare(&mut out, element, [zero, one, array, to_array], [*class, *id]);
                known.insert(*id, Mask { element, pointer: *pointer, zero });
                continue;
            }
            (op::LOAD, [_, _, result, id, ..]) if known.contains_key(id) => {
                let Mask { element, pointer, zero } = known[id];
                let place = fresh();
                out.extend([first_word(op::ACCESS_CHAIN, 5), pointer, place, *id, zero]);
                out.extend([first_word(op::LOAD, 4), element, *result, place]);
                continue;
            }
            (op::STORE, [_, id, value, ..]) if known.contains_key(id) => {
                let Mask { element: _, pointer, zero } = known[id];
                let place = fresh();
                out.extend([first_word(op::ACCESS_CHAIN, 5), pointer, place, *id, zero]);
                out.extend([first_word(op::STORE, 3), place, *value]);
                continue;
            }
            _ => {}
        }
        out.extend_from_slice(words);
    }
    out[3] = next;
    Ok(out)
}

/// The variables that hold a mask of samples.
fn mask_variables(words: &[u32]) -> BTreeSet<u32> {
    let is_mask = |found: SpirvInstruction<'_>| match (found.op, found.words) {
        (op::DECORATE, [_, id, BUILT_IN, SAMPLE_MASK]) => Some(*id),
        _ => None,
    };
    instructions(words).filter_map(is_mask).collect()
}

/// Declares a variable with an array of one element, and what it needs.
fn declare(
    out: &mut Vec<u32>,
    element: u32,
    [zero, one, array, to_array]: [u32; 4],
    [class, id]: [u32; 2],
) {
    out.extend([first_word(op::CONSTANT, 4), element, zero, 0]);
    out.extend([first_word(op::CONSTANT, 4), element, one, 1]);
    out.extend([first_word(op::TYPE_ARRAY, 4), array, element, one]);
    out.extend([first_word(op::TYPE_POINTER, 4), to_array, class, array]);
    out.extend([first_word(op::VARIABLE, 4), to_array, id, class]);
}

/// The module without levels in the questions for the size of storage textures.
pub fn with_storage_queries(words: &[u32]) -> Vec<u32> {
    let mut out = words.get(..HEADER_WORDS).unwrap_or_default().to_vec();
    let (mut storage, mut images) = (BTreeSet::new(), BTreeSet::new());
    for SpirvInstruction { op, words } in instructions(words) {
        match (op, words) {
            (op::TYPE_IMAGE, [_, id, ..]) if words.get(SAMPLED) == Some(&STORAGE) => {
                storage.insert(*id);
            }
            (op::LOAD | op::FUNCTION_PARAMETER, [_, ty, result, ..]) if storage.contains(ty) => {
                images.insert(*result);
            }
            (op::IMAGE_QUERY_SIZE_LOD, [_, ty, result, image, _]) if images.contains(image) => {
                out.extend([first_word(op::IMAGE_QUERY_SIZE, 4), *ty, *result, *image]);
                continue;
            }
            _ => {}
        }
        out.extend_from_slice(words);
    }
    out
}
