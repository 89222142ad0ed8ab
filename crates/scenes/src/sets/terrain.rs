//! A height field: hills around a valley.

use glam::{DMat4, DVec3};

use super::palette;
use super::{Eye, Lamp, LampKind, Material, Object, Scene, Set, base_scene, maps};
use crate::shape::Shape;

/// Length of each side, scene units.
const SIDE: f64 = 34.0;
/// Quads along each side.
const CELLS: u32 = 190;

/// Hills of several sizes around a valley, in scene units.
pub fn height(x: f64, z: f64) -> f64 {
    // Rounded, since the ridges would otherwise be sharp edges.
    let ridge = 1.0 - ((0.8 * (0.45 * x + 0.9 * (0.3 * z).sin()).sin()).powi(2) + 0.01).sqrt();
    let valley = 1.0 - (-(x - 0.6 * (0.5 * z).sin()).powi(2) / 3.0).exp();
    let bumps = 0.16 * (1.9 * x + 0.7).sin() * (1.7 * z).cos()
        + 0.04 * (3.7 * x + 1.3 * z).sin() * (3.1 * z - 0.4).cos();
    valley * (1.5 * ridge * ridge + 0.4) + bumps
}

/// The entry in the list of all scenes.
pub const SET: Set =
    Set { name: "terrain", about: "a field of heights under a low sun", make: scene };

pub fn scene() -> Scene {
    let eye = Eye {
        position: DVec3::new(1.6, 3.3, 12.5),
        target: DVec3::new(-0.6, 0.75, 2.0),
        fov_y: 0.62,
        near: 0.5,
        far: 60.0,
    };
    let at = |u: f64, v: f64| {
        let (x, z) = (SIDE * (u - 0.5), SIDE * (0.5 - v));
        DVec3::new(x, height(x, z), z)
    };
    let land = Shape::surface(CELLS, CELLS, at).map(|vertex| {
        let (grass, rock, snow) =
            (DVec3::new(0.2, 0.32, 0.1), DVec3::new(0.36, 0.31, 0.26), DVec3::new(0.8, 0.82, 0.86));
        let steep = ((0.93 - vertex.normal.y) * 6.0).clamp(0.0, 1.0);
        let high = ((vertex.position.y - 1.25) * 3.0).clamp(0.0, 1.0);
        vertex.color = grass.lerp(snow, high).lerp(rock, steep);
        vertex.uv *= 34.0;
    });
    let objects = vec![
        Object::new(land, DMat4::IDENTITY, DVec3::ONE)
            .of(Material::default().glossy(0.04).shiny(12.0), 12),
    ];
    let key = Lamp {
        color: DVec3::new(1.25, 1.08, 0.85),
        position: DVec3::new(-8.0, 6.5, 4.5),
        target: DVec3::new(0.0, 0.5, 0.0),
        half_angle: 0.7,
        kind: LampKind::Directional,
    };
    let mut scene = base_scene(objects, eye, palette::lamps(key, 6.0, 4.0, 0.4));
    scene.haze_range = (4.0, 20.0);
    scene.maps = maps::meadow;
    scene
}
