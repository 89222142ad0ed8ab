//! A ball on a slope under a low lamp: where shadow maps have acne, or lose contact.

use glam::{DMat4, DVec3};

use super::palette::{self, CHALK, CORAL, TEAL};
use super::{Eye, Lamp, LampKind, Material, Object, Scene, Set, base_scene};
use crate::scene::shape::Shape;

/// The slope falls towards +x by this angle, radians.
const ANGLE: f64 = 0.45;

/// The scene, for the table of all.
pub const SET: Set = Set {
    name: "slope",
    about: "a ball and a thin board on a slope under a low lamp, which grazes it",
    make: scene,
};

/// The scene itself.
pub fn scene() -> Scene {
    let matt = Material::default().glossy(0.05).shiny(20.0);
    let turned = DMat4::from_rotation_z(-ANGLE);
    let on_slope = |place: DVec3| turned * DMat4::from_translation(place);
    let half = DVec3::new(6.0, 0.0, 6.0);
    let ground =
        Shape::patch(DVec3::new(-half.x, 0.0, half.z), DVec3::X * 12.0, DVec3::Z * -12.0, (24, 24));
    let board = Shape::cuboid(DVec3::new(0.06, 0.55, 0.9), 1);
    let objects = vec![
        Object::new(ground, turned, CHALK).of(matt, 7),
        Object::new(Shape::sphere(0.8, (72, 36)), on_slope(DVec3::new(-0.7, 0.8, 0.5)), CORAL)
            .of(matt, 0),
        Object::new(board, on_slope(DVec3::new(0.5, 0.55, -1.6)), TEAL).of(matt, 9),
    ];
    let eye = Eye {
        position: DVec3::new(1.2, 4.6, 6.8),
        target: DVec3::new(0.5, -0.05, 0.0),
        fov_y: 0.52,
        near: 0.5,
        far: 40.0,
    };
    let key = Lamp {
        color: DVec3::new(1.0, 0.97, 0.9),
        position: DVec3::new(-6.0, 5.0, 1.8),
        target: DVec3::new(0.3, 0.0, 0.0),
        half_angle: 0.48,
        kind: LampKind::Spot,
    };
    let lamps = palette::lamps(key, 4.0, 3.5, 0.25);
    Scene { map_size: Some(512), ..base_scene(objects, eye, lamps) }
}
