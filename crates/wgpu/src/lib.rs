//! From a bundle to a pipeline of wgpu: one pipeline layout for all permutations of a program,
//! stages with the constants of their key, vertex layouts, and uniform blocks.
//!
//! `Program::layout -> pipeline_layout`, `Shader::get -> Stage`, [`vertex_attributes`], [`Block`].
//!
//! The package has the version of wgpu in its own dependencies: a pipeline takes its values only with
//! that version.

mod block;
mod layout;
mod stage;

pub use block::{Block, BlockError, Number};
pub use layout::{LayoutError, PipelineLayout, immediate_size, layout_entries, pipeline_layout};
pub use stage::{Stage, StageError, vertex_attributes};
