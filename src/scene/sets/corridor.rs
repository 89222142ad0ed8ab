//! A long row of columns beside a wall, in the sun: shadows from near to far.

use glam::{DMat4, DVec2, DVec3};

use super::palette::{self, CHALK};
use super::{Eye, Lamp, LampKind, Material, Object, Scene, Set, base_scene, placed_at};
use crate::scene::shape::Shape;

/// Columns of the row, and the distance between them.
const COLUMNS: usize = 14;
const STEP: f64 = 4.0;
/// Half the width of the corridor.
const HALF: f64 = 2.4;

const PROFILE: &[(f64, f64)] = &[
    (0.0, 0.0),
    (0.46, 0.0),
    (0.52, 0.012),
    (0.55, 0.05),
    (0.555, 0.1),
    (0.555, 0.18),
    (0.55, 0.25),
    (0.53, 0.29),
    (0.48, 0.315),
    (0.42, 0.335),
    (0.38, 0.37),
    (0.36, 0.45),
    (0.35, 0.7),
    (0.335, 1.8),
    (0.31, 2.8),
    (0.3, 3.05),
    (0.3, 3.15),
    (0.32, 3.24),
    (0.4, 3.36),
    (0.47, 3.43),
    (0.5, 3.48),
    (0.505, 3.54),
    (0.49, 3.58),
    (0.44, 3.6),
    (0.0, 3.6),
];

/// The scene, for the table of all.
pub const SET: Set = Set {
    name: "corridor",
    about: "a long row of columns beside a wall, in the sun",
    make: scene,
};

/// The scene itself.
pub fn scene() -> Scene {
    let matt = Material::default().glossy(0.05).shiny(20.0);
    let length = STEP * COLUMNS as f64;
    let far = DVec3::NEG_Z * length;
    let floor = Shape::patch(DVec3::new(-HALF - 6.0, 0.0, 4.0), DVec3::X * 14.0, far, (14, 28));
    let wall = Shape::patch(DVec3::new(HALF, 0.0, 4.0 - length), -far, DVec3::Y * 4.4, (28, 4));
    let beam = Shape::cuboid(DVec3::new(0.5, 0.3, 0.5 * length), 1);
    let profile: Vec<DVec2> = PROFILE.iter().map(|(r, h)| DVec2::new(*r, *h)).collect();
    let column = Shape::lathe(&profile, (28, 88));
    let row = (0..COLUMNS).fold(Shape::default(), |row, index| {
        let z = 2.0 - STEP * index as f64;
        row.with(
            column.clone().transformed(DMat4::from_translation(DVec3::new(-HALF, 0.0, z))),
        )
    });
    let objects = vec![
        Object::new(floor, DMat4::IDENTITY, CHALK).of(matt, 7),
        Object::new(wall, DMat4::IDENTITY, CHALK * DVec3::new(1.0, 0.9, 0.8)).of(matt, 7),
        Object::new(beam, placed_at(-HALF, 3.9, 4.0 - 0.5 * length, 0.0), CHALK).of(matt, 7),
        Object::new(row, DMat4::IDENTITY, CHALK).of(matt, 7),
    ];
    let eye = Eye {
        position: DVec3::new(0.9, 1.75, 6.0),
        target: DVec3::new(-0.35, 1.35, 0.0),
        fov_y: 0.75,
        near: 0.3,
        far: 80.0,
    };
    let key = Lamp {
        color: DVec3::new(1.15, 1.02, 0.82),
        position: DVec3::new(-9.0, 9.0, -3.0),
        target: DVec3::new(0.0, 0.0, -4.0),
        half_angle: 0.6,
        kind: LampKind::Directional,
    };
    let mut scene = base_scene(objects, eye, palette::lamps(key, 5.0, 4.0, 0.2));
    scene.ambient = DVec3::new(0.16, 0.19, 0.25);
    scene.haze_range = (10.0, 60.0);
    scene.map_size = Some(512);
    scene
}
