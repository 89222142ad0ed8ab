//! A sphere, a box and a torus over a floor.

use glam::{DMat4, DVec3};

use super::floor::tiles;
use super::palette::{self, AMBER, CHALK, CORAL, TEAL};
use super::{Eye, Lamp, LampKind, Material, Object, Scene, Set, base_scene, placed_at};
use crate::shape::Shape;

/// The entry in the list of all scenes.
pub const SET: Set = Set {
    name: "casters",
    about: "a sphere, a box and a torus over a floor that their shadows fall on",
    make: scene,
};

/// Which of the objects is the floor.
pub const FLOOR: usize = 0;

pub fn scene() -> Scene {
    let floor = tiles(10, 1.4, [CHALK, CHALK * 0.8], 2);
    let matt = Material::default().glossy(0.08).shiny(20.0);
    let glossy = Material::default().glossy(0.4).shiny(60.0);
    let ring = placed_at(0.1, 1.0, 1.9, 0.5) * DMat4::from_rotation_x(1.25);
    let objects = vec![
        Object::new(floor, DMat4::IDENTITY, DVec3::ONE).of(matt, 7),
        Object::new(Shape::sphere(1.0, (48, 24)), placed_at(-2.0, 1.0, -0.5, 0.0), CORAL)
            .of(glossy, 0),
        Object::new(
            Shape::cuboid(DVec3::new(0.75, 1.1, 0.75), 1),
            placed_at(1.8, 1.1, -0.5, 0.5),
            TEAL,
        )
        .of(matt, 9),
        Object::new(Shape::torus(0.75, 0.24, (56, 24)), ring, AMBER).of(glossy, 1),
    ];
    let eye = Eye {
        position: DVec3::new(0.7, 6.2, 9.8),
        target: DVec3::new(-0.05, 0.6, 0.1),
        fov_y: 0.6,
        near: 0.5,
        far: 40.0,
    };
    let key = Lamp {
        color: DVec3::new(1.0, 0.97, 0.9),
        position: DVec3::new(-4.6, 7.2, 2.6),
        target: DVec3::new(0.0, 0.4, 0.1),
        half_angle: 0.46,
        kind: LampKind::Spot,
    };
    base_scene(objects, eye, palette::lamps(key, 4.0, 3.5, 0.25))
}
