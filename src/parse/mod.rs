//! From text to items, imports and conditions.

pub mod wesl;
pub mod glsl;
