//! A street at night: a street lamp, a flashlight, the moon, and signs in colours.

use glam::{DMat4, DVec3};

use super::floor::tiles;
use super::palette::{self, AMBER, CHALK, CORAL, SLATE, TEAL};
use super::{Eye, Lamp, LampKind, Material, Object, Scene, Set, base_scene, placed_at};
use crate::shape::Shape;

/// The entry in the list of all scenes.
pub const SET: Set = Set {
    name: "street",
    about: "a street at night, lit by a street lamp, a flashlight, the moon and seven signs",
    make: scene,
};

/// The street lamp, and then the flashlight and the moon.
const LIGHTS: [Lamp; 3] = [
    Lamp {
        color: DVec3::new(1.0, 0.82, 0.5),
        position: DVec3::new(-1.7, 3.0, -0.9),
        target: DVec3::new(-1.7, 0.0, -0.9),
        half_angle: 0.9,
        kind: LampKind::Point,
    },
    Lamp {
        color: DVec3::new(0.95, 0.97, 1.0),
        position: DVec3::new(3.4, 1.3, 3.8),
        target: DVec3::new(0.9, 0.2, -0.4),
        half_angle: 0.22,
        kind: LampKind::Spot,
    },
    Lamp {
        color: DVec3::new(0.5, 0.6, 0.9),
        position: DVec3::new(4.0, 7.0, -2.0),
        target: DVec3::ZERO,
        half_angle: 0.5,
        kind: LampKind::Directional,
    },
];

pub fn scene() -> Scene {
    let floor = tiles(24, 1.0, [SLATE * 1.2, SLATE], 5);
    let glossy = Material::default().glossy(0.3).shiny(60.0);
    let ball = |x: f64, z: f64, color| {
        let ball = Shape::sphere(0.5, (64, 32));
        Object::new(ball, placed_at(x, 0.5, z, 0.0), color).of(glossy, 0)
    };
    let post = Shape::cuboid(DVec3::new(0.4, 0.7, 0.4), 4);
    let objects = vec![
        Object::new(floor, DMat4::IDENTITY, DVec3::ONE).of(glossy, 7),
        ball(0.9, -0.4, CORAL),
        ball(-1.2, 0.9, TEAL),
        ball(2.6, -1.6, CHALK),
        Object::new(post, placed_at(-2.9, 0.7, -1.6, 0.5), AMBER).of(glossy, 1),
    ];
    let eye = Eye {
        position: DVec3::new(0.0, 4.4, 11.2),
        target: DVec3::new(0.0, 0.9, 0.0),
        fov_y: 0.6,
        near: 0.5,
        far: 40.0,
    };
    let signs = palette::lamps(LIGHTS[0], 4.6, 2.2, 0.3).into_iter().skip(LIGHTS.len());
    base_scene(objects, eye, LIGHTS.into_iter().chain(signs).collect())
}
