//! Many small lamps over a floor, each of which lights what is near it.

use std::f64::consts::TAU;

use glam::{DMat4, DVec3};

use super::floor::tiles;
use super::palette::{AMBER, CHALK, CORAL, SLATE, TEAL};
use super::{Eye, Lamp, LampKind, Material, Object, Scene, Set, base_scene, placed_at};
use crate::shape::Shape;

/// The entry in the list of all scenes.
pub const SET: Set = Set {
    name: "fair",
    about: "a floor with balls under sixty small lamps, each of which lights what is near it",
    make: scene,
};

/// Lamps in a row, and rows.
const COLUMNS: usize = 10;
const ROWS: usize = 6;
/// From a lamp to the next one.
const STEP: f64 = 1.3;

/// A place of the grid, on the floor.
fn place(index: usize) -> DVec3 {
    let (column, row) = (index % COLUMNS, index / COLUMNS);
    let x = STEP * (column as f64 - 0.5 * (COLUMNS - 1) as f64);
    DVec3::new(x, 0.0, STEP * (row as f64 - 0.5 * (ROWS - 1) as f64))
}

pub fn scene() -> Scene {
    let glossy = Material { roughness: 0.35, ..Material::default().glossy(0.2).shiny(50.0) };
    let floor = tiles(18, 1.0, [CHALK, SLATE * 1.4], 3);
    let ball = |index: usize| {
        let color = [CORAL, AMBER, TEAL][index % 3];
        let at = place(index) + DVec3::new(0.5 * STEP, 0.28, 0.5 * STEP);
        let shape = Shape::sphere(0.28, (32, 16));
        Object::new(shape, placed_at(at.x, at.y, at.z, 0.0), color).of(glossy, 0)
    };
    let mut objects = vec![Object::new(floor, DMat4::IDENTITY, DVec3::ONE).of(glossy, 7)];
    objects.extend((0..COLUMNS * (ROWS - 1)).filter(|index| index % 3 == 1).map(ball));
    let eye = Eye {
        position: DVec3::new(0.0, 4.6, 10.5),
        target: DVec3::new(0.0, 0.1, 0.6),
        fov_y: 0.6,
        near: 0.5,
        far: 40.0,
    };
    // Lamps that follow each other in this order are far apart, so that the first lamps, however
    // many, are spread evenly.
    let lamp = |order: usize| {
        let index = (order * 23 + 34) % (COLUMNS * ROWS);
        let turn = TAU * 0.618 * index as f64;
        let hue = DVec3::new(turn.cos(), (turn - TAU / 3.0).cos(), (turn + TAU / 3.0).cos());
        let at = place(index);
        Lamp {
            color: (DVec3::splat(0.55) + 0.4 * hue) * 0.9,
            position: at + DVec3::Y * 0.6,
            target: at,
            half_angle: 0.9,
            kind: LampKind::Point,
        }
    };
    let lamps = (0..COLUMNS * ROWS).map(lamp).collect();
    Scene { shows_lamps: true, ..base_scene(objects, eye, lamps) }
}
