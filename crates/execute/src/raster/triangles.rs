//! Clips triangles, places them on the frame, and finds which are visible.

use std::ops::Range;

use crate::frame::{Face, Mesh, PipelineState};
use crate::raster::Corner;

/// A triangle on the frame.
#[derive(Debug, Clone)]
pub struct Triangle {
    pub item: usize,
    /// Vertices of the item, in the order that gives a positive area on the frame.
    pub corners: [u32; 3],
    /// The vertex whose flat values are those of the triangle.
    pub first: u32,
    pub front: bool,
    /// Positions in pixels, y down; depth; 1/w.
    points: [ScreenPoint; 3],
    area: f64,
}

#[derive(Debug, Clone, Copy)]
struct ScreenPoint {
    x: f64,
    y: f64,
    z: f64,
    inverse_w: f64,
}

/// The visible triangle of each pixel.
pub struct VisibleTriangles {
    size: [u32; 2],
    pub depth: Vec<f32>,
    /// Index of the triangle, or [`NONE`].
    pub triangle: Vec<u32>,
}

/// Stands for no triangle.
pub const NONE: u32 = u32::MAX;

/// The number of subpixels along a side of a pixel. Vertex positions are rounded to subpixels, as
/// in hardware.
const SUBPIXELS: f64 = 256.0;

/// Adds the triangles of a mesh. Clipping adds vertices.
pub fn assemble_triangles(
    mesh: &Mesh,
    item: usize,
    corners: &mut Vec<Corner>,
    state: PipelineState,
    size: [u32; 2],
    to: &mut Vec<Triangle>,
) {
    let indices: Vec<u32> =
        if mesh.indices.is_empty() { (0..mesh.vertices()).collect() } else { mesh.indices.clone() };
    for three in indices.as_chunks::<3>().0 {
        if three.iter().any(|index| *index as usize >= corners.len()) {
            continue;
        }
        let polygon = clip_triangle(three, corners);
        for index in 2..polygon.len() {
            let fan = [polygon[0], polygon[index - 1], polygon[index]];
            to.extend(place_fan(fan, three[0], item, corners, state, size));
        }
    }
}

/// The part of a triangle that is between the near and the far plane and has a positive w, as the
/// vertices of a polygon in order.
fn clip_triangle(three: &[u32; 3], corners: &mut Vec<Corner>) -> Vec<u32> {
    // Distances to the planes, negative outside. A corner with w = 0 has no place on the frame, so the
    // last plane keeps away from it; clip spaces with a near plane in front of the eye never reach it.
    // The sides of the frame need no clipping: only its pixels are visited.
    const PLANES: [fn(&[f64; 4]) -> f64; 3] =
        [|clip| clip[2], |clip| clip[3] - clip[2], |clip| clip[3] - 1e-9];
    let mut polygon = three.to_vec();
    for plane in PLANES {
        let distances: Vec<f64> =
            polygon.iter().map(|index| plane(&corners[*index as usize].clip)).collect();
        if distances.iter().all(|distance| *distance >= 0.0) {
            continue;
        }
        let mut kept = Vec::new();
        for here in 0..polygon.len() {
            let next = (here + 1) % polygon.len();
            if distances[here] >= 0.0 {
                kept.push(polygon[here]);
            }
            if (distances[here] >= 0.0) != (distances[next] >= 0.0) {
                let share = distances[here] / (distances[here] - distances[next]);
                let between = corner_between(
                    &corners[polygon[here] as usize],
                    &corners[polygon[next] as usize],
                    share,
                );
                kept.push(corners.len() as u32);
                corners.push(between);
            }
        }
        polygon = kept;
    }
    polygon
}

fn corner_between(a: &Corner, b: &Corner, share: f64) -> Corner {
    let mix = |a: f64, b: f64| a + (b - a) * share;
    Corner {
        clip: std::array::from_fn(|index| mix(a.clip[index], b.clip[index])),
        slots: a
            .slots
            .iter()
            .zip(&b.slots)
            .map(|(a, b)| mix(f64::from(*a), f64::from(*b)) as f32)
            .collect(),
    }
}

fn place_fan(
    fan: [u32; 3],
    first: u32,
    item: usize,
    corners: &[Corner],
    state: PipelineState,
    size: [u32; 2],
) -> Option<Triangle> {
    let [width, height] = size.map(f64::from);
    let points = fan.map(|index| {
        let [x, y, z, w] = corners[index as usize].clip;
        let snapped = |place: f64| (place * SUBPIXELS).round() / SUBPIXELS;
        ScreenPoint {
            x: snapped((0.5 + 0.5 * x / w) * width),
            y: snapped((0.5 - 0.5 * y / w) * height),
            z: z / w,
            inverse_w: 1.0 / w,
        }
    });
    let [a, b, c] = points;
    let area = edge_area(a, b, c.x, c.y);
    if area == 0.0 || !area.is_finite() {
        return None;
    }
    // With y down, a triangle that winds counter-clockwise has a negative area.
    let front = (area < 0.0) != state.mirrored;
    if state.cull == Some(if front { Face::Front } else { Face::Back }) {
        return None;
    }
    let (corners, points) =
        if area < 0.0 { ([fan[0], fan[2], fan[1]], [a, c, b]) } else { (fan, points) };
    Some(Triangle { item, corners, first, front, points, area: area.abs() })
}

/// Twice the signed area of the triangle of a, b and the point (x, y). It is positive if the point
/// is to the right of the line from a to b, with y down.
fn edge_area(a: ScreenPoint, b: ScreenPoint, x: f64, y: f64) -> f64 {
    (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x)
}

fn stored_depth(depth: f64, offset: f64) -> f32 {
    (depth + offset).clamp(0.0, 1.0) as f32
}

/// An edge of a triangle, for the points of many pixels.
struct Edge {
    from: ScreenPoint,
    /// What leads to its end.
    along: [f64; 2],
    /// Whether points on the edge are covered: it is a top or a left edge.
    is_covered: bool,
}

impl Edge {
    fn new(from: ScreenPoint, to: ScreenPoint) -> Self {
        let is_covered = (from.y == to.y && to.x > from.x) || to.y < from.y;
        Self { from, along: [to.x - from.x, to.y - from.y], is_covered }
    }

    /// The part of [`Self::area`] that the points of a row have in common.
    fn row(&self, y: f64) -> f64 {
        self.along[0] * (y - self.from.y)
    }

    /// The same number as that of [`edge_area`].
    fn area(&self, row: f64, x: f64) -> f64 {
        row - self.along[1] * (x - self.from.x)
    }

    fn has_inside(&self, area: f64) -> bool {
        area > 0.0 || area == 0.0 && self.is_covered
    }
}

impl Triangle {
    /// The barycentric coordinates of a point on the frame, linear in screen space.
    fn shares(&self, x: f64, y: f64) -> [f64; 3] {
        let [a, b, c] = self.points;
        [edge_area(b, c, x, y), edge_area(c, a, x, y), edge_area(a, b, x, y)]
            .map(|share| share / self.area)
    }

    /// The barycentric coordinates of a point with perspective correction, the depth there, and
    /// 1/w.
    pub fn at(&self, x: f64, y: f64) -> ([f64; 3], f64, f64) {
        let shares = self.shares(x, y);
        let weighted: [f64; 3] =
            std::array::from_fn(|index| shares[index] * self.points[index].inverse_w);
        let inverse_w = weighted.iter().sum::<f64>();
        (weighted.map(|weight| weight / inverse_w), self.depth_of(shares), inverse_w)
    }

    /// The edges, each opposite to the corner of its number.
    fn edges(&self) -> [Edge; 3] {
        let [a, b, c] = self.points;
        [Edge::new(b, c), Edge::new(c, a), Edge::new(a, b)]
    }

    /// Whether the triangle covers a point. A point on an edge is covered only if that is a top or
    /// a left edge.
    pub fn covers(&self, x: f64, y: f64) -> bool {
        self.edges().iter().all(|edge| edge.has_inside(edge.area(edge.row(y), x)))
    }

    /// The columns and rows of a frame that the triangle may cover.
    pub fn bounds(&self, size: [u32; 2]) -> [Range<u32>; 2] {
        let bounds = |axis: fn(&ScreenPoint) -> f64, size: u32| {
            let places = self.points.iter().map(axis);
            let low =
                places.clone().fold(f64::INFINITY, f64::min).floor().clamp(0.0, f64::from(size));
            let high = places.fold(f64::NEG_INFINITY, f64::max).ceil().clamp(0.0, f64::from(size));
            low as u32..high as u32
        };
        [bounds(|point| point.x, size[0]), bounds(|point| point.y, size[1])]
    }

    /// The depth that is stored for a point, with polygon offset.
    pub fn depth(&self, x: f64, y: f64, offset: f64) -> f32 {
        stored_depth(self.depth_of(self.shares(x, y)), offset)
    }

    /// The depth at a point with these barycentric coordinates.
    fn depth_of(&self, shares: [f64; 3]) -> f64 {
        (0..3).map(|index| shares[index] * self.points[index].z).sum()
    }

    /// What polygon offset adds to the depth of each fragment.
    pub fn offset(&self, [factor, units]: [f32; 2]) -> f64 {
        if factor == 0.0 && units == 0.0 {
            return 0.0;
        }
        let (here, along, down) = (self.at(0.0, 0.0).1, self.at(1.0, 0.0).1, self.at(0.0, 1.0).1);
        let slope = (along - here).abs().max((down - here).abs());
        // The smallest step of a floating-point depth, at the largest depth of the triangle.
        let largest = self.points.iter().map(|point| point.z as f32).fold(0.0, f32::max);
        let step = f64::from(largest).log2().floor().max(-126.0) - 23.0;
        f64::from(factor) * slope + f64::from(units) * step.exp2()
    }
}

impl VisibleTriangles {
    pub fn new(size: [u32; 2]) -> Self {
        let pixels = size[0] as usize * size[1] as usize;
        Self { size, depth: vec![1.0; pixels], triangle: vec![NONE; pixels] }
    }

    /// Draws all triangles in order.
    pub fn draw(&mut self, triangles: &[Triangle], state: PipelineState) {
        for (index, triangle) in triangles.iter().enumerate() {
            self.draw_one(index as u32, triangle, state);
        }
    }

    fn draw_one(&mut self, index: u32, triangle: &Triangle, state: PipelineState) {
        let [columns, rows] = triangle.bounds(self.size);
        let offset = triangle.offset(state.offset);
        let edges = triangle.edges();
        let middle = |at: u32| f64::from(at) + 0.5;
        for y in rows {
            let row = edges.each_ref().map(|edge| edge.row(middle(y)));
            let areas = |x: u32| -> [f64; 3] {
                std::array::from_fn(|index| edges[index].area(row[index], middle(x)))
            };
            let is_covered = |areas: &[f64; 3]| {
                edges.iter().zip(areas).all(|(edge, area)| edge.has_inside(*area))
            };
            // A triangle has no gaps in a row.
            let covered = columns.clone().map(|x| (x, areas(x)));
            let covered = covered.skip_while(|(_, areas)| !is_covered(areas));
            for (x, areas) in covered.take_while(|(_, areas)| is_covered(areas)) {
                let shares = areas.map(|area| area / triangle.area);
                let depth = stored_depth(triangle.depth_of(shares), offset);
                let pixel = (y * self.size[0] + x) as usize;
                if !state.depth_test || depth < self.depth[pixel] {
                    (self.depth[pixel], self.triangle[pixel]) = (depth, index);
                }
            }
        }
    }
}
