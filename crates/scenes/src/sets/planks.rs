//! Planks of rising roughness, each before a lamp that is seen.

use glam::{DMat4, DVec2, DVec3};

use super::palette::CHALK;
use super::{Eye, Lamp, LampKind, Material, Object, Scene, Set, base_scene};
use crate::shape::Shape;

/// The entry in the list of all scenes.
pub const SET: Set = Set {
    name: "planks",
    about: "four planks, rougher to the right, each before a lamp that is seen",
    make: scene,
};

const ROUGHNESS: [f64; 4] = [0.1, 0.25, 0.45, 0.7];
/// The width of a plank, and how far it reaches to the front and to the back.
const WIDTH: f64 = 1.5;
const REACH: f64 = 3.0;
/// The colours of the lamps.
const COLORS: [DVec3; 4] = [
    DVec3::new(1.0, 0.6, 0.26),
    DVec3::new(1.0, 0.4, 0.36),
    DVec3::new(0.36, 0.9, 0.5),
    DVec3::new(0.34, 0.6, 1.0),
];
/// How far the lamps are behind the middle, and how high.
const BEHIND: f64 = 1.4;
const HEIGHT: f64 = 0.62;

pub fn scene() -> Scene {
    let middle = |index: usize| WIDTH * (index as f64 - 1.5);
    let plank = |(index, roughness): (usize, &f64)| {
        let corner = DVec3::new(middle(index) - 0.5 * WIDTH + 0.015, 0.0, REACH);
        let along = DVec3::X * (WIDTH - 0.03);
        let shape = Shape::patch(corner, along, DVec3::NEG_Z * 2.0 * REACH, (6, 24));
        let material =
            Material { roughness: *roughness, specular: DVec3::splat(0.06), ..Material::default() };
        Object::new(shape, DMat4::IDENTITY, CHALK * 0.32).of(material, 7)
    };
    let objects = ROUGHNESS.iter().enumerate().map(plank).collect();
    let eye = Eye {
        position: DVec3::new(0.0, 5.0, 10.4),
        target: DVec3::new(0.0, -0.12, 0.3),
        fov_y: 0.46,
        near: 0.5,
        far: 40.0,
    };
    let lamp = |index: usize| {
        let position = DVec3::new(1.06 * middle(index), HEIGHT, -BEHIND);
        Lamp {
            color: COLORS[index] * 0.075,
            position,
            // The target is at the near end of the plank, so that the range of the lamp goes beyond
            // it.
            target: DVec3::new(position.x, 0.1, REACH),
            half_angle: 1.2,
            kind: LampKind::Point,
        }
    };
    Scene {
        shows_lamps: true,
        lamp_size: Some(DVec2::new(0.46, 0.3)),
        ..base_scene(objects, eye, (0..ROUGHNESS.len()).map(lamp).collect())
    }
}
