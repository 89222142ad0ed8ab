//! What the compiler reports about the machine code of one stage.

use serde::{Deserialize, Serialize};

/// Figures of one stage, or the difference of two.
///
/// Latency and inverse throughput are estimates of the compiler, in cycles. Latency is the time of
/// one wave from its first instruction to its last. Inverse throughput is the time of the busiest
/// unit for each wave.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Statistics {
    pub instructions: i64,
    /// Vector registers of a thread.
    pub vgprs: i64,
    /// Scalar registers of a wave.
    pub sgprs: i64,
    pub spilled_vgprs: i64,
    pub spilled_sgprs: i64,
    /// Bytes of machine code.
    pub code_size: i64,
    /// Bytes of memory that a thread needs besides its registers.
    pub scratch: i64,
    /// Waves that fit on one SIMD at a time. More waves hide more latency.
    pub subgroups_per_simd: i64,
    pub branches: i64,
    pub latency: i64,
    pub inverse_throughput: i64,
}

/// A figure: its key in JSON, its heading in a table, Mesa's name for it, and whether more is
/// worse.
pub struct CostFigure {
    pub key: &'static str,
    pub heading: &'static str,
    pub mesa: &'static str,
    pub more_is_worse: bool,
    field: fn(&mut Statistics) -> &mut i64,
}

macro_rules! figure {
    ($key:ident, $heading:literal, $mesa:literal, $more_is_worse:literal) => {
        CostFigure {
            key: stringify!($key),
            heading: $heading,
            mesa: $mesa,
            more_is_worse: $more_is_worse,
            field: |statistics| &mut statistics.$key,
        }
    };
}

/// Every figure, in the order of tables.
pub const FIGURES: &[CostFigure] = &[
    figure!(instructions, "instr", "Instructions", true),
    figure!(vgprs, "VGPRs", "VGPRs", true),
    figure!(sgprs, "SGPRs", "SGPRs", true),
    figure!(spilled_vgprs, "spill V", "Spilled VGPRs", true),
    figure!(spilled_sgprs, "spill S", "Spilled SGPRs", true),
    figure!(code_size, "bytes", "Code size", true),
    figure!(scratch, "scratch", "Scratch size", true),
    figure!(subgroups_per_simd, "waves", "Subgroups per SIMD", false),
    figure!(branches, "branches", "Branches", true),
    figure!(latency, "latency", "Latency", true),
    figure!(inverse_throughput, "inv.thr.", "Inverse Throughput", true),
];

impl CostFigure {
    /// The value of this figure.
    pub fn of(&self, statistics: &Statistics) -> i64 {
        *(self.field)(&mut statistics.clone())
    }
}

impl Statistics {
    /// From Mesa's names and values. What it does not report on a GPU is 0.
    pub fn from_named<'n>(named: impl IntoIterator<Item = (&'n str, i64)>) -> Self {
        let mut statistics = Self::default();
        for (name, value) in named {
            if let Some(figure) = FIGURES.iter().find(|figure| figure.mesa == name) {
                *(figure.field)(&mut statistics) = value;
            }
        }
        statistics
    }

    /// Each figure less that of another stage.
    pub fn less(&self, other: &Self) -> Self {
        let mut difference = *self;
        for figure in FIGURES {
            *(figure.field)(&mut difference) -= figure.of(other);
        }
        difference
    }
}
