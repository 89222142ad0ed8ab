//! What machine code executes: the cycles of each unit along the cheapest and the dearest path.
//!
//! `text -> blocks -> flow (loops) -> trip count of each loop -> paths`
//!
//! The text is the driver's disassembly. A cycle is the time in which a SIMD issues one vector
//! instruction at full rate for 64 threads: 4 clock cycles on GCN, 2 on RDNA, where two waves of 32
//! threads take as long as one of 64. So counts of both can be compared. Waiting, caches and the
//! overlap of units are not counted.

mod flow;
mod interval;
mod masks;
mod paths;
mod registers;
mod repair;
mod text;
mod trips;
mod units;

pub use units::{Rates, UNITS, Unit, Weights};

use flow::Flow;
use trips::TripCount;

/// The cycles of each unit along paths through a stage.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MachineCost {
    /// For each unit the path on which it has the fewest cycles.
    pub least: Weights,
    /// For each unit the path on which it has the most.
    pub most: Weights,
    /// Loops, in the order of the code.
    pub loops: Vec<TripCount>,
}

impl MachineCost {
    /// Loops of which neither the code nor the caller says how often they run. They count once.
    pub fn open_loops(&self) -> usize {
        self.loops.iter().filter(|count| **count == TripCount::Unknown).count()
    }
}

/// Why machine code could not be counted.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum MachineError {
    /// There is no text: the driver has no disassembler for the chip.
    NoText,
    /// Instructions whose unit and rate are not known, each once.
    UnknownInstructions(Vec<String>),
    /// A branch to a place that has no label.
    UnknownTarget(String),
    /// The disassembler could not read these words, nor could they be distinguished from their neighbours.
    Unreadable(String),
    /// A loop is entered at two places.
    Irreducible(String),
    /// No path leads from the first instruction to the end.
    NoEnd,
}

impl std::fmt::Display for MachineError {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NoText => write!(out, "the driver has no disassembler for this chip"),
            Self::UnknownInstructions(names) => {
                write!(out, "machine instructions of unknown cost: {}", names.join(", "))
            }
            Self::UnknownTarget(name) => {
                write!(out, "a branch leads to `{name}`, which is nowhere")
            }
            Self::Unreadable(words) => write!(out, "unreadable machine code: {words}"),
            Self::Irreducible(label) => write!(out, "the loop at `{label}` has two entries"),
            Self::NoEnd => write!(out, "no path leads to the end of the machine code"),
        }
    }
}

impl std::error::Error for MachineError {}

/// How to count.
#[derive(Debug, Clone, Copy)]
pub struct Counting<'a> {
    pub rates: Rates,
    /// Threads of a wave: 32 or 64.
    pub wave: u32,
    /// How often loops run of which the code does not say it, in the order of the code. The last
    /// number holds for all further ones.
    pub iterations: &'a [u32],
}

/// Counts the machine code of a stage.
///
/// # Errors
/// What about the text is not understood. Nothing is left out in silence.
pub fn count_machine(text: &str, counting: Counting<'_>) -> Result<MachineCost, MachineError> {
    let blocks = text::parse_blocks(text)?;
    let weights = units::weigh_blocks(&blocks, counting)?;
    let flow = Flow::of(&blocks)?;
    let loops = trips::trip_counts(&blocks, &flow, counting.wave, counting.iterations);
    paths::count_paths(&flow, &weights, loops)
}
