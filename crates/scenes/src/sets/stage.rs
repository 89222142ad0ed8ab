//! A floor with balls on it, under lamps that are seen.

use glam::{DMat4, DVec3};

use super::floor::tiles;
use super::palette::{self, CHALK, CORAL, SLATE, TEAL};
use super::{Eye, Lamp, LampKind, Material, Object, Scene, Set, base_scene, placed_at};
use crate::shape::Shape;

/// The entry in the list of all scenes.
pub const SET: Set =
    Set { name: "stage", about: "a floor with two balls under lamps that are seen", make: scene };

pub fn scene() -> Scene {
    let floor = tiles(24, 1.0, [CHALK, SLATE * 1.4], 5);
    let glossy = Material::default().glossy(0.3).shiny(60.0);
    let ball = |x: f64, z: f64, color| {
        Object::new(Shape::sphere(0.45, (64, 32)), placed_at(x, 0.45, z, 0.0), color).of(glossy, 0)
    };
    let objects = vec![
        Object::new(floor, DMat4::IDENTITY, DVec3::ONE).of(glossy, 7),
        ball(1.25, -0.35, CORAL),
        ball(-1.2, 0.5, TEAL),
    ];
    let eye = Eye {
        position: DVec3::new(0.0, 4.1, 12.2),
        target: DVec3::new(0.0, 1.4, 0.0),
        fov_y: 0.62,
        near: 0.5,
        far: 40.0,
    };
    let key = Lamp {
        color: DVec3::new(1.0, 0.96, 0.88),
        position: DVec3::new(-0.5, 4.3, -0.5),
        target: DVec3::new(0.0, 0.0, 0.4),
        half_angle: 0.5,
        kind: LampKind::Spot,
    };
    let lamps = palette::lamps(key, 3.4, 3.6, 0.55);
    Scene { shows_lamps: true, ..base_scene(objects, eye, lamps) }
}
