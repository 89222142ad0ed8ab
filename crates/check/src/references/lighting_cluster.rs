//! Sources: Olsson, Billeter and Assarsson, 2012, section 3.2; Sousa and Geffroy, 2016.

use super::Source::Published;
use super::{CallArguments, Expected, ReferenceEntry};

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "lighting::cluster",
    functions: &[
        ("cluster_slice", Published, cluster_slice),
        ("slice_depth", Published, |a| border(a.f64(), a.f64(), a.f64(), a.f64()).into()),
        ("cluster_index", Published, cluster_index),
    ],
};

/// The depth at which a slice begins.
fn border(index: f64, near: f64, far: f64, count: f64) -> f64 {
    let first = near.max(f64::from(1e-6f32));
    if far <= first || count == 0.0 {
        first
    } else {
        first * (far / first).powf(index.min(count) / count)
    }
}

/// The slice of a depth, found by search, and the neighbouring slice if the depth is so near to
/// their border that either is right.
fn slices(z: f64, near: f64, far: f64, count: f64) -> (f64, f64) {
    let first = near.max(f64::from(1e-6f32));
    if far <= first || count == 0.0 {
        return (0.0, 0.0);
    }
    let search = |z: f64| {
        let begun = |index: &u32| border(f64::from(*index), near, far, count) <= z;
        f64::from((1..count as u32).take_while(begun).count() as u32)
    };
    // A border that is computed in f32 is off by a few units in the last place of its logarithms.
    let slack = 1e-6 * (1.0 + (far / first).log2() * 0.25);
    let (found, above) = (search(z), search(z * (1.0 + slack)));
    (found, if above != found { above } else { search(z * (1.0 - slack)) })
}

fn cluster_slice(a: &mut CallArguments<'_>) -> Expected {
    let (found, other) = slices(a.f64(), a.f64(), a.f64(), a.f64());
    Expected::from(found).or(other)
}

/// Cells are numbered row by row, then layer by layer. Near a border of layers, either layer is
/// right.
fn cluster_index(a: &mut CallArguments<'_>) -> Expected {
    let (uv, z, near, far, counts) = (a.vec2(), a.f64(), a.f64(), a.f64(), a.vec3());
    let cell = |u: f64, count: f64| (u.clamp(0.0, 1.0) * count).floor().min(count.max(1.0) - 1.0);
    let (x, y) = (cell(uv.x, counts.x), cell(uv.y, counts.y));
    let index = |slice: f64| x + counts.x * (y + counts.y * slice);
    let (slice, other) = slices(z, near, far, counts.z);
    Expected::from(index(slice)).or(index(other))
}
