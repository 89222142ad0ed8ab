//! What varies: settings, axes, constraints, keys.
//!
//! A manifest declares the axes of a program and the constraints between them; together they are
//! a [`Space`], whose points are [`Assignment`]s, named by [`Key`]s and handed to a composition
//! as [`Settings`]. Nothing here reads files or prints.

pub mod axis;
pub mod constant;
pub mod constraint;
pub mod cover;
pub mod key;
mod lint;
pub mod lock;
pub mod manifest;
mod quoted;
pub mod report;
mod setting;
pub mod space;
pub mod tree;
pub mod usage;

pub use axis::{Axis, AxisKind, Mode};
pub use key::{Assignment, Key};
pub use lock::Lock;
pub use manifest::{Manifest, Program};
pub use quoted::Quoted;
pub use report::PermutationReport;
pub use setting::{Setting, Settings};
pub use space::Space;
pub use tree::ReadTree;
