//! Stones on and beside each other, with gaps, corners and small parts for ambient occlusion.

use glam::{DMat4, DVec2, DVec3};

use super::palette::{self, AMBER, CHALK, SLATE};
use super::{Eye, Lamp, LampKind, Material, Object, Scene, Set, base_scene, placed_at};
use crate::maps::random_at;
use crate::shape::Shape;

/// The entry in the list of all scenes.
pub const SET: Set = Set {
    name: "masonry",
    about: "a wall of loose stones, steps, a column and pebbles under a low lamp",
    make: scene,
};

/// Stones in a row of the wall, and rows.
const STONES: u32 = 6;
const ROWS: u32 = 4;
/// Half of the sides of a stone.
const HALF: DVec3 = DVec3::new(0.4, 0.22, 0.3);
/// Pebbles on the ground. Those that would overlap an earlier one are left out.
const PEBBLES: u32 = 90;

/// A random number in [-1, 1), by the index of a thing and by what varies.
fn varied(index: u32, what: u32) -> f64 {
    2.0 * random_at(index, what, 7) - 1.0
}

/// A stone of the wall. Its rows are shifted, and no two stones are alike.
fn wall_stone(index: u32) -> Object {
    let (row, column) = (index / STONES, index % STONES);
    let shift = if row.is_multiple_of(2) { 0.0 } else { 0.42 };
    let x = 0.86 * f64::from(column) - 2.5 + shift + 0.03 * varied(index, 0);
    let y = HALF.y + 0.46 * f64::from(row);
    let place = placed_at(x, y, -1.5 + 0.06 * varied(index, 1), 0.06 * varied(index, 2));
    let shape = Shape::cuboid(HALF * (0.97 + 0.03 * varied(index, 3)), 1);
    let color = CHALK * (0.82 + 0.12 * varied(index, 4));
    Object::new(shape, place, color).of(stone(), 7)
}

/// A pebble that may lie on the ground: the place of its middle, and its radius.
fn pebble(index: u32) -> (DVec2, f64) {
    let place = DVec2::new(3.4 * varied(index, 5), 1.25 + 1.15 * varied(index, 6));
    (place, 0.1 + 0.06 * varied(index, 7))
}

/// Whether the pebble would overlap an earlier one.
fn is_taken(index: u32) -> bool {
    let (place, radius) = pebble(index);
    (0..index).map(pebble).any(|(other, size)| place.distance(other) < 1.4 * (radius + size))
}

/// A pebble on the ground, flat and turned.
fn small_stone(index: u32) -> Object {
    let (at, radius) = pebble(index);
    let size = DVec3::new(1.3, 0.75, 1.0) * radius;
    let place = placed_at(at.x, 0.8 * size.y, at.y, 3.0 * varied(index, 8));
    let place = place * DMat4::from_scale(size);
    let color = CHALK.lerp(AMBER * 0.7, 0.25 + 0.25 * varied(index, 9));
    Object::new(Shape::sphere(1.0, (24, 12)), place, color).of(stone(), 7)
}

fn stone() -> Material {
    Material::default().glossy(0.04).shiny(16.0)
}

/// A column between two square slabs, with a ring at its foot.
fn column_parts() -> [Object; 4] {
    let at = |height: f64| placed_at(2.25, height, -0.35, 0.35);
    let shaft = [(0.3, 0.0), (0.27, 0.4), (0.26, 1.2), (0.25, 1.7)].map(|(r, y)| DVec2::new(r, y));
    [
        Object::new(Shape::cuboid(DVec3::new(0.52, 0.12, 0.52), 1), at(0.12), CHALK),
        Object::new(Shape::torus(0.34, 0.1, (56, 20)), at(0.34), CHALK),
        Object::new(Shape::lathe(&shaft, (56, 24)), at(0.34), CHALK),
        Object::new(Shape::cuboid(DVec3::new(0.36, 0.07, 0.36), 1), at(2.09), CHALK),
    ]
    .map(|part| part.of(stone(), 7))
}

pub fn scene() -> Scene {
    let half = DVec3::new(8.0, 0.0, 6.0);
    let ground =
        Shape::patch(DVec3::new(-half.x, 0.0, half.z), DVec3::X * 16.0, DVec3::Z * -12.0, (16, 12));
    let mut objects =
        vec![Object::new(ground, DMat4::IDENTITY, CHALK.lerp(SLATE, 0.3)).of(stone(), 7)];
    objects.extend((0..ROWS * STONES).map(wall_stone));
    let step = |index: u32| {
        let high = 0.17 * f64::from(3 - index);
        let shape = Shape::cuboid(DVec3::new(0.75, high, 0.2), 1);
        let place = placed_at(-2.0, high, -1.0 + 0.4 * f64::from(index), 0.0);
        Object::new(shape, place, CHALK * 1.05).of(stone(), 7)
    };
    objects.extend((0..3).map(step));
    objects.extend(column_parts());
    objects.extend((0..PEBBLES).filter(|index| !is_taken(*index)).map(small_stone));
    let eye = Eye {
        position: DVec3::new(0.9, 3.0, 6.6),
        target: DVec3::new(0.05, 0.55, -0.2),
        fov_y: 0.56,
        near: 0.5,
        far: 40.0,
    };
    let key = Lamp {
        color: DVec3::new(1.0, 0.95, 0.86),
        position: DVec3::new(-5.2, 3.2, 3.4),
        target: DVec3::new(0.2, 0.2, 0.0),
        half_angle: 0.55,
        kind: LampKind::Spot,
    };
    base_scene(objects, eye, palette::lamps(key, 3.6, 3.0, 0.2))
}
