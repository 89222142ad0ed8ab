//! Whole programs, made ready to be drawn: uniforms packed by reflection, stages composed, and
//! fragment stages that also return what each fragment was given.
//!
//! `reflection + values -> buffers`, `permutation -> stages`
//!
//! The targets of a frame hold words, four for each pixel, so that results are exact to the bit on
//! every executor. [`probe`] rewrites a fragment entry point to return the bits of its colour and
//! of its inputs.

mod budget;
mod pack;
pub mod probe;
mod programs;

pub use budget::bound_loops;
pub use pack::{BufferLeaf, buffer_leaves, pack_buffer};
pub use programs::{Programs, ReadyStage, Stages};
