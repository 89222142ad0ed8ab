//! What MSL writes otherwise than GLSL.

mod builtin;
mod texture;
mod words;

pub use builtin::function_name;
pub use texture::{argument_of, texture_name};
pub use words::{is_function, is_keyword};
