//! Lamps close to a wall, on which the distribution of their light is seen.

use glam::{DMat4, DVec3};

use super::palette::{CHALK, CORAL, SLATE, TEAL};
use super::{Eye, Lamp, LampKind, Material, Object, Scene, Set, base_scene, placed_at};
use crate::shape::Shape;

/// The entry in the list of all scenes.
pub const SET: Set = Set {
    name: "wall",
    about: "a wall behind a floor with two balls, and three lamps close to it",
    make: scene,
};

const HEIGHT: f64 = 3.0;
/// From a lamp to the next one, and from the lamps to the wall.
const STEP: f64 = 2.5;
const BEFORE: f64 = 1.5;

pub fn scene() -> Scene {
    let matt = Material::default().glossy(0.06).shiny(20.0);
    let plane = |corner: DVec3, along: DVec3, up: DVec3, color| {
        let shape = Shape::patch(corner, along, up, (24, 16));
        Object::new(shape, DMat4::IDENTITY, color).of(matt, 7)
    };
    let ball = |x: f64, color| {
        Object::new(Shape::sphere(0.4, (64, 32)), placed_at(x, 0.4, 0.7, 0.0), color).of(matt, 0)
    };
    let corner = DVec3::new(-4.5, 0.0, 0.0);
    let objects = vec![
        plane(corner, DVec3::X * 9.0, DVec3::Y * 4.6, CHALK),
        plane(corner + DVec3::Z * 5.0, DVec3::X * 9.0, DVec3::NEG_Z * 5.0, SLATE * 1.6),
        ball(-STEP, CORAL),
        ball(STEP, TEAL),
    ];
    let eye = Eye {
        position: DVec3::new(0.0, 2.6, 10.0),
        target: DVec3::new(0.0, 1.75, 0.0),
        fov_y: 0.5,
        near: 0.5,
        far: 40.0,
    };
    let lamp = |index: usize| {
        let x = STEP * (index as f64 - 1.0);
        let warm = DVec3::new(1.0, 0.84, 0.62).lerp(DVec3::new(0.8, 0.9, 1.0), index as f64 / 2.0);
        Lamp {
            color: warm * 1.1,
            position: DVec3::new(x, HEIGHT, BEFORE),
            target: DVec3::new(x, 1.2, 0.0),
            half_angle: 0.42,
            kind: LampKind::Spot,
        }
    };
    let ambient = DVec3::new(0.012, 0.013, 0.016);
    Scene { shows_lamps: true, ambient, ..base_scene(objects, eye, (0..3).map(lamp).collect()) }
}
