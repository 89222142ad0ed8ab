//! Casts rays against the triangles of a scene, in a bounding volume hierarchy.

use glam::DVec3;

use super::sets::{Object, Scene};

/// Triangles that rays are cast against.
#[derive(Debug, Clone, Default)]
pub struct Surfaces {
    triangles: Vec<RayTriangle>,
    /// The root is the first one.
    nodes: Vec<BvhNode>,
}

/// What a ray meets first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// The distance, as a multiple of the length of the ray's direction.
    pub distance: f64,
    /// Of unit length, on the front of the triangle.
    pub normal: DVec3,
    /// The share of the light that it scatters.
    pub albedo: DVec3,
    /// The light that it gives off by itself.
    pub emission: DVec3,
}

#[derive(Debug, Clone, Copy)]
struct RayTriangle {
    corners: [DVec3; 3],
    albedo: DVec3,
    emission: DVec3,
}

/// A box around triangles.
#[derive(Debug, Clone)]
struct BvhNode {
    low: DVec3,
    high: DVec3,
    /// A leaf has a range of triangles. An inner node has the index of its second child; its first
    /// child comes right after it.
    content: Content,
}

#[derive(Debug, Clone)]
enum Content {
    Leaf(std::ops::Range<usize>),
    Second(usize),
}

/// The most triangles of a leaf.
const LEAF: usize = 4;
/// Nearer hits are ignored: they are on the surface that the ray starts from.
const NEAREST: f64 = 1e-6;
/// The relative and the absolute error that is allowed for in distances of boxes.
const MARGIN: f64 = 1e-12;
/// Room for the boxes that wait to be visited: at most one for each level of the hierarchy.
const LEVELS: usize = 64;

impl Surfaces {
    /// The triangles of everything that casts a shadow.
    pub fn of(scene: &Scene) -> Self {
        Self::with_looks(scene, Look::of)
    }

    /// The same, with the colours that `look` gives.
    pub fn with_looks(scene: &Scene, look: impl Fn(&Object) -> Look) -> Self {
        let casting = scene.objects.iter().filter(|object| object.casts);
        let mut triangles: Vec<RayTriangle> =
            casting.flat_map(|object| object_triangles(object, &look(object))).collect();
        let mut nodes = Vec::new();
        let count = triangles.len();
        if count > 0 {
            build_node(&mut triangles, 0..count, &mut nodes);
        }
        Self { triangles, nodes }
    }

    /// The first triangle that a ray meets, from either side. The direction need not be of unit
    /// length.
    pub fn hit(&self, from: DVec3, towards: DVec3) -> Option<Hit> {
        let ray = Ray::new(from, towards);
        // Of triangles at the same distance, the first counts, in whatever order they are met.
        let (mut best, mut found) = (f64::INFINITY, usize::MAX);
        self.walk(&ray, best, |index, distance| {
            if (distance, index) < (best, found) {
                (best, found) = (distance, index);
            }
            best
        });
        self.triangles.get(found).map(|triangle| Hit {
            distance: best,
            normal: triangle.across().normalize_or_zero(),
            albedo: triangle.albedo,
            emission: triangle.emission,
        })
    }

    /// Whether nothing is between two points.
    pub fn is_clear(&self, from: DVec3, to: DVec3) -> bool {
        let before = 1.0 - NEAREST;
        let mut is_clear = true;
        self.walk(&Ray::new(from, to - from), before, |_, distance| {
            is_clear &= distance >= before;
            // After a hit, no box is near enough.
            if is_clear { before } else { f64::NEG_INFINITY }
        });
        is_clear
    }

    /// Calls `meet` with the index and the distance of each triangle that the ray meets, in boxes
    /// that it enters before a distance. `meet` returns that distance anew. Of two boxes, the nearer
    /// one comes first.
    fn walk(&self, ray: &Ray, mut before: f64, mut meet: impl FnMut(usize, f64) -> f64) {
        let mut waiting = Vec::with_capacity(LEVELS);
        let enter = |index: usize| Some((self.nodes.get(index)?.enter(ray)?, index));
        waiting.extend(enter(0));
        while let Some((distance, index)) = waiting.pop() {
            // The margin is for boxes without a thickness.
            if distance > before * (1.0 + MARGIN) + MARGIN {
                continue;
            }
            match &self.nodes[index].content {
                Content::Second(second) => match (enter(index + 1), enter(*second)) {
                    (Some(first), Some(second)) if first.0 <= second.0 => {
                        waiting.extend([second, first]);
                    }
                    (first, second) => waiting.extend(first.into_iter().chain(second)),
                },
                Content::Leaf(range) => {
                    for at in range.clone() {
                        if let Some(distance) = self.triangles[at].met(ray) {
                            before = meet(at, distance);
                        }
                    }
                }
            }
        }
    }
}

/// A ray, with what the test of a box needs.
struct Ray {
    from: DVec3,
    towards: DVec3,
    /// The reciprocal of each component of `towards`.
    inverse: DVec3,
}

impl Ray {
    fn new(from: DVec3, towards: DVec3) -> Self {
        Self { from, towards, inverse: towards.recip() }
    }
}

/// The colours of an object.
#[derive(Debug, Clone, Copy)]
pub struct Look {
    /// Multiplied with the colours of the corners.
    pub color: DVec3,
    /// Share of the light that it reflects to all sides.
    pub diffuse: DVec3,
    /// Linear colour that it gives off by itself.
    pub emission: DVec3,
}

impl Look {
    /// The object's own.
    pub fn of(object: &Object) -> Self {
        let material = &object.material;
        Self { color: object.color, diffuse: material.diffuse, emission: material.emission }
    }
}

fn object_triangles(object: &Object, look: &Look) -> Vec<RayTriangle> {
    let vertex = |index: &u32| object.shape.vertices.get(*index as usize);
    let triangle = |three: &[u32]| {
        let [a, b, c] = [vertex(three.first()?)?, vertex(three.get(1)?)?, vertex(three.get(2)?)?];
        let place = |at: DVec3| object.world_from_object.transform_point3(at);
        let color = (a.color + b.color + c.color) / 3.0 * look.color;
        Some(RayTriangle {
            corners: [place(a.position), place(b.position), place(c.position)],
            albedo: (color * look.diffuse).clamp(DVec3::ZERO, DVec3::ONE),
            emission: look.emission,
        })
    };
    object.shape.indices.chunks(3).filter_map(triangle).collect()
}

/// Adds the tree of a range of triangles, which it reorders.
fn build_node(all: &mut [RayTriangle], range: std::ops::Range<usize>, nodes: &mut Vec<BvhNode>) {
    let triangles = &mut all[range.clone()];
    let corners = || triangles.iter().flat_map(|triangle| triangle.corners);
    let low = corners().fold(DVec3::INFINITY, DVec3::min);
    let high = corners().fold(DVec3::NEG_INFINITY, DVec3::max);
    let index = nodes.len();
    nodes.push(BvhNode { low, high, content: Content::Leaf(range.clone()) });
    if triangles.len() <= LEAF {
        return;
    }
    let size = high - low;
    let axis = (0..3).max_by(|a, b| size[*a].total_cmp(&size[*b])).unwrap_or(0);
    let half = triangles.len() / 2;
    triangles.select_nth_unstable_by(half, |a, b| a.middle()[axis].total_cmp(&b.middle()[axis]));
    let middle = range.start + half;
    build_node(all, range.start..middle, nodes);
    nodes[index].content = Content::Second(nodes.len());
    build_node(all, middle..range.end, nodes);
}

impl BvhNode {
    /// The distance at which a ray enters the box, at least 0; `None` if it misses the box.
    fn enter(&self, ray: &Ray) -> Option<f64> {
        let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
        for axis in 0..3 {
            let start = ray.from[axis];
            if ray.towards[axis] == 0.0 {
                if start < self.low[axis] || start > self.high[axis] {
                    return None;
                }
                continue;
            }
            let a = (self.low[axis] - start) * ray.inverse[axis];
            let b = (self.high[axis] - start) * ray.inverse[axis];
            (enter, leave) = (enter.max(a.min(b)), leave.min(a.max(b)));
        }
        (enter <= leave * (1.0 + MARGIN) + MARGIN).then_some(enter)
    }
}

impl RayTriangle {
    fn across(&self) -> DVec3 {
        let [a, b, c] = self.corners;
        (b - a).cross(c - a)
    }

    fn middle(&self) -> DVec3 {
        let [a, b, c] = self.corners;
        (a + b + c) / 3.0
    }

    /// Where a ray meets it: Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle
    /// Intersection", 1997.
    fn met(&self, ray: &Ray) -> Option<f64> {
        let (from, towards) = (ray.from, ray.towards);
        let [a, b, c] = self.corners;
        let (along, up) = (b - a, c - a);
        let p = towards.cross(up);
        let scale = along.dot(p);
        if scale == 0.0 {
            return None;
        }
        let offset = from - a;
        let q = offset.cross(along);
        let (u, v) = (offset.dot(p) / scale, towards.dot(q) / scale);
        let distance = up.dot(q) / scale;
        (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > NEAREST).then_some(distance)
    }
}
