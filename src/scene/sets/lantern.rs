//! Shapes all around a lamp that is seen: each is lit from its own side.

use std::f64::consts::TAU;

use glam::{DMat4, DVec3};

use super::floor::tiles;
use super::palette::{self, AMBER, CHALK, CORAL, INDIGO, LEAF, TEAL};
use super::{Eye, Lamp, LampKind, Material, Object, Scene, Set, base_scene, placed_at};
use crate::scene::shape::Shape;

const COLORS: [DVec3; 8] = [CORAL, AMBER, LEAF, TEAL, INDIGO, CORAL, AMBER, TEAL];

/// The scene, for the table of all.
pub const SET: Set = Set {
    name: "lantern",
    about: "balls and posts on a floor, all around a lamp that is seen",
    make: scene,
};

/// The scene itself.
pub fn scene() -> Scene {
    let floor = tiles(12, 1.3, [CHALK, CHALK * 0.8], 4);
    let matt = Material::default().glossy(0.25).shiny(40.0);
    let around = |(index, color): (usize, &DVec3)| {
        let angle = TAU * (index as f64 + 0.7) / COLORS.len() as f64;
        let reach = if index % 2 == 0 { 2.0 } else { 2.9 };
        let (x, z) = (reach * angle.cos(), reach * angle.sin());
        let (shape, height) = if index % 2 == 0 {
            (Shape::sphere(0.5, (56, 28)), 0.5)
        } else {
            (Shape::cuboid(DVec3::new(0.26, 0.8, 0.26), 1), 0.8)
        };
        Object::new(shape, placed_at(x, height, z, -angle), *color).of(matt, index as u32)
    };
    let mut objects =
        vec![Object::new(floor, DMat4::IDENTITY, DVec3::ONE).of(matt, 7)];
    objects.extend(COLORS.iter().enumerate().map(around));
    let eye = Eye {
        position: DVec3::new(0.0, 6.9, 8.0),
        target: DVec3::new(0.0, 0.2, -0.1),
        fov_y: 0.62,
        near: 0.5,
        far: 40.0,
    };
    let key = Lamp {
        color: DVec3::new(1.0, 0.95, 0.85),
        position: DVec3::new(0.0, 1.35, 0.0),
        target: DVec3::new(1.2, 0.4, 1.6),
        half_angle: 0.9,
        kind: LampKind::Point,
    };
    Scene { shows_lamps: true, ..base_scene(objects, eye, palette::lamps(key, 4.0, 3.0, 0.2)) }
}
