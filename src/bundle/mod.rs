//! Compiled permutations, as a directory or one file, and the loader an engine uses.
//!
//! This module uses nothing else of the crate.

mod reflection;
mod target;

pub use reflection::{Binding, Combined, Kind, Language, Member, Native, Override, Pair, Place, Reflection, Slot, Stage, Varying};
pub use target::Target;
