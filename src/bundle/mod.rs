//! Compiled permutations, as a directory or one file, and the loader an engine uses.
//!
//! This module uses nothing else of the crate.

mod target;

pub use target::Target;
