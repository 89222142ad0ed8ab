//! Turns private variables into specialisation constants, in the words of SPIR-V.
//!
//! A variable is found by its debug name. `OpVariable` becomes `OpSpecConstant` under the same
//! id, every `OpLoad` of it an `OpCopyObject`, and a `SpecId` joins the decorations.

use std::collections::BTreeMap;

use naga::ScalarKind;

use super::{OpenOverride, choice_of};
use crate::spirv::{self, HEADER_WORDS, SpirvInstruction, first_word, instructions, op, string};
use lamplight_bundle::OverrideChoice;

/// Opcodes of types. The first type follows all decorations.
const TYPES: std::ops::RangeInclusive<u16> = 19..=39;
const SPEC_ID: u32 = 1;

/// Opens the variables of overrides; returns how each is chosen.
pub fn open_words(
    bytes: &mut Vec<u8>,
    opens: &[OpenOverride],
) -> Result<Vec<OverrideChoice>, String> {
    let words = spirv::words(bytes);
    let variables = open_variables(&words, opens)?;
    let mut out = words.get(..HEADER_WORDS).ok_or("the module is too short")?.to_vec();
    let mut pointees = BTreeMap::new();
    let mut decorated = false;
    for SpirvInstruction { op, words } in instructions(&words) {
        if !decorated && TYPES.contains(&op) {
            variables.iter().for_each(|(id, open)| {
                out.extend([first_word(op::DECORATE, 4), *id, SPEC_ID, open.id])
            });
            decorated = true;
        }
        match (op, words) {
            (op::TYPE_POINTER, [_, pointer, _, pointee]) => {
                pointees.insert(*pointer, *pointee);
            }
            (op::VARIABLE, [_, pointer, id, ..]) if variables.contains_key(id) => {
                let ty = *pointees.get(pointer).ok_or("a pointer has no type")?;
                write_constant(&mut out, ty, *id, variables[id]);
                continue;
            }
            (op::LOAD, [_, ty, result, id, ..]) if variables.contains_key(id) => {
                out.extend([first_word(op::COPY_OBJECT, 4), *ty, *result, *id]);
                continue;
            }
            _ => {}
        }
        out.extend_from_slice(words);
    }
    *bytes = spirv::bytes(&out);
    let written =
        opens.iter().filter(|open| variables.values().any(|found| found.name == open.name));
    Ok(written.map(|open| choice_of(open, true)).collect())
}

fn write_constant(out: &mut Vec<u32>, ty: u32, id: u32, open: &OpenOverride) {
    match (open.kind, open.bits) {
        (ScalarKind::Bool, 0) => out.extend([first_word(op::SPEC_CONSTANT_FALSE, 3), ty, id]),
        (ScalarKind::Bool, _) => out.extend([first_word(op::SPEC_CONSTANT_TRUE, 3), ty, id]),
        (_, bits) => out.extend([first_word(op::SPEC_CONSTANT, 4), ty, id, bits]),
    }
}

/// The overrides, by the id of their variable.
fn open_variables<'a>(
    words: &[u32],
    opens: &'a [OpenOverride],
) -> Result<BTreeMap<u32, &'a OpenOverride>, String> {
    let mut variables = BTreeMap::new();
    for SpirvInstruction { op, words } in instructions(words) {
        if let (op::NAME, [_, id, name @ ..]) = (op, words) {
            let name = string(name);
            let found = opens.iter().find(|open| open.variable == name);
            if let Some(open) = found
                && variables.insert(*id, open).is_some()
            {
                return Err(format!("`{}` is named twice", open.variable));
            }
        }
    }
    Ok(variables)
}
