//! Counts of the instructions of SPIR-V, over modules whose words are written here by the numbers of
//! its specification.

use lamplight_cost::counts::{Counts, KINDS};
use libtest_mimic::{Failed, Trial};

type Outcome = Result<(), Failed>;

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("counts::kinds_of_instructions", kinds_of_instructions),
        Trial::test("counts::declarations_do_not_count", declarations_do_not_count),
        Trial::test("counts::differences", differences),
    ]
}

/// The words of a module: its header, and for each instruction its opcode and its operands. The
/// values of the operands do not matter.
fn module(instructions: &[(u32, usize)]) -> Vec<u32> {
    let mut words = vec![0x0723_0203, 0x0001_0000, 0, 100, 0];
    for (opcode, operands) in instructions {
        words.push((*operands as u32 + 1) << 16 | opcode);
        words.extend(std::iter::repeat_n(1, *operands));
    }
    words
}

fn count_of(counts: &Counts, key: &str) -> Result<i64, Failed> {
    let place = KINDS.iter().position(|kind| kind.key == key).ok_or("no such kind")?;
    Ok(counts.0[place])
}

const FUNCTION: (u32, usize) = (54, 4);
const FUNCTION_END: (u32, usize) = (56, 0);
const LABEL: (u32, usize) = (248, 1);
const RETURN: (u32, usize) = (253, 0);

fn kinds_of_instructions() -> Outcome {
    let counts = Counts::of(&module(&[
        FUNCTION,
        LABEL,
        (61, 3),  // OpLoad
        (129, 4), // OpFAdd
        (133, 4), // OpFMul
        (12, 5),  // OpExtInst
        (184, 4), // OpFOrdLessThan
        (169, 5), // OpSelect
        (87, 4),  // OpImageSampleImplicitLod
        (207, 3), // OpDPdx
        (124, 3), // OpBitcast
        (80, 4),  // OpCompositeConstruct
        (62, 2),  // OpStore
        RETURN,
        FUNCTION_END,
    ]));
    let wanted = [
        ("arithmetic", 2),
        ("functions", 1),
        ("logic", 2),
        ("bits", 0),
        ("conversions", 1),
        ("composites", 1),
        ("memory", 2),
        ("textures", 1),
        ("derivatives", 1),
        ("control", 1),
        ("other", 0),
    ];
    for (key, wanted) in wanted {
        let found = count_of(&counts, key)?;
        if found != wanted {
            return Err(format!("{found} instructions of the kind {key}, expected {wanted}").into());
        }
    }
    match (counts.total(), wanted.len() == KINDS.len()) {
        (12, true) => Ok(()),
        (total, _) => Err(format!("{total} instructions of {} kinds", KINDS.len()).into()),
    }
}

/// What is outside of functions does not count, nor do labels, merges, variables, parameters and
/// lines.
fn declarations_do_not_count() -> Outcome {
    let counts = Counts::of(&module(&[
        (17, 1), // OpCapability
        (43, 3), // OpConstant
        (59, 3), // OpVariable
        FUNCTION,
        (55, 2), // OpFunctionParameter
        LABEL,
        (59, 3),  // OpVariable
        (8, 3),   // OpLine
        (247, 2), // OpSelectionMerge
        LABEL,
        FUNCTION_END,
        (129, 4), // OpFAdd, outside of any function
    ]));
    match counts.total() {
        0 => Ok(()),
        total => Err(format!("{total} instructions counted, expected none").into()),
    }
}

fn differences() -> Outcome {
    let one = Counts::of(&module(&[FUNCTION, LABEL, (129, 4), (129, 4), RETURN, FUNCTION_END]));
    let other = Counts::of(&module(&[FUNCTION, LABEL, (129, 4), (62, 2), RETURN, FUNCTION_END]));
    let less = one.less(&other);
    match (count_of(&less, "arithmetic")?, count_of(&less, "memory")?, less.total()) {
        (1, -1, 0) => Ok(()),
        found => Err(format!("arithmetic, memory, all: {found:?}, expected (1, -1, 0)").into()),
    }
}
