//! The figures of the machine code of one stage.

use serde::{Deserialize, Serialize};

use crate::machine::{MachineCost, Unit};

/// Figures of one stage, or the difference of two.
///
/// Cycles are counted in the machine code, see [`crate::machine`]: for each unit on the dearest path,
/// and, in the figures that begin with `least_`, on the cheapest one. The other figures are the
/// compiler's.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Statistics {
    /// Cycles of vector instructions, if none overlap: the sum of `vector` and `transcendental`.
    pub cycles: i64,
    pub least_cycles: i64,
    /// Cycles in which vector instructions issue. No path takes fewer cycles than the larger of
    /// `issue` and `transcendental` there.
    pub issue: i64,
    pub least_issue: i64,
    pub vector: i64,
    pub least_vector: i64,
    pub transcendental: i64,
    pub least_transcendental: i64,
    pub scalar: i64,
    pub least_scalar: i64,
    pub texture: i64,
    pub least_texture: i64,
    pub memory: i64,
    pub least_memory: i64,
    pub scalar_memory: i64,
    pub least_scalar_memory: i64,
    pub local: i64,
    pub least_local: i64,
    pub export: i64,
    pub least_export: i64,
    /// Loops that count once, since nothing says how often they run.
    pub open_loops: i64,
    /// Threads of a wave.
    pub wave: i64,
    /// Vector registers of a thread.
    pub vgprs: i64,
    /// Scalar registers of a wave.
    pub sgprs: i64,
    pub spilled_vgprs: i64,
    pub spilled_sgprs: i64,
    /// Bytes of memory that a thread needs besides its registers.
    pub scratch: i64,
    /// Waves that fit on one SIMD at a time. More waves hide more latency.
    pub subgroups_per_simd: i64,
    /// Instructions of the machine code, each once.
    pub instructions: i64,
    pub branches: i64,
    /// Bytes of machine code.
    pub code_size: i64,
}

/// Where a figure comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// Mesa tells it by this name.
    Mesa(&'static str),
    /// Counted on the dearest path.
    Most(Unit),
    /// Counted on the cheapest path.
    Least(Unit),
    /// About the count itself.
    Count,
}

/// A figure: its key in JSON, its heading where tables show it, where it comes from, and whether
/// more is worse.
pub struct CostFigure {
    pub key: &'static str,
    pub heading: &'static str,
    pub origin: Origin,
    pub more_is_worse: bool,
    field: fn(&mut Statistics) -> &mut i64,
}

macro_rules! figure {
    ($key:ident, $heading:literal, $origin:expr, $more_is_worse:literal) => {
        CostFigure {
            key: stringify!($key),
            heading: $heading,
            origin: $origin,
            more_is_worse: $more_is_worse,
            field: |statistics| &mut statistics.$key,
        }
    };
}

/// Every figure, in the order of tables.
pub const FIGURES: &[CostFigure] = &[
    figure!(cycles, "cycles", Origin::Most(Unit::Cycles), true),
    figure!(least_cycles, "least", Origin::Least(Unit::Cycles), true),
    figure!(issue, "issue", Origin::Most(Unit::Issue), true),
    figure!(least_issue, "", Origin::Least(Unit::Issue), true),
    figure!(vector, "vector", Origin::Most(Unit::Vector), true),
    figure!(least_vector, "", Origin::Least(Unit::Vector), true),
    figure!(transcendental, "trans", Origin::Most(Unit::Transcendental), true),
    figure!(least_transcendental, "", Origin::Least(Unit::Transcendental), true),
    figure!(scalar, "scalar", Origin::Most(Unit::Scalar), true),
    figure!(least_scalar, "", Origin::Least(Unit::Scalar), true),
    figure!(texture, "texture", Origin::Most(Unit::Texture), true),
    figure!(least_texture, "", Origin::Least(Unit::Texture), true),
    figure!(memory, "memory", Origin::Most(Unit::Memory), true),
    figure!(least_memory, "", Origin::Least(Unit::Memory), true),
    figure!(scalar_memory, "s.mem", Origin::Most(Unit::ScalarMemory), true),
    figure!(least_scalar_memory, "", Origin::Least(Unit::ScalarMemory), true),
    figure!(local, "local", Origin::Most(Unit::Local), true),
    figure!(least_local, "", Origin::Least(Unit::Local), true),
    figure!(export, "export", Origin::Most(Unit::Export), true),
    figure!(least_export, "", Origin::Least(Unit::Export), true),
    figure!(open_loops, "loops", Origin::Count, true),
    figure!(wave, "", Origin::Count, false),
    figure!(vgprs, "VGPRs", Origin::Mesa("VGPRs"), true),
    figure!(sgprs, "SGPRs", Origin::Mesa("SGPRs"), true),
    figure!(spilled_vgprs, "spill V", Origin::Mesa("Spilled VGPRs"), true),
    figure!(spilled_sgprs, "spill S", Origin::Mesa("Spilled SGPRs"), true),
    figure!(scratch, "scratch", Origin::Mesa("Scratch size"), true),
    figure!(subgroups_per_simd, "waves", Origin::Mesa("Subgroups per SIMD"), false),
    figure!(instructions, "instr", Origin::Mesa("Instructions"), true),
    figure!(branches, "", Origin::Mesa("Branches"), true),
    figure!(code_size, "bytes", Origin::Mesa("Code size"), true),
];

impl CostFigure {
    /// The value of this figure.
    pub fn of(&self, statistics: &Statistics) -> i64 {
        *(self.field)(&mut statistics.clone())
    }
}

impl Statistics {
    /// From Mesa's names and values, and from what was counted in waves of so many threads. What
    /// Mesa does not report on a GPU is 0.
    pub fn of_stage<'n>(
        named: impl IntoIterator<Item = (&'n str, i64)>,
        counted: &MachineCost,
        wave: u32,
    ) -> Self {
        let mut statistics = Self::default();
        for (name, value) in named {
            let is_named =
                |figure: &&CostFigure| matches!(figure.origin, Origin::Mesa(mesa) if mesa == name);
            if let Some(figure) = FIGURES.iter().find(is_named) {
                *(figure.field)(&mut statistics) = value;
            }
        }
        for figure in FIGURES {
            let value = match figure.origin {
                Origin::Most(unit) => counted.most.of(unit),
                Origin::Least(unit) => counted.least.of(unit),
                Origin::Mesa(_) | Origin::Count => continue,
            };
            *(figure.field)(&mut statistics) = value;
        }
        statistics.open_loops = counted.open_loops() as i64;
        statistics.wave = i64::from(wave);
        statistics
    }

    /// Each figure less that of another stage.
    pub fn less(&self, other: &Self) -> Self {
        let mut difference = *self;
        for figure in FIGURES {
            *(figure.field)(&mut difference) -= figure.of(other);
        }
        difference.wave = self.wave;
        difference
    }
}
