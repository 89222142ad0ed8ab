//! Turns private variables into specialisation constants, in the words of SPIR-V.
//!
//! A variable is found by its debug name. `OpVariable` becomes `OpSpecConstant` under the same
//! id, every `OpLoad` of it an `OpCopyObject`, and a `SpecId` joins the decorations.

use std::collections::BTreeMap;

use naga::ScalarKind;

use super::{Open, choice};
use crate::bundle::Choice;
use crate::emit::spirv::{self, HEADER_WORDS, instructions};

const OP_NAME: u32 = 5;
const OP_TYPE_POINTER: u32 = 32;
const OP_SPEC_CONSTANT_TRUE: u32 = 48;
const OP_SPEC_CONSTANT_FALSE: u32 = 49;
const OP_SPEC_CONSTANT: u32 = 50;
const OP_VARIABLE: u32 = 59;
const OP_LOAD: u32 = 61;
const OP_DECORATE: u32 = 71;
const OP_COPY_OBJECT: u32 = 83;
/// Opcodes of types and constants, which follow all decorations.
const OP_TYPES: std::ops::RangeInclusive<u32> = 19..=39;
const SPEC_ID: u32 = 1;

/// Opens the variables of overrides; returns how each is chosen.
pub fn open(bytes: &mut Vec<u8>, opens: &[Open]) -> Result<Vec<Choice>, String> {
    let words = spirv::words(bytes);
    let variables = variables(&words, opens)?;
    let mut out = words.get(..HEADER_WORDS).ok_or("the module is too short")?.to_vec();
    let mut pointees = BTreeMap::new();
    let mut decorated = false;
    for instruction in instructions(&words) {
        let operation = instruction[0] & 0xffff;
        if !decorated && OP_TYPES.contains(&operation) {
            variables.iter().for_each(|(id, open)| {
                out.extend([operator(OP_DECORATE, 4), *id, SPEC_ID, open.id])
            });
            decorated = true;
        }
        match (operation, instruction) {
            (OP_TYPE_POINTER, [_, pointer, _, pointee]) => {
                pointees.insert(*pointer, *pointee);
            }
            (OP_VARIABLE, [_, pointer, id, ..]) if variables.contains_key(id) => {
                let ty = *pointees.get(pointer).ok_or("a pointer has no type")?;
                constant(&mut out, ty, *id, variables[id]);
                continue;
            }
            (OP_LOAD, [_, ty, result, id, ..]) if variables.contains_key(id) => {
                out.extend([operator(OP_COPY_OBJECT, 4), *ty, *result, *id]);
                continue;
            }
            _ => {}
        }
        out.extend_from_slice(instruction);
    }
    *bytes = out.iter().flat_map(|word| word.to_le_bytes()).collect();
    let written =
        opens.iter().filter(|open| variables.values().any(|found| found.name == open.name));
    Ok(written.map(|open| choice(open, true)).collect())
}

fn constant(out: &mut Vec<u32>, ty: u32, id: u32, open: &Open) {
    match (open.kind, open.bits) {
        (ScalarKind::Bool, 0) => out.extend([operator(OP_SPEC_CONSTANT_FALSE, 3), ty, id]),
        (ScalarKind::Bool, _) => out.extend([operator(OP_SPEC_CONSTANT_TRUE, 3), ty, id]),
        (_, bits) => out.extend([operator(OP_SPEC_CONSTANT, 4), ty, id, bits]),
    }
}

/// The overrides, by the id of their variable.
fn variables<'a>(words: &[u32], opens: &'a [Open]) -> Result<BTreeMap<u32, &'a Open>, String> {
    let mut variables = BTreeMap::new();
    for instruction in instructions(words) {
        if let [operation, id, name @ ..] = instruction
            && operation & 0xffff == OP_NAME
        {
            let name: Vec<u8> = name
                .iter()
                .flat_map(|word| word.to_le_bytes())
                .take_while(|byte| *byte != 0)
                .collect();
            let found = opens.iter().find(|open| open.variable.as_bytes() == name);
            if let Some(open) = found
                && variables.insert(*id, open).is_some()
            {
                return Err(format!("`{}` is named twice", open.variable));
            }
        }
    }
    Ok(variables)
}

fn operator(operation: u32, words: u32) -> u32 {
    words << 16 | operation
}
