//! Sources: Zhang, Sun, Xu and Lun, 2006; Microsoft, "Cascaded Shadow Maps".

use super::{Arguments, Entry, Expected};
use glam::DVec4;

pub const REFERENCES: Entry = Entry {
    module: "shadow::cascade",
    functions: &[
        ("cascade_index", |a| (index(a.f64(), a.vec4()) as f64).into()),
        ("cascade_blend", blend),
    ],
};

/// How many cascades end at or before the distance: the first that does not is the one.
fn index(depth: f64, splits: DVec4) -> usize {
    splits.to_array().iter().position(|end| depth < *end).unwrap_or(4)
}

/// From 0 to 1 over the last `overlap` units before the end.
fn blend(a: &mut Arguments<'_>) -> Expected {
    let (depth, splits, overlap) = (a.f64(), a.vec4(), a.f64());
    match splits.to_array().get(index(depth, splits)) {
        Some(end) if overlap > 0.0 => (1.0 - (end - depth) / overlap).clamp(0.0, 1.0).into(),
        _ => 0.0.into(),
    }
}
