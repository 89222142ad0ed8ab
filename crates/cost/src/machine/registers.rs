//! Which registers an instruction writes.

use super::text::Instruction;

/// Registers in a row, such as `s[4:7]`, `v1`, `vcc` or `exec_lo`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Registers {
    file: File,
    first: u32,
    last: u32,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum File {
    Scalar,
    Vector,
    Vcc,
    Exec,
    /// Registers of traps, and the one of local memory.
    Other,
}

impl Registers {
    /// The mask of active threads, in waves of so many threads.
    pub fn exec(wave: u32) -> Self {
        Self { file: File::Exec, first: 0, last: u32::from(wave > 32) }
    }

    /// Reads an operand. Nothing where it names no registers.
    pub fn parse(operand: &str) -> Option<Self> {
        let named = |file, first, last| Some(Self { file, first, last });
        match operand {
            "vcc" => return named(File::Vcc, 0, 1),
            "vcc_lo" => return named(File::Vcc, 0, 0),
            "vcc_hi" => return named(File::Vcc, 1, 1),
            "exec" => return named(File::Exec, 0, 1),
            "exec_lo" => return named(File::Exec, 0, 0),
            "exec_hi" => return named(File::Exec, 1, 1),
            "m0" => return named(File::Other, u32::MAX, u32::MAX),
            _ => {}
        }
        let (file, rest) = [("ttmp", File::Other), ("s", File::Scalar), ("v", File::Vector)]
            .into_iter()
            .find_map(|(start, file)| Some((file, operand.strip_prefix(start)?)))?;
        let range = rest.strip_prefix('[').and_then(|rest| rest.strip_suffix(']'));
        let (first, last) = match range {
            Some(range) => range.split_once(':').unwrap_or((range, range)),
            None => (rest, rest),
        };
        named(file, first.parse().ok()?, last.parse().ok()?)
    }

    pub fn overlap(self, other: Self) -> bool {
        self.file == other.file && self.first <= other.last && other.first <= self.last
    }

    /// Whether each thread has its own value, which only active threads write.
    pub fn is_vector(self) -> bool {
        self.file == File::Vector
    }

    fn is_scalar(self) -> bool {
        matches!(self.file, File::Scalar | File::Vcc | File::Exec)
    }
}

/// Instructions that write none of their operands, by the beginning of the name.
const WRITE_NOTHING: &[&str] = &[
    "s_cmp",
    "s_bitcmp",
    "s_cbranch",
    "s_branch",
    "s_waitcnt",
    "s_nop",
    "exp",
    "buffer_store",
    "ds_write",
    "ds_store",
    "image_store",
    "global_store",
    "s_setreg",
    "s_sendmsg",
    "scratch_store",
    "tbuffer_store",
    "s_clause",
    "s_setprio",
    "s_endpgm",
];

/// Instructions whose second operand, if it is scalar, takes a carry, by the beginning of the name.
const WRITE_CARRY: &[&str] = &["v_div_scale", "v_mad_u64_u32", "v_mad_i64_i32"];

/// Sums that have a carry on GCN where they have four operands.
const SUMS: &[&str] = &["v_add_u32", "v_sub_u32", "v_subrev_u32", "v_addc_u32", "v_subb_u32"];

/// The registers that an instruction writes, in waves of so many threads.
pub fn written_registers(instruction: &Instruction, wave: u32) -> Vec<Registers> {
    let name = instruction.name.as_str();
    if WRITE_NOTHING.iter().any(|start| name.starts_with(start)) {
        return Vec::new();
    }
    let is_mask_compare = name.starts_with("v_cmpx_");
    // On RDNA, a comparison that sets the active threads has no register for its result.
    let count = match instruction.operands.len() {
        2 if is_mask_compare => 0,
        _ if name.starts_with("v_swap") || has_carry(instruction) => 2,
        _ => 1,
    };
    let operands = instruction.operands.iter().map(String::as_str);
    let mut written: Vec<Registers> =
        operands.clone().take(count).filter_map(Registers::parse).collect();
    // The second half of a dual instruction: `v1 :: v_dual_mov_b32 v2`.
    let second = operands.filter_map(|operand| operand.split_once("::"));
    let second = second.filter_map(|(_, second)| second.rsplit_once(' '));
    written.extend(second.filter_map(|(_, register)| Registers::parse(register)));
    if is_mask_compare || name.contains("saveexec") || name.contains("wrexec") {
        written.push(Registers::exec(wave));
    }
    written
}

/// Whether the second operand takes a carry.
fn has_carry(instruction: &Instruction) -> bool {
    let name = instruction.name.as_str();
    let is_scalar = Registers::parse(instruction.operand(1)).is_some_and(Registers::is_scalar);
    let has_one = name.contains("_co_")
        || WRITE_CARRY.iter().any(|start| name.starts_with(start))
        || instruction.operands.len() > 3 && SUMS.iter().any(|start| name.starts_with(start));
    is_scalar && has_one
}
