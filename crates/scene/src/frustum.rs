//! Frusta, and fits around what is seen.

use glam::{DMat4, DVec3};

use crate::projection::{Clip, Depth};

/// A box in view space; `near` and `far` are distances along -z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Lowest x.
    pub left: f64,
    /// Highest x.
    pub right: f64,
    /// Lowest y.
    pub bottom: f64,
    /// Highest y.
    pub top: f64,
    /// Distance of the near plane.
    pub near: f64,
    /// Distance of the far plane.
    pub far: f64,
}

/// The corners of a frustum in world space: four of the near plane, then four of the far plane,
/// each with x before y, from -1 to 1 in normalised device coordinates.
///
/// Parameters: `view_projection` world to clip space, invertible.
pub fn corners(view_projection: DMat4, clip: Clip, depth: Depth) -> [DVec3; 8] {
    let (near, far) = clip.depths(depth);
    let inverse = view_projection.inverse();
    std::array::from_fn(|index| {
        let sign = |bit: usize| if index & bit == 0 { -1.0 } else { 1.0 };
        inverse.project_point3(DVec3::new(
            sign(1),
            sign(2),
            if index & 4 == 0 { near } else { far },
        ))
    })
}

/// The tightest near and far plane around points: their least and greatest distance along -z.
///
/// Parameters: `view` world to view space; `points` in world space.
/// Returns: `None` without points. Points behind the eye have negative distances.
pub fn depth_range(view: DMat4, points: &[DVec3]) -> Option<(f64, f64)> {
    fit(view, points).map(|bounds| (bounds.near, bounds.far))
}

/// The smallest box in view space around points: a directional light's frustum, by
/// [`orthographic`](super::orthographic).
///
/// Returns: `None` without points. A box around one point has no volume.
pub fn fit(view: DMat4, points: &[DVec3]) -> Option<Bounds> {
    let seen = || points.iter().map(|point| view.transform_point3(*point));
    let (low, high) = (seen().reduce(DVec3::min)?, seen().reduce(DVec3::max)?);
    Some(Bounds {
        left: low.x,
        right: high.x,
        bottom: low.y,
        top: high.y,
        near: -high.z,
        far: -low.z,
    })
}

/// Where the cascades of a directional light end: the far distance of each.
///
/// Parameters: `near`, `far` of the camera, scene units, `0 < near < far`; `lambda` in [0, 1]: 0
/// splits evenly, 1 logarithmically.
/// Returns: `count` distances that grow; the last is `far` itself.
/// Source: Zhang et al., "Parallel-Split Shadow Maps for Large-Scale Virtual Environments", 2006,
/// section 4, the practical split scheme.
pub fn cascade_splits(near: f64, far: f64, count: usize, lambda: f64) -> Vec<f64> {
    let split = |index: usize| {
        if index == count {
            return far;
        }
        let part = index as f64 / count as f64;
        lambda * near * (far / near).powf(part) + (1.0 - lambda) * (near + (far - near) * part)
    };
    (1..=count).map(split).collect()
}

/// The smallest sphere around a slice of a view frustum: its distance from the eye along the view
/// axis, and its radius. A shadow map of this size fits however the viewer turns.
///
/// Parameters: `near`, `far` ends of the slice, scene units, `0 <= near <= far`; `tangents` of half
/// the angles of view, across and up.
/// Source: Valient, "Stable Rendering of Cascaded Shadow Maps", ShaderX 6, 2008.
/// Edges: the centre of a wide slice is at its far end, not beyond it.
pub fn bounding_sphere(near: f64, far: f64, tangents: [f64; 2]) -> (f64, f64) {
    let spread = tangents[0].powi(2) + tangents[1].powi(2);
    let centre = (0.5 * (near + far) * (1.0 + spread)).min(far);
    (centre, (far - centre).hypot(far * spread.sqrt()))
}
