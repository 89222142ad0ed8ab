//! An open, curled sheet.

use glam::{DMat4, DVec3};

use super::palette::{self, CHALK};
use super::{Eye, Lamp, LampKind, Material, Object, Scene, Set, base_scene, placed_at};
use crate::shape::Shape;

/// The entry in the list of all scenes.
pub const SET: Set = Set {
    name: "sheet",
    about: "an open, curled sheet: both of its sides are visible",
    make: scene,
};

pub fn scene() -> Scene {
    let curl = Shape::surface(96, 24, |u, v| {
        // A spiral whose outer end is behind.
        let (turn, radius) = (7.6 * u - 0.35, 0.45 + 1.55 * u);
        DVec3::new(radius * turn.cos(), 2.0 * v - 1.0, -radius * turn.sin())
    });
    let place =
        placed_at(0.0, 0.0, 0.0, 0.15) * DMat4::from_rotation_x(0.55) * DMat4::from_rotation_y(0.8);
    let objects = vec![
        Object::new(curl, place, CHALK * 1.2).of(Material::default().glossy(0.5).shiny(40.0), 9),
    ];
    let eye = Eye {
        position: DVec3::new(0.2, 2.9, 7.8),
        target: DVec3::new(0.0, -0.15, 0.0),
        fov_y: 0.6,
        near: 0.5,
        far: 40.0,
    };
    let key = Lamp {
        color: DVec3::splat(1.0),
        position: DVec3::new(-2.2, 1.0, 6.5),
        target: DVec3::ZERO,
        half_angle: 0.55,
        kind: LampKind::Directional,
    };
    base_scene(objects, eye, palette::lamps(key, 4.5, 2.8, 0.22))
}
