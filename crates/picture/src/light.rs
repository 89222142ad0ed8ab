//! The view of the light that casts the shadow. A shadow map with `cascades` has several parts: which
//! distances each covers, and where it is.

use crate::plan::{Pass, Plan};
use glam::{DMat4, DVec3};
use lamplight_scene::{
    Bounds, Clip, Depth, bounding_sphere, cascade_splits, corners, cube_projection, cube_view,
    depth_range, fit, look_along, orthographic, perspective,
};
use lamplight_scenes::sets::{Eye, Lamp, LampKind, Scene};

/// How a shadow map is drawn.
#[derive(Debug, Clone)]
pub struct LightView {
    /// From world to clip space: one matrix, or one for each face of a cube.
    pub clip_from_world: Vec<DMat4>,
    pub near: f64,
    pub far: f64,
    /// Texels along an edge.
    pub size: u32,
    /// The size of a texel: for directional lights the same everywhere (with cascades, that of the
    /// first part), for others at distance 1.
    pub texel: f64,
    /// The parts of the map, if it has cascades.
    pub parts: Option<Cascades>,
}

/// A box for a scene without points.
const UNIT: Bounds =
    Bounds { left: -1.0, right: 1.0, bottom: -1.0, top: 1.0, near: -1.0, far: 1.0 };

/// The near plane is at least this share of the far plane, since a nearer one wastes precision.
const NEAREST: f64 = 0.02;

/// What a source publishes about the frustum of a spot light's map.
struct LightFrustum {
    /// The whole angle, radians.
    angle: Option<f64>,
    near: Option<f64>,
    far: Option<f64>,
}

impl LightFrustum {
    fn of(plan: &Plan, last: &Pass) -> Self {
        let number = |field| plan.number("depth_pass", field)?.first().copied();
        Self {
            angle: number("fov").map(f64::to_radians),
            near: number("near").or(last.needs.near),
            far: number("far"),
        }
    }
}

/// How many texels to each side of a point a shadow lookup may read: the radius of its filter, plus
/// the offset by which it moves the point, plus a margin.
fn lookup_rim(plan: &Plan, last: &Pass) -> f64 {
    let number = |field: &str| {
        let changed = plan.changes.uniforms.get(&format!("caster.{field}")).cloned();
        let numbers = changed.or_else(|| plan.number("caster", field));
        numbers.and_then(|numbers| numbers.first().copied()).unwrap_or_default().abs()
    };
    let reach = last.needs.reach;
    (2.0 * reach + 3.0).max(reach.max(number("radius")) + number("normal_offset") + 3.0)
}

impl LightView {
    /// The view of the scene's first lamp, as the last pass of a plan needs it. `eye` is the
    /// projection of the viewer.
    pub fn new(
        scene: &Scene,
        lamp: &Lamp,
        plan: &Plan,
        last: &Pass,
        size: u32,
        eye: DMat4,
    ) -> Self {
        let points = scene.points();
        match last.needs.caster.unwrap_or(LampKind::Spot) {
            LampKind::Directional if last.needs.cascades => {
                Self::parted(scene, lamp, size, lookup_rim(plan, last), eye)
            }
            LampKind::Spot => Self::spot(lamp, &points, size, &LightFrustum::of(plan, last)),
            LampKind::Directional => Self::directional(lamp, &points, size),
            LampKind::Point => Self::point(lamp, &points, size / 2),
        }
    }

    fn spot(lamp: &Lamp, points: &[DVec3], size: u32, frustum: &LightFrustum) -> Self {
        let view = look_along(lamp.position, lamp.axis(), DVec3::Y);
        let (nearest, farthest) = depth_range(view, points).unwrap_or((0.1, 10.0));
        let far = frustum.far.unwrap_or(farthest.max(0.1) * 1.01);
        let fitting = || (0.98 * nearest).clamp(NEAREST * far, 0.9 * far);
        let near = frustum.near.unwrap_or_else(fitting);
        // Wider than the cone by two texels, so that the cone's rim is inside.
        let cone = || (2.0 * lamp.half_angle * (1.0 + 4.0 / f64::from(size))).min(2.8);
        let angle = frustum.angle.unwrap_or_else(cone);
        let projection = perspective(angle, 1.0, near, far, Clip::Wgpu, Depth::Normal);
        let texel = 2.0 * (0.5 * angle).tan() / f64::from(size);
        Self { clip_from_world: vec![projection * view], near, far, size, texel, parts: None }
    }

    fn directional(lamp: &Lamp, points: &[DVec3], size: u32) -> Self {
        let view = look_along(lamp.position, lamp.axis(), DVec3::Y);
        Self::around(view, fit(view, points).unwrap_or(UNIT), size)
    }

    /// The view of a directional light for a part of the viewer's depth, including everything that
    /// may cast a shadow into it.
    pub fn cascade(scene: &Scene, lamp: &Lamp, clip_from_world: DMat4, size: u32) -> Self {
        let view = look_along(lamp.position, lamp.axis(), DVec3::Y);
        let whole = fit(view, &scene.points()).unwrap_or(UNIT);
        let part = fit(view, &corners(clip_from_world, Clip::Wgpu, Depth::Normal)).unwrap_or(whole);
        let bounds = Bounds {
            left: part.left.max(whole.left),
            right: part.right.min(whole.right),
            bottom: part.bottom.max(whole.bottom),
            top: part.top.min(whole.top),
            ..whole
        };
        // A part without anything of the scene in it may have any map.
        let is_seen = bounds.left < bounds.right && bounds.bottom < bounds.top;
        Self::around(view, if is_seen { bounds } else { whole }, size)
    }

    /// The views of a directional light for four parts of the viewer's depth. Each map fits around
    /// a sphere, so that it keeps its size however the viewer turns, and moves by whole texels.
    fn parted(scene: &Scene, lamp: &Lamp, size: u32, rim: f64, eye: DMat4) -> Self {
        let view = look_along(lamp.position, lamp.axis(), DVec3::Y);
        let whole = fit(view, &scene.points()).unwrap_or(UNIT);
        let parts = Cascades::new(&scene.eye, eye, seen_range(scene), size, rim);
        let margin = 1e-3 * (whole.far - whole.near).max(1.0);
        let (near, far) = (whole.near - margin, whole.far + margin);
        let clip_from_world = (0..CASCADES)
            .map(|index| {
                let bounds = Bounds { near, far, ..parts.bounds(index, view) };
                orthographic(&bounds, Clip::Wgpu, Depth::Normal) * view
            })
            .collect();
        Self { clip_from_world, near, far, size, texel: parts.texels[0], parts: Some(parts) }
    }

    fn around(view: DMat4, tight: Bounds, size: u32) -> Self {
        // A margin on all sides: on the map for filters, in depth for rounding.
        let margin = 0.02 * (tight.right - tight.left).max(tight.top - tight.bottom) + 1e-3;
        let bounds = Bounds {
            left: tight.left - margin,
            right: tight.right + margin,
            bottom: tight.bottom - margin,
            top: tight.top + margin,
            near: tight.near - margin,
            far: tight.far + margin,
        };
        let texel = (bounds.right - bounds.left).max(bounds.top - bounds.bottom) / f64::from(size);
        let projection = orthographic(&bounds, Clip::Wgpu, Depth::Normal);
        Self {
            clip_from_world: vec![projection * view],
            near: bounds.near,
            far: bounds.far,
            size,
            texel,
            parts: None,
        }
    }

    fn point(lamp: &Lamp, points: &[DVec3], size: u32) -> Self {
        let farthest = points.iter().map(|point| point.distance(lamp.position)).fold(1.0, f64::max);
        let (near, far) = (NEAREST * farthest, 1.01 * farthest);
        let projection = cube_projection(near, far, Clip::Wgpu, Depth::Normal);
        let faces = (0..6).map(|face| projection * cube_view(lamp.position, face)).collect();
        Self { clip_from_world: faces, near, far, size, texel: 2.0 / f64::from(size), parts: None }
    }

    /// Whether it is a cube with six faces.
    pub fn is_cube(&self) -> bool {
        self.clip_from_world.len() == 6
    }
}

/// How many cascades the map has. Each is a quarter of the map.
const CASCADES: usize = 4;

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
fn seen_range(scene: &Scene) -> (f64, f64) {
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
pub(crate) fn quartered_map(parts: &[Vec<f32>], size: u32) -> Vec<f32> {
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
pub(crate) fn slices_of(scene: &Scene, count: u32) -> Vec<(f64, f64)> {
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
