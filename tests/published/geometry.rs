//! Which triangle each pixel of a picture shows, and where: found in f64 from the vertices.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DMat4, DVec2, DVec3, DVec4};
use lamplight::execute::frame::{Mesh, VertexFormat};

/// A vertex as the listings read it.
#[derive(Debug, Clone, Copy, Default)]
pub struct Corner {
    pub position: DVec3,
    pub normal: DVec3,
    pub color: DVec3,
    pub uv: DVec2,
    pub light_uv: DVec2,
    pub material: usize,
    pub middle: DVec3,
}

/// What a pixel shows.
#[derive(Debug, Clone, Copy)]
pub struct Hit {
    pub item: usize,
    pub corners: [Corner; 3],
    /// Shares of the corners on the triangle itself, which is what perspective interpolates by.
    pub shares: DVec3,
    /// Whether its corners are seen counter-clockwise.
    pub front: bool,
    depth: f64,
}

/// The vertex of a mesh.
pub fn corner(mesh: &Mesh, index: usize) -> Corner {
    let stride: usize = mesh.attributes.iter().map(|one| one.format.words() as usize).sum();
    let words = mesh.words.get(index * stride..(index + 1) * stride).unwrap_or_default();
    let (mut corner, mut at) = (Corner::default(), 0);
    for attribute in &mesh.attributes {
        let count = attribute.format.words() as usize;
        let part = &words[at..at + count];
        at += count;
        let number =
            |index: usize| part.get(index).map_or(0.0, |word| f64::from(f32::from_bits(*word)));
        let three = DVec3::new(number(0), number(1), number(2));
        match attribute.location {
            0 => corner.position = three,
            1 => corner.normal = three,
            2 => corner.color = three,
            3 => corner.uv = three.truncate(),
            4 => corner.light_uv = three.truncate(),
            7 => corner.middle = three,
            _ if attribute.format == VertexFormat::Uint32 => corner.material = part[0] as usize,
            _ => {}
        }
    }
    corner
}

/// A picture's pixels that are looked for, and what was found so far.
pub struct Pixels {
    size: [u32; 2],
    /// Corners are moved to the nearest of so many steps of a pixel, if the rasterizer does so.
    steps: Option<f64>,
    wanted: BTreeMap<u32, Vec<u32>>,
    pub hits: BTreeMap<[u32; 2], Hit>,
    /// The pixels whose middle is on an edge of a triangle, once corners are moved: which side they
    /// are on is the rasterizer's choice.
    pub on_edges: BTreeSet<[u32; 2]>,
}

impl Pixels {
    pub fn new(size: [u32; 2], steps: Option<f64>, wanted: &[[u32; 2]]) -> Self {
        let mut rows: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        wanted.iter().for_each(|[x, y]| rows.entry(*y).or_default().push(*x));
        Self { size, steps, wanted: rows, hits: BTreeMap::new(), on_edges: BTreeSet::new() }
    }

    /// Adds the triangles of a mesh, seen through a matrix from its space to clip space.
    pub fn add(&mut self, item: usize, mesh: &Mesh, clip_from_object: DMat4) {
        let count = if mesh.indices.is_empty() {
            return;
        } else {
            mesh.indices.len() / 3
        };
        for triangle in 0..count {
            let indices = [0, 1, 2].map(|k| mesh.indices[3 * triangle + k] as usize);
            let corners = indices.map(|index| corner(mesh, index));
            self.add_triangle(item, corners, clip_from_object);
        }
    }

    fn add_triangle(&mut self, item: usize, corners: [Corner; 3], matrix: DMat4) {
        let clip = corners.map(|corner| matrix * corner.position.extend(1.0));
        // None of our scenes has anything behind the viewer that is seen in part.
        if clip.iter().any(|at| at.w <= 1e-6) {
            return;
        }
        let [width, height] = self.size.map(f64::from);
        let place = |at: DVec4| {
            let exact =
                DVec2::new((0.5 + 0.5 * at.x / at.w) * width, (0.5 - 0.5 * at.y / at.w) * height);
            self.steps.map_or(exact, |steps| (exact * steps).round() / steps)
        };
        let places = clip.map(place);
        let low = places[0].min(places[1]).min(places[2]);
        let high = places[0].max(places[1]).max(places[2]);
        let area = (places[1] - places[0]).perp_dot(places[2] - places[0]);
        if area == 0.0 || high.x < 0.0 || high.y < 0.0 || low.x > width || low.y > height {
            return;
        }
        let rows = low.y.max(0.0) as u32..=high.y.min(height) as u32;
        let inside: Vec<[u32; 2]> = self
            .wanted
            .range(rows)
            .flat_map(|(y, row)| row.iter().map(|x| [*x, *y]))
            .filter(|[x, _]| (low.x - 1.0..=high.x + 1.0).contains(&f64::from(*x)))
            .collect();
        for pixel in inside {
            let at = DVec2::new(f64::from(pixel[0]) + 0.5, f64::from(pixel[1]) + 0.5);
            let edge = |a: usize, b: usize| (places[b] - places[a]).perp_dot(at - places[a]) / area;
            let flat = DVec3::new(edge(1, 2), edge(2, 0), edge(0, 1));
            if flat.min_element().abs() < 1e-9 {
                self.on_edges.insert(pixel);
            }
            if flat.min_element() < 0.0 {
                continue;
            }
            self.keep(pixel, item, corners, (clip, flat, area));
        }
    }

    /// Keeps a triangle at a pixel if it is the nearest one so far.
    fn keep(
        &mut self,
        pixel: [u32; 2],
        item: usize,
        corners: [Corner; 3],
        (clip, flat, area): ([DVec4; 3], DVec3, f64),
    ) {
        let over = DVec3::new(flat.x / clip[0].w, flat.y / clip[1].w, flat.z / clip[2].w);
        let depth = flat.x * clip[0].z / clip[0].w
            + flat.y * clip[1].z / clip[1].w
            + flat.z * clip[2].z / clip[2].w;
        if !(0.0..=1.0).contains(&depth) {
            return;
        }
        // Rows are counted from the top, which turns the triangle.
        let hit =
            Hit { item, corners, shares: over / over.element_sum(), front: area < 0.0, depth };
        let nearest = self.hits.get(&pixel).is_none_or(|known| depth < known.depth);
        if nearest {
            self.hits.insert(pixel, hit);
        }
    }
}
