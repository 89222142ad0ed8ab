//! From text to items, imports and conditions.
