//! A ball on a slope under a low lamp: where shadow maps have acne, or lose contact.

use glam::{DMat4, DVec3};

use super::palette::{self, CHALK, CORAL, TEAL};
use super::{Eye, Lamp, LampKind, Material, Object, Scene, Set, base_scene, placed_at};
use crate::shape::Shape;

/// The slope falls towards +x by this angle, radians.
const ANGLE: f64 = 0.45;

/// The entry in the list of all scenes.
pub const SET: Set = Set {
    name: "slope",
    about: "a ball and a post on a slope under a low lamp, which grazes it",
    make: scene,
};

pub fn scene() -> Scene {
    let matt = Material::default().glossy(0.05).shiny(20.0);
    let turned = DMat4::from_rotation_z(-ANGLE);
    let on_slope = |place: DVec3| turned * DMat4::from_translation(place);
    let half = DVec3::new(6.0, 0.0, 6.0);
    let ground =
        Shape::patch(DVec3::new(-half.x, 0.0, half.z), DVec3::X * 12.0, DVec3::Z * -12.0, (24, 24));
    // Upright and partly in the ground, with an edge towards the lamp, so that no side is grazed.
    let post = Shape::cuboid(DVec3::new(0.16, 0.9, 0.16), 1);
    let post_place = on_slope(DVec3::new(-1.0, 0.0, 1.35)) * turned.inverse();
    let post_place = post_place * placed_at(0.0, 0.3, 0.0, 0.785);
    let objects = vec![
        Object::new(ground, turned, CHALK).of(matt, 7),
        Object::new(Shape::sphere(0.8, (72, 36)), on_slope(DVec3::new(-0.8, 0.8, -0.6)), CORAL)
            .of(matt, 0),
        Object::new(post, post_place, TEAL).of(matt, 9),
    ];
    let eye = Eye {
        position: DVec3::new(1.2, 4.6, 6.8),
        target: DVec3::new(0.45, 0.3, 0.0),
        fov_y: 0.54,
        near: 0.5,
        far: 40.0,
    };
    let key = Lamp {
        color: DVec3::new(1.0, 0.97, 0.9),
        position: DVec3::new(-6.0, 5.0, 0.9),
        target: DVec3::new(0.3, 0.0, 0.0),
        half_angle: 0.48,
        kind: LampKind::Spot,
    };
    let lamps = palette::lamps(key, 4.0, 3.5, 0.25);
    Scene { map_size: Some(512), ..base_scene(objects, eye, lamps) }
}
