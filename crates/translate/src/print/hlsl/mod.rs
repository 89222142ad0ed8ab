//! What HLSL writes otherwise than GLSL.
//!
//! A matrix has WGSL's columns as its rows, so that `m[i]` means the same, and products exchange
//! their operands. Structures and arrays are made by functions and by lists, since HLSL has no
//! expression for them.

mod arrays;
mod builtin;
mod construct;
mod texture;
mod words;

pub use arrays::{array_types, made_array};
pub use builtin::function_name;
pub use texture::{method_name, size_function, texture_name};
pub use words::{is_function, is_keyword};
