//! Which unit executes an instruction, and for how many cycles.

use std::collections::{BTreeSet, HashMap};

use super::text::{Block, Instruction};
use super::{Counting, MachineError};

/// A unit of the GPU, or a sum of units.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// The cycles of all vector instructions, if none overlap: the sum of `Vector` and
    /// `Transcendental`.
    Cycles,
    /// The cycles in which vector instructions issue. On RDNA a transcendental one issues in one, and
    /// its unit works while others issue.
    Issue,
    /// Vector instructions except the transcendental ones.
    Vector,
    /// Roots, reciprocals, powers, logarithms, sines, at a quarter of the full rate.
    Transcendental,
    /// Scalar instructions, with branches.
    Scalar,
    /// Reads of textures and images, and writes of images.
    Texture,
    /// Reads and writes of buffers and of scratch memory by vector instructions.
    Memory,
    /// Reads of buffers and descriptors by scalar instructions.
    ScalarMemory,
    /// Local memory, and the parameters of fragments that lie in it.
    Local,
    /// Outputs of a stage.
    Export,
}

/// Every unit, in the order of [`Weights`].
pub const UNITS: [Unit; 10] = [
    Unit::Cycles,
    Unit::Issue,
    Unit::Vector,
    Unit::Transcendental,
    Unit::Scalar,
    Unit::Texture,
    Unit::Memory,
    Unit::ScalarMemory,
    Unit::Local,
    Unit::Export,
];

/// A number for each of the [`UNITS`].
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Weights(pub [i64; UNITS.len()]);

impl Weights {
    pub fn of(&self, unit: Unit) -> i64 {
        self.0[unit as usize]
    }

    pub(super) fn with(self, other: Self, combine: impl Fn(i64, i64) -> i64) -> Self {
        Self(std::array::from_fn(|index| combine(self.0[index], other.0[index])))
    }

    /// All cycles, one after the other.
    pub(super) fn total(self) -> i64 {
        let parts = [Unit::Vector, Unit::Transcendental, Unit::Issue];
        let units = UNITS.into_iter().filter(|unit| !parts.contains(unit));
        units.fold(0, |sum, unit| sum.saturating_add(self.of(unit)))
    }

    pub(super) fn plus(self, other: Self) -> Self {
        self.with(other, i64::saturating_add)
    }

    pub(super) fn times(self, count: u64) -> Self {
        let count = i64::try_from(count).unwrap_or(i64::MAX);
        Self(self.0.map(|weight| weight.saturating_mul(count)))
    }
}

/// Rates that differ between generations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Rates {
    /// Cycles of a conversion between types: 4 on GCN, 1 on RDNA.
    pub conversion: i64,
    /// Cycles of a fused multiplication and addition: 4 on the small chips of GCN.
    pub fused: i64,
    /// Cycles in which a transcendental instruction keeps others from issuing: 4 on GCN, 1 on RDNA.
    pub transcendental_issue: i64,
    /// Cycles of a sum in double precision: 8 on GCN, 16 on RDNA.
    pub double_sum: i64,
    /// Cycles of a conversion to or from double precision: 4 on GCN, 16 on RDNA.
    pub double_conversion: i64,
}

impl Rates {
    /// GCN converts at a quarter of the rate; its small chips have no fast fused instructions.
    pub const GCN: Self = Self {
        conversion: 4,
        fused: 4,
        transcendental_issue: 4,
        double_sum: 8,
        double_conversion: 4,
    };
    pub const GCN_5: Self = Self { fused: 1, ..Self::GCN };
    pub const RDNA: Self = Self {
        conversion: 1,
        fused: 1,
        transcendental_issue: 1,
        double_sum: 16,
        double_conversion: 16,
    };
}

/// What a kind of instruction does with a unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// A vector instruction of so many cycles.
    Vector(i64),
    Conversion,
    Fused,
    Transcendental,
    DoubleTranscendental,
    DoubleSum,
    DoubleConversion,
    /// One instruction of a unit.
    One(Unit),
    /// Nothing but waiting, hints and the end.
    Idle,
}

/// Kinds by the beginning of the name. The longest one that fits counts.
///
/// The rates are those of AMD's manuals of the instruction sets, section "VALU", and of
/// `get_perf_info` in `src/amd/compiler/aco_statistics.cpp` of Mesa 22.3, whose numbers are clock
/// cycles: on GCN four, for waves of 64 threads, on RDNA one, for waves of 32.
const KINDS: &[(&[&str], Kind)] = &[
    (
        &["s_waitcnt", "s_wait_", "s_nop", "s_endpgm", "s_code_end", "s_clause", "s_sleep"],
        Kind::Idle,
    ),
    (
        &["s_inst_prefetch", "s_set_inst_prefetch", "s_delay_alu", "s_setprio", "s_barrier"],
        Kind::Idle,
    ),
    (&["s_load_", "s_buffer_load_", "s_memtime", "s_memrealtime", "s_dcache_"], SCALAR_MEMORY),
    (&["s_scratch_load", "s_scratch_store", "s_store_", "s_buffer_store_"], SCALAR_MEMORY),
    (SCALAR_NAMES, Kind::One(Unit::Scalar)),
    (&["image_"], Kind::One(Unit::Texture)),
    (&["buffer_", "tbuffer_", "global_", "flat_", "scratch_"], Kind::One(Unit::Memory)),
    (&["ds_", "lds_param_load", "lds_direct_load"], Kind::One(Unit::Local)),
    (&["exp"], Kind::One(Unit::Export)),
    (VECTOR_NAMES, Kind::Vector(1)),
    // Conversions at full rate: between 16 and 32 bits packed, and to normalised integers.
    (&["v_cvt_pk", "v_cvt_pkrtz"], Kind::Vector(1)),
    (&["v_cvt_"], Kind::Conversion),
    (&["v_fma_f32", "v_fmac_f32", "v_fmamk_f32", "v_fmaak_f32"], Kind::Fused),
    (&["v_rcp_", "v_rsq_", "v_sqrt_", "v_exp_", "v_log_"], Kind::Transcendental),
    (&["v_sin_", "v_cos_"], Kind::Transcendental),
    (&["v_rcp_f64", "v_rsq_f64", "v_sqrt_f64"], Kind::DoubleTranscendental),
    // A quarter of the rate.
    (&["v_mul_lo_u32", "v_mul_lo_i32", "v_mul_hi_u32", "v_mul_hi_i32"], Kind::Vector(4)),
    // But not of factors of 24 bits.
    (&["v_mul_hi_u32_u24", "v_mul_hi_i32_i24"], Kind::Vector(1)),
    (&["v_mad_u64_u32", "v_mad_i64_i32"], Kind::Vector(4)),
    // Half of the rate.
    (&["v_lshlrev_b64", "v_lshrrev_b64", "v_ashrrev_i64"], Kind::Vector(2)),
    (&["v_lshl_b64", "v_lshr_b64", "v_ashr_i64"], Kind::Vector(2)),
    // Double precision, as on the cards for games.
    (&["v_add_f64"], Kind::DoubleSum),
    (&["v_mul_f64", "v_fma_f64", "v_min_f64", "v_max_f64"], Kind::Vector(16)),
    (&["v_ldexp_f64", "v_fract_f64", "v_trunc_f64", "v_floor_f64"], Kind::Vector(16)),
    (&["v_ceil_f64", "v_rndne_f64", "v_div_fixup_f64", "v_div_fmas_f64"], Kind::Vector(16)),
    (&["v_div_scale_f64", "v_frexp_mant_f64", "v_frexp_exp_i32_f64"], Kind::Vector(16)),
    (&["v_cvt_f64_", "v_cvt_f32_f64", "v_cvt_i32_f64", "v_cvt_u32_f64"], Kind::DoubleConversion),
];

const SCALAR_MEMORY: Kind = Kind::One(Unit::ScalarMemory);

/// Scalar instructions.
const SCALAR_NAMES: &[&str] = &[
    "s_mov",
    "s_cmov",
    "s_add",
    "s_sub",
    "s_mul",
    "s_min",
    "s_max",
    "s_and",
    "s_or",
    "s_xor",
    "s_nand",
    "s_nor",
    "s_xnor",
    "s_andn",
    "s_orn",
    "s_not",
    "s_lshl",
    "s_lshr",
    "s_ashr",
    "s_bfe",
    "s_bfm",
    "s_abs",
    "s_bitcmp",
    "s_bitset",
    "s_bitreplicate",
    "s_cmp",
    "s_cselect",
    "s_wqm",
    "s_brev",
    "s_bcnt",
    "s_ff0",
    "s_ff1",
    "s_flbit",
    "s_sext",
    "s_quadmask",
    "s_pack",
    "s_getpc",
    "s_setreg",
    "s_getreg",
    "s_sendmsg",
    "s_branch",
    "s_cbranch",
    "s_version",
    "s_round_mode",
    "s_denorm_mode",
    "s_ctz",
    "s_clz",
    "s_cls",
];

/// Vector instructions at full rate. Of a packed one, two halves of a register are one issue; of a
/// dual one, two instructions are.
const VECTOR_NAMES: &[&str] = &[
    "v_nop",
    "v_mov",
    "v_swap",
    "v_add",
    "v_sub",
    "v_mul",
    "v_mac",
    "v_mad",
    "v_fma",
    "v_fmac",
    "v_min",
    "v_max",
    "v_med3",
    "v_and",
    "v_or",
    "v_xor",
    "v_xnor",
    "v_not",
    "v_lshl",
    "v_lshr",
    "v_ashr",
    "v_bfe",
    "v_bfi",
    "v_bfm",
    "v_bfrev",
    "v_bcnt",
    "v_ffbh",
    "v_ffbl",
    "v_perm",
    "v_alignbit",
    "v_alignbyte",
    "v_cndmask",
    "v_cmp",
    "v_cmpx",
    "v_interp",
    "v_fract",
    "v_trunc",
    "v_ceil",
    "v_floor",
    "v_rndne",
    "v_ldexp",
    "v_frexp",
    "v_div_scale",
    "v_div_fmas",
    "v_div_fixup",
    "v_cube",
    "v_mbcnt",
    "v_readlane",
    "v_readfirstlane",
    "v_writelane",
    "v_permlane",
    "v_dot",
    "v_pk_",
    "v_pack",
    "v_sad",
    "v_msad",
    "v_xad",
    "v_lerp",
    "v_dual_",
    "v_ctz",
    "v_clz",
    "v_cls",
    "v_minmax",
    "v_maxmin",
    "v_legacy",
];

/// Instructions that begin as one at full rate does and are none. Without this list they would be
/// counted as one.
const NOT_AT_FULL_RATE: &[&str] = &["_f64", "_i64", "_u64", "_b64"];

/// The kind of an instruction; `None` where it is not known.
fn kind_of(name: &str) -> Option<Kind> {
    let fits = KINDS.iter().flat_map(|(names, kind)| names.iter().map(move |name| (*name, *kind)));
    let best =
        fits.filter(|(start, _)| name.starts_with(start)).max_by_key(|(start, _)| start.len());
    let (start, kind) = best?;
    let is_wide = NOT_AT_FULL_RATE.iter().any(|part| name.contains(part));
    let is_plain = VECTOR_NAMES.contains(&start) && !name.starts_with("v_cmp");
    match is_plain && is_wide {
        true => None,
        false => Some(kind),
    }
}

/// The cycles of an instruction, for the waves of 64 threads.
fn weigh_instruction(kind: Kind, times: i64, counting: Counting<'_>) -> Weights {
    let Counting { rates, wave, .. } = counting;
    let mut weights = Weights::default();
    let mut add = |unit: Unit, cycles: i64| weights.0[unit as usize] += cycles;
    let mut vector = |unit: Unit, cycles: i64, issue: i64| {
        add(Unit::Cycles, cycles);
        add(Unit::Issue, issue);
        add(unit, cycles);
    };
    let mut plain = |cycles: i64| vector(Unit::Vector, cycles, cycles);
    match kind {
        Kind::Vector(cycles) => plain(cycles),
        Kind::Conversion => plain(rates.conversion),
        Kind::Fused => plain(rates.fused),
        Kind::DoubleSum => plain(rates.double_sum),
        Kind::DoubleConversion => plain(rates.double_conversion),
        Kind::Transcendental => vector(Unit::Transcendental, 4, rates.transcendental_issue),
        Kind::DoubleTranscendental => vector(Unit::Transcendental, 16, 16),
        Kind::One(unit) => add(unit, waves_of(unit, wave)),
        Kind::Idle => {}
    }
    weights.times(times.unsigned_abs())
}

/// How often a unit takes an instruction for 64 threads. Waves of 32 threads are twice as many: what a
/// unit does once for a wave it does twice, but what it does for each thread takes half the time.
fn waves_of(unit: Unit, wave: u32) -> i64 {
    let is_of_waves = matches!(unit, Unit::Scalar | Unit::ScalarMemory | Unit::Export);
    if is_of_waves { i64::from(64 / wave.clamp(1, 64)) } else { 1 }
}

/// The cycles of each block.
pub fn weigh_blocks<'b>(
    blocks: &'b [Block],
    counting: Counting<'_>,
) -> Result<Vec<Weights>, MachineError> {
    // A stage has thousands of instructions of some dozen names.
    let mut kinds: HashMap<&str, Option<Kind>> = HashMap::new();
    let mut unknown = BTreeSet::new();
    let mut one = |block: &'b Block| {
        let mut sum = Weights::default();
        for Instruction { name, times, .. } in &block.instructions {
            match *kinds.entry(name).or_insert_with(|| kind_of(name)) {
                Some(kind) => sum = sum.plus(weigh_instruction(kind, *times, counting)),
                None => {
                    unknown.insert(name.clone());
                }
            }
        }
        sum
    };
    let weights = blocks.iter().map(&mut one).collect();
    match unknown.is_empty() {
        true => Ok(weights),
        false => Err(MachineError::UnknownInstructions(unknown.into_iter().collect())),
    }
}
