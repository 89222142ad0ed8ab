//! Source: OpenGL Programming Guide, example 7.11: as printed, and with what its text means.

use super::Source::Published;
use super::{CallArguments, Expected, ReferenceEntry};

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "lighting::material",
    functions: &[
        ("material_index", Published, material_index),
        ("material_index_oglpg", Published, material_index_oglpg),
    ],
};

/// Two materials for each index: the one for front faces, then the one for back faces.
fn material_index(a: &mut CallArguments<'_>) -> Expected {
    let (index, front) = (a.f64(), a.bool());
    Expected::from(2.0 * index + if front { 0.0 } else { 1.0 })
}

/// As printed: the index for front faces, and the index + 1 for back faces, without doubling.
fn material_index_oglpg(a: &mut CallArguments<'_>) -> Expected {
    let (index, front) = (a.f64(), a.bool());
    Expected::from(index + if front { 0.0 } else { 1.0 })
}
