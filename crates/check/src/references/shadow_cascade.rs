//! Sources: Zhang, Sun, Xu and Lun, 2006; Microsoft, "Cascaded Shadow Maps"; Valient, 2008.

use super::Source::Published;
use super::{CallArguments, Expected, ReferenceEntry};
use glam::{DVec2, DVec4};

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "shadow::cascade",
    functions: &[
        ("cascade_index", Published, |a| (index(a.f64(), a.vec4()) as f64).into()),
        ("cascade_blend", Published, blend),
        ("cascade_split", Published, split),
        ("cascade_snap", Published, snap),
        ("bounding_sphere", Published, |a| bounding_sphere(a.f64(), a.f64(), a.vec2()).into()),
    ],
};

/// The first cascade that ends beyond the distance; 4 if none does.
fn index(depth: f64, splits: DVec4) -> usize {
    splits.to_array().iter().position(|end| depth < *end).unwrap_or(4)
}

/// From 0 to 1 over the last `overlap` units before the end.
fn blend(a: &mut CallArguments<'_>) -> Expected {
    let (depth, splits, overlap) = (a.f64(), a.vec4(), a.f64());
    match splits.to_array().get(index(depth, splits)) {
        Some(end) if overlap > 0.0 => (1.0 - (end - depth) / overlap).clamp(0.0, 1.0).into(),
        _ => 0.0.into(),
    }
}

/// The logarithmic and the even split, mixed by `lambda`.
fn split(a: &mut CallArguments<'_>) -> Expected {
    let (index, count, near, far, lambda) = (a.f64(), a.f64(), a.f64(), a.f64(), a.f64());
    let near = near.max(f64::from(1e-6f32));
    if far <= near || count == 0.0 {
        return near.into();
    }
    let (share, lambda) = (index.min(count) / count, lambda.clamp(0.0, 1.0));
    (lambda * near * (far / near).powf(share) + (1.0 - lambda) * (near + (far - near) * share))
        .into()
}

/// The offset to the nearest whole texel. Half way between two texels, either is right.
fn snap(a: &mut CallArguments<'_>) -> Expected {
    let (origin, size) = (a.vec2(), a.f64().max(1.0));
    let texel = origin * size / 2.0;
    let offset = |tie: DVec2| (((texel + tie).floor() - texel) * 2.0 / size).to_array();
    let (down, up) = (0.5 - 1e-6 * size, 0.5 + 1e-6 * size);
    let all = [down, up].map(|x| [down, up].map(|y| Expected::words(offset(DVec2::new(x, y)))));
    let [[a, b], [c, d]] = all;
    a.or(b).or(c).or(d)
}

/// The distance of the centre from the eye, and the radius. The centre is as far from the corners
/// of the near end as from those of the far end, but not beyond the far end.
fn bounding_sphere(near: f64, far: f64, tangents: DVec2) -> DVec2 {
    let to = |centre: f64, end: f64| (centre - end).hypot(tangents.length() * end);
    let (mut low, mut high) = (near, far);
    for _ in 0..100 {
        let centre = 0.5 * (low + high);
        if to(centre, near) < to(centre, far) { low = centre } else { high = centre }
    }
    DVec2::new(high, to(high, far))
}
