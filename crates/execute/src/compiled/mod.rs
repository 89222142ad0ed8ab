//! Texts in MSL as one program of this machine, which [`metal`](lamplight_tools::metal)'s clang compiles.
//!
//! `texts -> interface (what entry points take) -> program (clang, linked) -> words`

mod build;
pub mod interface;
mod program;
pub mod request;

pub use program::CompiledProgram;
