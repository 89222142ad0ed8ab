//! Counts the instructions of SPIR-V by kind, after `spirv-opt -O`. This needs no driver.
//!
//! Each instruction counts once, even within a loop. What is only structure or declaration is not
//! counted: labels, merges, variables, parameters, line numbers.

use std::ops::RangeInclusive;

use serde::Serialize;
use serde::ser::{SerializeMap, Serializer};

use super::pipeline::SpirvStage;
use super::stages::settled_words;
use lamplight_emit::spirv::{self, op};
use lamplight_tools::SPIRV_OPT;

/// A kind of instruction: its key in JSON, its heading in a table, its opcodes.
pub struct InstructionKind {
    pub key: &'static str,
    pub heading: &'static str,
    opcodes: &'static [RangeInclusive<u16>],
}

const fn make_kind(
    key: &'static str,
    heading: &'static str,
    opcodes: &'static [RangeInclusive<u16>],
) -> InstructionKind {
    InstructionKind { key, heading, opcodes }
}

/// Every kind, in the order of tables. The numbers are those of the specification of SPIR-V,
/// section 3.42. An instruction that no other kind has is in the last one.
pub const KINDS: &[InstructionKind] = &[
    // SNegate to SMulExtended: sums, products, quotients, also of vectors and matrices.
    make_kind("arithmetic", "arith", &[126..=152]),
    // ExtInst: functions of GLSL.std.450, such as `sqrt`, `pow`, `clamp`.
    make_kind("functions", "funcs", &[12..=12]),
    // Any to FUnordGreaterThanEqual: comparisons and Select.
    make_kind("logic", "logic", &[154..=191]),
    // Shifts to BitCount.
    make_kind("bits", "bits", &[194..=205]),
    // ConvertFToU to Bitcast.
    make_kind("conversions", "conv", &[109..=124]),
    // VectorExtractDynamic to Transpose: building vectors and taking them apart.
    make_kind("composites", "compos", &[77..=84]),
    // Load to InBoundsPtrAccessChain, barriers, atomics.
    make_kind("memory", "memory", &[61..=70, 224..=225, 227..=242]),
    // ImageTexelPointer, SampledImage to ImageQuerySamples.
    make_kind("textures", "tex", &[60..=60, 86..=107]),
    // DPdx to FwidthCoarse.
    make_kind("derivatives", "deriv", &[207..=215]),
    // FunctionCall, Phi, Branch to ReturnValue, TerminateInvocation, DemoteToHelperInvocation.
    make_kind("control", "control", &[57..=57, 245..=245, 249..=254, 4416..=4416, 5380..=5380]),
    make_kind("other", "other", &[]),
];

/// Structure and declarations: Nop, Undef, Line, FunctionParameter, Variable, merges, Label,
/// Unreachable, NoLine.
const UNCOUNTED: &[RangeInclusive<u16>] =
    &[0..=1, 8..=8, 55..=55, 59..=59, 246..=248, 255..=255, 317..=317];

/// How many instructions of each of the [`KINDS`] there are, or the difference of two counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Counts(pub [i64; KINDS.len()]);

impl Counts {
    /// Instructions in the functions of a module.
    pub fn of(module: &[u32]) -> Self {
        let mut counts = [0; KINDS.len()];
        let mut in_function = false;
        for instruction in spirv::instructions(module) {
            match instruction.op {
                op::FUNCTION => in_function = true,
                op::FUNCTION_END => in_function = false,
                opcode if in_function && !is_among(UNCOUNTED, opcode) => {
                    let kind = KINDS.iter().position(|kind| is_among(kind.opcodes, opcode));
                    counts[kind.unwrap_or(KINDS.len() - 1)] += 1;
                }
                _ => {}
            }
        }
        Self(counts)
    }

    pub fn total(&self) -> i64 {
        self.0.iter().sum()
    }

    /// Each count less that of another stage.
    pub fn less(&self, other: &Self) -> Self {
        let mut difference = *self;
        for (count, other) in difference.0.iter_mut().zip(other.0) {
            *count -= other;
        }
        difference
    }
}

fn is_among(ranges: &[RangeInclusive<u16>], opcode: u16) -> bool {
    ranges.iter().any(|range| range.contains(&opcode))
}

impl Serialize for Counts {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(KINDS.len() + 1))?;
        map.serialize_entry("total", &self.total())?;
        for (kind, count) in KINDS.iter().zip(self.0) {
            map.serialize_entry(kind.key, &count)?;
        }
        map.end()
    }
}

/// Optimises a stage with its specialisation constants settled, and counts its instructions.
///
/// # Errors
/// What `spirv-opt` says where it refuses the stage, or that it is not installed.
pub fn count_optimised(stage: &SpirvStage) -> Result<Counts, String> {
    let arguments = ["--freeze-spec-const", "-O", "-", "-o", "-"];
    let optimised = SPIRV_OPT.pipe(&arguments, &spirv::bytes(&settled_words(stage)))?;
    Ok(Counts::of(&spirv::words(&optimised)))
}
