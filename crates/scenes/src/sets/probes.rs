//! White shapes for light from everywhere: what colour they have is the colour of the light.

use glam::{DMat4, DVec3};

use super::palette;
use super::{Eye, Material, Object, Scene, Set, base_scene, placed_at};
use crate::shape::Shape;

const WHITE: DVec3 = DVec3::splat(0.85);

/// The entry in the list of all scenes.
pub const SET: Set = Set {
    name: "probes",
    about: "a white ball, a white box and a white ring: what colour they have is that of the light",
    make: scene,
};

pub fn scene() -> Scene {
    let matt = Material::default().glossy(0.1).shiny(20.0);
    let box_place = placed_at(2.2, -0.25, -0.9, 0.7) * DMat4::from_rotation_x(0.25);
    let ring_place = placed_at(1.5, -0.75, 1.5, 0.5) * DMat4::from_rotation_x(1.1);
    let objects = vec![
        Object::new(Shape::sphere(1.55, (96, 48)), placed_at(-1.1, 0.0, 0.0, 0.0), WHITE)
            .of(matt, 7),
        Object::new(Shape::cuboid(DVec3::splat(0.85), 1), box_place, WHITE).of(matt, 7),
        Object::new(Shape::torus(0.6, 0.22, (80, 32)), ring_place, WHITE).of(matt, 7),
    ];
    let eye = Eye {
        position: DVec3::new(0.3, 1.3, 9.6),
        target: DVec3::new(0.3, -0.1, 0.0),
        fov_y: 0.52,
        near: 0.5,
        far: 40.0,
    };
    Scene { around: Some("dusk"), ..base_scene(objects, eye, palette::over_the_shoulder()) }
}
