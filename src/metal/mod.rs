//! Metal's language without a Mac: clang, with headers of our own in the place of Apple's, judges
//! the MSL that the crate emits and runs it on the CPU.
//!
//! `texts -> judge (attributes, then clang) -> refusals`
//! `texts -> interface (what entry points take) -> program (clang, linked) -> words`
//!
//! The headers are in `shim/`. What C++ cannot express is rewritten by `adapt`. [`attributes`]
//! checks what clang ignores.

mod adapt;
pub mod attributes;
mod build;
mod clang;
pub mod interface;
pub mod judge;
pub mod program;
pub mod request;
mod token;

pub use clang::{Clang, Missing, clang_version, shim_hash};
pub use judge::{Refusal, judge_batch, judge_texts};
pub use program::Program;
