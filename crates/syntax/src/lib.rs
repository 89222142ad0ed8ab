//! From text to items, imports and conditions.

pub mod foreign;
pub mod glsl;
pub mod wesl;
pub mod words;
