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

/// Every GPU, oldest first.
pub const GPUS: &[Gpu] = &[
    make_gpu("fiji", "GCN 3", "Radeon R9 Fury", false, Rates::GCN),
    make_gpu("polaris10", "GCN 4", "Radeon RX 480", true, Rates::GCN),
    make_gpu("vega10", "GCN 5", "Radeon RX Vega 64", true, Rates::GCN_5),
    make_gpu("raven", "GCN 5", "Ryzen 5 2400G", false, Rates::GCN_5),
    make_gpu("navi10", "RDNA 1", "Radeon RX 5700", true, Rates::RDNA),
    make_gpu("navi21", "RDNA 2", "Radeon RX 6800", true, Rates::RDNA),
    make_gpu("navi24", "RDNA 2", "Radeon RX 6500 XT", false, Rates::RDNA),
    make_gpu("vangogh", "RDNA 2", "Steam Deck", false, Rates::RDNA),
    make_gpu("gfx1100", "RDNA 3", "Radeon RX 7900 XTX", true, Rates::RDNA),
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
