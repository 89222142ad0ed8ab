//! Two rooms beside each other, seen from where their front walls were: a lamp shines onto the
//! coloured wall of one, and only an opening at the back leads to the other.

use glam::{DMat4, DVec3};

use super::palette::{self, CHALK, CORAL};
use super::{Eye, Lamp, LampKind, Material, Object, Probes, Scene, Set, base_scene, placed_at};
use crate::shape::Shape;

/// Half of both rooms together.
const HALF: DVec3 = DVec3::new(3.0, 1.4, 2.2);
/// Half of the thickness of the wall between, and where it ends at the back.
const BETWEEN: (f64, f64) = (0.06, -0.9);

/// The entry in the list of all scenes.
pub const SET: Set = Set {
    name: "halls",
    about: "two rooms beside each other, one lit by the light on its coloured wall",
    make: scene,
};

pub fn scene() -> Scene {
    let plaster = Material::default().glossy(0.03);
    let (x, y, z) = (DVec3::X * HALF.x, DVec3::Y * HALF.y, DVec3::Z * HALF.z);
    let walls = [
        (-x - y + z, 2.0 * x, -2.0 * z, CHALK),
        (-x - y - z, 2.0 * x, 2.0 * y, CHALK),
        (-x - y + z, -2.0 * z, 2.0 * y, CORAL),
        (x - y - z, 2.0 * z, 2.0 * y, CHALK),
        (-x + y - z, 2.0 * x, 2.0 * z, CHALK),
    ];
    let mut objects: Vec<Object> = walls
        .into_iter()
        .map(|(corner, along, up, color)| {
            let shape = Shape::patch(corner, along, up, (8, 8));
            Object::new(shape, DMat4::IDENTITY, color).of(plaster, 7)
        })
        .collect();
    let (thickness, back) = BETWEEN;
    let length = 0.5 * (HALF.z - back);
    let between = Shape::cuboid(DVec3::new(thickness, HALF.y, length), 6);
    objects
        .push(Object::new(between, placed_at(0.0, 0.0, back + length, 0.0), CHALK).of(plaster, 7));
    // The end of the wall, cut open towards the viewer, is black, since no probe lights it.
    let cut = Shape::cuboid(DVec3::new(thickness + 0.005, HALF.y, 0.01), 1);
    let cut = Object::new(cut, placed_at(0.0, 0.0, HALF.z + 0.01, 0.0), DVec3::ZERO);
    objects.push(Object { casts: false, ..cut.of(plaster, 7) });
    for (place, turn) in [(-1.3, 0.5), (1.5, 0.5)] {
        let block = Shape::cuboid(DVec3::new(0.4, 0.55, 0.4), 4);
        let at = placed_at(place, 0.55 - HALF.y, 0.2, turn);
        objects.push(Object::new(block, at, CHALK).of(plaster, 7));
    }
    let eye = Eye {
        position: DVec3::new(0.25, 0.35, 8.2),
        target: DVec3::new(0.0, -0.05, 0.0),
        fov_y: 0.58,
        near: 1.0,
        far: 30.0,
    };
    let key = Lamp {
        color: DVec3::new(3.6, 3.4, 3.1),
        position: DVec3::new(-0.7, 1.1, 0.5),
        target: DVec3::new(-3.0, -0.1, -0.1),
        half_angle: 0.55,
        kind: LampKind::Spot,
    };
    Scene {
        probes: Some(Probes { counts: [20, 8, 14], beyond: DVec3::ZERO }),
        ..base_scene(objects, eye, palette::lamps(key, 2.6, 1.2, 0.0))
    }
}
