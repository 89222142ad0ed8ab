//! Lamps as they are drawn.

use glam::{DMat4, DVec2, DVec3};

use super::sets::{Lamp, LampKind, LampShape, Material, Object, Scene};
use super::shape::Shape;

impl Scene {
    /// A lamp as it is drawn: a bulb, and for a spot light a shade behind it.
    pub fn bulb(lamp: &Lamp, kind: LampKind) -> Vec<Object> {
        let place = DMat4::from_translation(lamp.position);
        let ball = Shape::sphere(0.11, (24, 12));
        let ball = Object::new(ball, place, glow(lamp)).of(glowing_material(lamp), 7);
        let shade = Object::new(lamp_shade(lamp), place, DVec3::splat(0.16)).of(dark_tin(), 8);
        let parts = [Some(ball), (kind == LampKind::Spot).then_some(shade)];
        parts.into_iter().flatten().map(|part| Object { casts: false, ..part }).collect()
    }

    /// A lamp with an area, as it is drawn. A rectangle has a frame behind it.
    pub fn wide_lamp(&self, lamp: &Lamp, shape: LampShape) -> Vec<Object> {
        let size = self.lamp_size();
        let (right, up) = lamp.sides();
        let patch = |size: DVec2, depth: f64| {
            let (right, up) = (right * size.x, up * size.y);
            Shape::patch(lamp.axis() * depth - right - up, 2.0 * right, 2.0 * up, (1, 1))
        };
        let radius = shape.radius(size);
        let surface = match shape {
            LampShape::Rectangle => patch(size, 0.0),
            LampShape::Sphere => Shape::sphere(radius, (48, 24)),
            LampShape::Tube => {
                let ends = [-size.x - radius, -size.x, size.x, size.x + radius];
                let radii = [0.0, radius, radius, 0.0];
                let points: Vec<_> = ends.iter().map(|x| DVec2::new(*x, 0.0)).zip(radii).collect();
                let turn = glam::DQuat::from_rotation_arc(DVec3::X, right);
                Shape::tube(&points, (24, 48)).transformed(DMat4::from_quat(turn))
            }
        };
        let place = DMat4::from_translation(lamp.position);
        let frame = (shape == LampShape::Rectangle).then(|| {
            let wider = patch(size + DVec2::splat(0.05), -0.01);
            Object::new(wider, place, DVec3::splat(0.16)).of(dark_tin(), 8)
        });
        let glowing = Object::new(surface, place, glow(lamp)).of(glowing_material(lamp), 7);
        let parts = [Some(glowing), frame].into_iter().flatten();
        parts.map(|part| Object { casts: false, ..part }).collect()
    }
}

/// The colour of a lamp, scaled so that its largest channel is 1.
pub(super) fn glow(lamp: &Lamp) -> DVec3 {
    lamp.color / lamp.color.max_element().max(1e-6)
}

pub(super) fn glowing_material(lamp: &Lamp) -> Material {
    Material { emission: glow(lamp) * 1.5, ..Material::default().glossy(0.0) }
}

fn dark_tin() -> Material {
    Material { emission: DVec3::splat(0.015), ..Material::default().glossy(0.1) }
}

/// An open cone along the lamp's axis.
fn lamp_shade(lamp: &Lamp) -> Shape {
    let (rim, depth) = (0.3, 0.34);
    let cone = Shape::surface(28, 1, |u, v| {
        let (sin, cos) = (std::f64::consts::TAU * u).sin_cos();
        let radius = 0.1 + (rim - 0.1) * v;
        DVec3::new(radius * cos, 0.2 - depth * v, radius * sin)
    });
    let turn = glam::DQuat::from_rotation_arc(DVec3::NEG_Y, lamp.axis());
    cone.transformed(DMat4::from_quat(turn))
}
