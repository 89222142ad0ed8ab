//! The extension that SPIR-V 1.0 needs for numbers of 16 bits in buffers and between stages. naga
//! writes the capabilities, and the extension only sometimes.

use super::descriptors::extension;
use super::spirv::{HEADER_WORDS, SpirvInstruction, instructions, op};

const EXTENSION: &str = "SPV_KHR_16bit_storage";

/// `StorageBuffer16BitAccess` to `StorageInputOutput16`.
const CAPABILITIES: std::ops::RangeInclusive<u32> = 4433..=4436;

/// The module with the extension, if one of its capabilities needs it.
pub fn with_extension(words: Vec<u32>) -> Vec<u32> {
    let own = extension(EXTENSION);
    let has = |one: SpirvInstruction<'_>| one.op == op::EXTENSION && one.words == own;
    let needs = |one: SpirvInstruction<'_>| match (one.op, one.words) {
        (op::CAPABILITY, [_, number]) => CAPABILITIES.contains(number),
        _ => false,
    };
    if !instructions(&words).any(needs) || instructions(&words).any(has) {
        return words;
    }
    let is_capability = |one: &SpirvInstruction<'_>| one.op == op::CAPABILITY;
    let capabilities = instructions(&words).take_while(is_capability);
    let at = HEADER_WORDS + capabilities.map(|one| one.words.len()).sum::<usize>();
    let mut changed = words;
    changed.splice(at..at, own);
    changed
}
