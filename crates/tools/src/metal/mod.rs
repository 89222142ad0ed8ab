//! Metal's language without a Mac: clang, with headers of our own in the place of Apple's, judges
//! the MSL that the crate emits. `execute::compiled` runs it on the CPU.
//!
//! `texts -> judge (attributes, then clang) -> refusals`
//!
//! The headers are in `shim/`. What C++ cannot express is rewritten by `adapt`. [`attributes`]
//! checks what clang ignores.

pub mod adapt;
pub mod attributes;
mod clang;
pub mod judge;
pub mod token;

pub use clang::{Clang, ClangMissing, clang_version, shim_hash};
pub use judge::{MslRefusal, judge_batch};
