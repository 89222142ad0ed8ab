//! The GPUs that shaders can be compiled for.
//!
//! Why is there no chip of GCN 1 or 2? LLVM has no disassembler for them that Mesa uses, so nothing
//! could be counted.

use crate::machine::Rates;

/// A GPU that Mesa's RADV compiles for without having it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Gpu {
    /// What Mesa calls the chip.
    pub name: &'static str,
    pub generation: &'static str,
    /// A card that has it.
    pub example: &'static str,
    /// Whether it represents its generation where no GPU is named.
    pub is_default: bool,
    /// Rates that differ between generations.
    pub rates: Rates,
}

/// GCN converts at a quarter of the rate; its small chips have no fast fused instructions.
const GCN: Rates = Rates { conversion: 4, fused: 4 };
const GCN_5: Rates = Rates { conversion: 4, fused: 1 };
const RDNA: Rates = Rates { conversion: 1, fused: 1 };

/// Every GPU, oldest first.
pub const GPUS: &[Gpu] = &[
    make_gpu("fiji", "GCN 3", "Radeon R9 Fury", false, GCN),
    make_gpu("polaris10", "GCN 4", "Radeon RX 480", true, GCN),
    make_gpu("vega10", "GCN 5", "Radeon RX Vega 64", true, GCN_5),
    make_gpu("raven", "GCN 5", "Ryzen 5 2400G", false, GCN_5),
    make_gpu("navi10", "RDNA 1", "Radeon RX 5700", true, RDNA),
    make_gpu("navi21", "RDNA 2", "Radeon RX 6800", true, RDNA),
    make_gpu("navi24", "RDNA 2", "Radeon RX 6500 XT", false, RDNA),
    make_gpu("vangogh", "RDNA 2", "Steam Deck", false, RDNA),
    make_gpu("gfx1100", "RDNA 3", "Radeon RX 7900 XTX", true, RDNA),
];

const fn make_gpu(
    name: &'static str,
    generation: &'static str,
    example: &'static str,
    is_default: bool,
    rates: Rates,
) -> Gpu {
    Gpu { name, generation, example, is_default, rates }
}

pub fn find_gpu(name: &str) -> Option<&'static Gpu> {
    GPUS.iter().find(|gpu| gpu.name == name)
}
