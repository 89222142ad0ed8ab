//! Low hills of few triangles, close to a lamp: what shading by face, vertex and fragment makes of
//! them.

use glam::{DMat4, DVec3};

use super::palette;
use super::{Eye, Lamp, LampKind, Material, Object, Scene, Set, base_scene, maps};
use crate::scene::shape::Shape;

/// Quads along each side, and the side, scene units.
const CELLS: u32 = 15;
const SIDE: f64 = 11.0;

/// The scene, for the table of all.
pub const SET: Set = Set {
    name: "hills",
    about: "low hills of few triangles close to a lamp, so that faces and corners can be told apart",
    make: scene,
};

fn hill_height(x: f64, z: f64) -> f64 {
    0.55 * (0.9 * x + 0.4).sin() * (0.8 * z - 0.3).cos() + 0.25 * (0.5 * x - 1.1 * z).sin()
}

/// The scene itself.
pub fn scene() -> Scene {
    let at = |u: f64, v: f64| {
        let (x, z) = (SIDE * (u - 0.5), SIDE * (0.5 - v));
        DVec3::new(x, hill_height(x, z), z)
    };
    let land = Shape::surface(CELLS, CELLS, at);
    let matt = Material::default().glossy(0.3).shiny(30.0);
    let objects = vec![Object::new(land, DMat4::IDENTITY, DVec3::ONE).of(matt, 12)];
    let eye = Eye {
        position: DVec3::new(0.4, 3.4, 6.2),
        target: DVec3::new(0.0, -0.25, 0.2),
        fov_y: 0.56,
        near: 0.5,
        far: 60.0,
    };
    let key = Lamp {
        color: DVec3::splat(1.0),
        position: DVec3::new(-0.6, 2.3, -2.6),
        target: DVec3::new(0.0, 0.0, 0.6),
        half_angle: 0.7,
        kind: LampKind::Point,
    };
    Scene { maps: maps::soil, ..base_scene(objects, eye, palette::lamps(key, 6.0, 4.0, 0.4)) }
}
