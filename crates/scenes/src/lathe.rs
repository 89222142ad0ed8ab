//! Surfaces of revolution: profiles of lines and arcs, whose corners stay sharp.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use super::shape::Shape;

/// Radius, height, and the bulge of what leads to this point from the one before: the tangent of a
/// quarter of the arc's angle, above 0 for an arc that is convex, 0 for a line.
pub type Turn = (f64, f64, f64);

/// An arc takes one row of quads for each angle of this size.
const ANGLE: f64 = PI / 9.0;

/// A line or an arc of a profile.
#[derive(Debug, Clone, Copy)]
pub struct Arc {
    from: DVec2,
    /// The direction in which it begins, of unit length.
    ahead: DVec2,
    /// The distance between its ends.
    chord: f64,
    angle: f64,
}

impl Arc {
    fn new((r, h, _): Turn, (next_r, next_h, bulge): Turn) -> Self {
        let from = DVec2::new(r, h);
        let chord = DVec2::new(next_r, next_h) - from;
        let along = chord.normalize_or(DVec2::Y);
        let outwards = DVec2::new(along.y, -along.x);
        let (sin, cos) = (2.0 * bulge.atan()).sin_cos();
        let ahead = along * cos + outwards * sin;
        Self { from, ahead, chord: chord.length(), angle: 4.0 * bulge.atan() }
    }

    /// The point after a share of the length.
    pub fn point(&self, share: f64) -> DVec2 {
        let inwards = DVec2::new(-self.ahead.y, self.ahead.x);
        if self.angle.abs() < 1e-6 {
            return self.from + self.ahead * (self.chord * share);
        }
        let radius = 0.5 * self.chord / (0.5 * self.angle).sin();
        let (sin, cos) = (self.angle * share).sin_cos();
        self.from + (self.ahead * sin + inwards * (1.0 - cos)) * radius
    }

    /// How many rows of quads it takes.
    fn rows(&self) -> u32 {
        (self.angle.abs() / ANGLE).ceil().max(1.0) as u32
    }
}

/// The lines and arcs of a profile, from the bottom up.
pub fn profile_arcs(profile: &[Turn]) -> impl Iterator<Item = Arc> {
    profile.windows(2).filter_map(|pair| match pair {
        [from, to] => Some(Arc::new(*from, *to)),
        _ => None,
    })
}

/// A profile rotated around the y axis, of `around` quads in each row.
pub fn turned_shape(profile: &[Turn], around: u32) -> Shape {
    waved_shape(profile, around, |_, _| 0.0)
}

/// A turned shape whose points are raised by a function of the share of the way around, and of the
/// point of the profile.
pub fn waved_shape(profile: &[Turn], around: u32, raised: impl Fn(f64, DVec2) -> f64) -> Shape {
    profile_arcs(profile).fold(Shape::default(), |shape, arc| {
        shape.with(Shape::surface(around, arc.rows(), |u, v| {
            let point = arc.point(v);
            let (sin, cos) = (TAU * u).sin_cos();
            let radius = point.x.max(0.0);
            DVec3::new(radius * cos, point.y + raised(u, point), -radius * sin)
        }))
    })
}

/// A profile along the four sides of a square, mitred at the corners. The radius is half of the
/// side.
pub fn framed_shape(profile: &[Turn]) -> Shape {
    let side = |turn: u32| {
        let matrix = glam::DMat4::from_rotation_y(0.5 * PI * f64::from(turn));
        let arcs = profile_arcs(profile).fold(Shape::default(), |shape, arc| {
            shape.with(Shape::surface(1, arc.rows(), |u, v| {
                let point = arc.point(v);
                DVec3::new(point.x * (2.0 * u - 1.0), point.y, point.x)
            }))
        });
        arcs.transformed(matrix)
    };
    (0..4).fold(Shape::default(), |shape, turn| shape.with(side(turn)))
}
