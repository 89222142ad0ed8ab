//! The parts of a shadow map with `cascades`: which distances each covers, and where it is.

use glam::{DMat4, DVec3};

use lamplight_scene::{Bounds, bounding_sphere, cascade_splits, depth_range};
use lamplight_scenes::sets::{Eye, Scene};

/// How many cascades the map has. Each is a quarter of the map.
pub(super) const CASCADES: usize = 4;

/// The weight of the logarithmic split. The rest is the weight of the uniform split.
const SPLIT: f64 = 0.7;
/// Before its end a part fades into the next one, over this share of the first part.
const OVERLAP: f64 = 0.2;

/// The parts, from the nearest to the farthest.
#[derive(Debug, Clone)]
pub struct Cascades {
    /// The centre and the radius of a sphere around what each part covers.
    spheres: [(DVec3, f64); CASCADES],
    /// The size of a texel of each.
    pub texels: [f64; CASCADES],
    splits: [f64; CASCADES],
    overlap: f64,
    /// Texels along an edge of a part.
    size: f64,
}

/// The nearest and the farthest thing that the viewer may see.
pub(super) fn seen_range(scene: &Scene) -> (f64, f64) {
    let eye = &scene.eye;
    let (nearest, farthest) =
        depth_range(eye.view(), &scene.points()).unwrap_or((eye.near, eye.far));
    let (near, far) = (nearest.clamp(eye.near, eye.far), farthest.clamp(eye.near, eye.far));
    (near, far.max(1.001 * near))
}

impl Cascades {
    /// The parts of the depths from `near` to `far`, for a viewer with this projection. At each
    /// side of a part, `rim` texels are left for lookups.
    pub fn new(eye: &Eye, projection: DMat4, (near, far): (f64, f64), size: u32, rim: f64) -> Self {
        let ends = cascade_splits(near, far, CASCADES, SPLIT);
        let mut splits: [f64; CASCADES] =
            std::array::from_fn(|index| ends.get(index).copied().unwrap_or(far));
        let overlap = OVERLAP * (splits[0] - near);
        // The last part fades out behind everything that is seen.
        splits[CASCADES - 1] += overlap;
        let tangents = [projection.x_axis.x.recip(), projection.y_axis.y.recip()];
        let forward = -eye.view().inverse().z_axis.truncate();
        let spheres = std::array::from_fn(|index| {
            let start = if index == 0 { near } else { splits[index - 1] - overlap };
            let (distance, radius) = bounding_sphere(start, splits[index], tangents);
            (eye.position + forward * distance, radius)
        });
        let texels =
            spheres.map(|(_, radius)| 2.0 * radius / (f64::from(size) - 2.0 * rim).max(1.0));
        Self { spheres, texels, splits, overlap, size: f64::from(size) }
    }

    /// The sides of a part in the light's view, snapped to whole texels.
    pub fn bounds(&self, index: usize, view: DMat4) -> Bounds {
        let (texel, (middle, _)) = (self.texels[index], self.spheres[index]);
        let at = (view.transform_point3(middle) / texel).round() * texel;
        let half = 0.5 * texel * self.size;
        Bounds {
            left: at.x - half,
            right: at.x + half,
            bottom: at.y - half,
            top: at.y + half,
            near: 0.0,
            far: 1.0,
        }
    }

    /// The numbers of a field of the block `cascades`. `parts` are the matrices from world space to
    /// each part's own clip space.
    pub fn number(&self, parts: &[DMat4], index: usize, field: &str) -> Option<Vec<f64>> {
        Some(match field {
            "clip_from_world" => {
                (quarter_matrix(index) * *parts.get(index)?).to_cols_array().to_vec()
            }
            "splits" => self.splits.to_vec(),
            "texels" => self.texels.to_vec(),
            "overlap" => vec![self.overlap],
            _ => return None,
        })
    }
}

/// From the clip space of a part to that of the whole map.
fn quarter_matrix(index: usize) -> DMat4 {
    let (column, row) = ((index % 2) as f64, (index / 2) as f64);
    DMat4::from_translation(DVec3::new(column - 0.5, 0.5 - row, 0.0))
        * DMat4::from_scale(DVec3::new(0.5, 0.5, 1.0))
}

/// The depths of all parts as one map, which has twice their size.
pub(super) fn quartered_map(parts: &[Vec<f32>], size: u32) -> Vec<f32> {
    let size = size as usize;
    let texel = |index: usize| {
        let (x, y) = (index % (2 * size), index / (2 * size));
        let part = parts.get(x / size + 2 * (y / size));
        part.and_then(|part| part.get(x % size + size * (y % size))).copied().unwrap_or(1.0)
    };
    (0..4 * size * size).map(texel).collect()
}

/// The near and the far plane of each of `count` slices of the viewer's depth. The splits between
/// them are chosen for the depths of the scene. The first and the last plane are those of the
/// viewer. Each slice begins a little before the previous one ends: if both were clipped at the
/// same plane, rounding would leave pixels that neither of them draws.
pub(super) fn slices_of(scene: &Scene, count: u32) -> Vec<(f64, f64)> {
    let eye = &scene.eye;
    let (near, far) = seen_range(scene);
    let mut ends = cascade_splits(near, far, count as usize, SPLIT);
    if let Some(last) = ends.last_mut() {
        *last = eye.far;
    }
    let starts: Vec<f64> =
        std::iter::once(eye.near).chain(ends.iter().map(|end| 0.999 * end)).collect();
    starts.into_iter().zip(ends).collect()
}
