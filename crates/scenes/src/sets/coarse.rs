//! Shapes of few triangles close to the viewer, which show whether light is computed by face,
//! vertex or fragment.

use glam::{DMat4, DVec3};

use super::palette::{self, AMBER, TEAL};
use super::{Eye, Lamp, LampKind, Material, Object, Scene, Set, base_scene, placed_at};
use crate::shape::Shape;

/// The entry in the list of all scenes.
pub const SET: Set = Set {
    name: "coarse",
    about: "a ball and a ring of few triangles, close to the viewer and to a lamp",
    make: scene,
};

pub fn scene() -> Scene {
    let glossy = Material::default().glossy(0.7).shiny(48.0);
    let ring = placed_at(1.9, -0.5, 0.3, -0.5) * DMat4::from_rotation_x(0.9);
    let objects = vec![
        Object::new(Shape::sphere(1.6, (12, 7)), placed_at(-1.1, 0.1, 0.0, 0.2), TEAL)
            .of(glossy, 9),
        Object::new(Shape::torus(0.95, 0.36, (20, 12)), ring, AMBER).of(glossy, 1),
    ];
    let eye = Eye {
        position: DVec3::new(0.25, 1.0, 8.7),
        target: DVec3::new(0.3, -0.05, 0.0),
        fov_y: 0.56,
        near: 0.5,
        far: 40.0,
    };
    let key = Lamp {
        color: DVec3::splat(1.0),
        position: DVec3::new(-1.3, 2.5, 4.2),
        target: DVec3::new(0.0, 0.0, 0.4),
        half_angle: 0.6,
        kind: LampKind::Point,
    };
    base_scene(objects, eye, palette::lamps(key, 5.0, 4.0, 0.22))
}
