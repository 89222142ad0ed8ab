//! Triangle meshes made by formulas.

use std::f64::consts::{PI, TAU};

use glam::{DMat4, DVec2, DVec3, DVec4};

use lamplight_scene::{face_normals, normal_matrix};

/// A vertex, with everything that `forward` may read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vertex {
    /// In object space.
    pub position: DVec3,
    /// Of unit length.
    pub normal: DVec3,
    /// Linear, multiplied with the colour of the object.
    pub color: DVec3,
    /// Multiplied with the alpha of the object.
    pub alpha: f64,
    /// Coordinates of textures that repeat.
    pub uv: DVec2,
    /// Coordinates in the lightmap, [0, 1].
    pub light_uv: DVec2,
    /// The direction of u, of unit length; w is the sign of the bitangent.
    pub tangent: DVec4,
}

/// Indexed triangles. Front faces wind counter-clockwise.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Shape {
    /// Corners.
    pub vertices: Vec<Vertex>,
    /// Three for each triangle.
    pub indices: Vec<u32>,
}

impl Shape {
    /// A surface over the unit square, of `columns` by `rows` quads. Its front faces along the
    /// cross product of the directions of u and v.
    pub fn surface(columns: u32, rows: u32, at: impl Fn(f64, f64) -> DVec3) -> Self {
        let mut shape = Self::default();
        for row in 0..=rows {
            for column in 0..=columns {
                let (u, v) = (
                    f64::from(column) / f64::from(columns.max(1)),
                    f64::from(row) / f64::from(rows.max(1)),
                );
                shape.vertices.push(surface_vertex(&at, u, v));
            }
        }
        for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)))
        {
            let corner = |x: u32, y: u32| (row + y) * (columns + 1) + column + x;
            shape.indices.extend([
                corner(0, 0),
                corner(1, 0),
                corner(1, 1),
                corner(0, 0),
                corner(1, 1),
                corner(0, 1),
            ]);
        }
        shape
    }

    /// A flat parallelogram from a corner along two edges, of `quads.0` by `quads.1` quads.
    pub fn patch(corner: DVec3, along: DVec3, up: DVec3, quads: (u32, u32)) -> Self {
        Self::surface(quads.0, quads.1, |u, v| corner + along * u + up * v)
    }

    /// A ball around the origin.
    pub fn sphere(radius: f64, quads: (u32, u32)) -> Self {
        Self::surface(quads.0, quads.1, |u, v| {
            let (ring, height) = ((PI * v).sin(), -(PI * v).cos());
            point_around(u, ring) * radius + DVec3::Y * height * radius
        })
    }

    /// A ring around the y axis, `thickness` the radius of its tube.
    pub fn torus(radius: f64, thickness: f64, quads: (u32, u32)) -> Self {
        Self::surface(quads.0, quads.1, |u, v| {
            let (sin, cos) = (TAU * v).sin_cos();
            point_around(u, radius + thickness * cos) + DVec3::Y * thickness * sin
        })
    }

    /// A box around the origin, seen from outside, each face of `quads` by `quads`.
    pub fn cuboid(half: DVec3, quads: u32) -> Self {
        let faces = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z].map(
            |normal| {
                let along = if normal.y == 0.0 { DVec3::Y.cross(normal) } else { DVec3::X };
                let up = normal.cross(along);
                Self::patch(
                    (normal - along - up) * half,
                    along * half * 2.0,
                    up * half * 2.0,
                    (quads, quads),
                )
            },
        );
        faces.into_iter().fold(Self::default(), Self::with)
    }

    /// A profile, given by radius and height from the bottom up, rotated around the y axis. It is
    /// smooth between its points.
    pub fn lathe(profile: &[DVec2], quads: (u32, u32)) -> Self {
        Self::surface(quads.0, quads.1, |u, v| {
            let point = smooth_curve(profile, v);
            point_around(u, point.x.max(0.0)) + DVec3::Y * point.y
        })
    }

    /// A tube in the plane of x and y along a line through `points`, each with its radius.
    pub fn tube(points: &[(DVec2, f64)], quads: (u32, u32)) -> Self {
        let line: Vec<DVec2> = points.iter().map(|(point, _)| *point).collect();
        let radii: Vec<DVec2> = points.iter().map(|(_, radius)| DVec2::new(*radius, 0.0)).collect();
        Self::surface(quads.0, quads.1, |u, v| {
            let ahead = (smooth_curve(&line, (v + 1e-3).min(1.0))
                - smooth_curve(&line, (v - 1e-3).max(0.0)))
            .normalize_or_zero();
            let (sin, cos) = (TAU * u).sin_cos();
            let side = (DVec3::new(-ahead.y, ahead.x, 0.0) * cos + DVec3::Z * sin)
                * smooth_curve(&radii, v).x.max(0.0);
            smooth_curve(&line, v).extend(0.0) + side
        })
    }

    /// Both shapes as one.
    #[must_use]
    pub fn with(mut self, other: Self) -> Self {
        let first = self.vertices.len() as u32;
        self.indices.extend(other.indices.iter().map(|index| index + first));
        self.vertices.extend(other.vertices);
        self
    }

    /// The shape with every corner changed.
    #[must_use]
    pub fn map(mut self, change: impl Fn(&mut Vertex)) -> Self {
        self.vertices.iter_mut().for_each(change);
        self
    }

    /// The shape moved, turned, scaled or mirrored by a matrix.
    #[must_use]
    pub fn transformed(self, matrix: DMat4) -> Self {
        let normals = normal_matrix(matrix);
        // What mirrors turns cross products, of which the bitangent is one.
        let side = if matrix.determinant() < 0.0 { -1.0 } else { 1.0 };
        self.map(|vertex| {
            vertex.position = matrix.transform_point3(vertex.position);
            vertex.normal = (normals * vertex.normal).normalize_or_zero();
            vertex.tangent = matrix
                .transform_vector3(vertex.tangent.truncate())
                .normalize_or_zero()
                .extend(side * vertex.tangent.w);
        })
    }

    /// The shape with its textures repeated `times` along u and v.
    #[must_use]
    pub fn tiled(self, times: DVec2) -> Self {
        self.map(|vertex| vertex.uv *= times)
    }

    /// Gives each triangle three vertices of its own, with the normal of its face. This is for
    /// shading that uses the normal of one vertex for the whole triangle.
    #[must_use]
    pub fn faceted(&self) -> Self {
        let positions: Vec<DVec3> = self.vertices.iter().map(|vertex| vertex.position).collect();
        // With indices out of range, there are no faces.
        let normals = face_normals(&positions, Some(&self.indices)).unwrap_or_default();
        let corners = normals.iter().zip(self.indices.chunks(3));
        let vertices: Vec<Vertex> = corners
            .flat_map(|(normal, corners)| {
                corners
                    .iter()
                    .map(|index| Vertex { normal: *normal, ..self.vertices[*index as usize] })
            })
            .collect();
        let indices = (0..vertices.len() as u32).collect();
        Self { vertices, indices }
    }
}

/// A point on the circle around the y axis, after a share `u` of the way around.
fn point_around(u: f64, radius: f64) -> DVec3 {
    let (sin, cos) = (TAU * u).sin_cos();
    DVec3::new(radius * cos, 0.0, -radius * sin)
}

/// A vertex of a surface. Its normal and tangent are from central differences.
fn surface_vertex(at: &impl Fn(f64, f64) -> DVec3, u: f64, v: f64) -> Vertex {
    const STEP: f64 = 1e-4;
    // The differences are taken a little away from the edges, since the surface may shrink to a
    // point there.
    let inside = |x: f64| x.clamp(2.0 * STEP, 1.0 - 2.0 * STEP);
    let (s, t) = (inside(u), inside(v));
    let along = at(s + STEP, t) - at(s - STEP, t);
    let up = at(s, t + STEP) - at(s, t - STEP);
    Vertex {
        position: at(u, v),
        normal: along.cross(up).normalize_or_zero(),
        color: DVec3::ONE,
        alpha: 1.0,
        uv: DVec2::new(u, v),
        light_uv: DVec2::new(u, v),
        tangent: along.normalize_or_zero().extend(1.0),
    }
}

/// A Catmull-Rom spline through points, which are at even steps of `at` from 0 to 1.
fn smooth_curve(points: &[DVec2], at: f64) -> DVec2 {
    let Some(last) = points.len().checked_sub(1) else { return DVec2::ZERO };
    let place = at.clamp(0.0, 1.0) * last as f64;
    let first = (place as usize).min(last.saturating_sub(1));
    let t = place - first as f64;
    let point = |index: isize| points[(first as isize + index).clamp(0, last as isize) as usize];
    let (a, b, c, d) = (point(-1), point(0), point(1), point(2));
    0.5 * (2.0 * b
        + (c - a) * t
        + (2.0 * a - 5.0 * b + 4.0 * c - d) * t * t
        + (3.0 * b - a - 3.0 * c + d) * t * t * t)
}
