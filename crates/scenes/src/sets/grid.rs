//! Fourteen balls: every material of the array, or highlights from dull to sharp.

use glam::DVec3;

use super::palette::{self, INDIGO};
use super::{Eye, Material, Object, Scene, Set, base_scene, placed_at};
use crate::shape::Shape;

/// Balls in a row, and rows.
const COLUMNS: usize = 5;
const BALLS: usize = 14;

/// The entry in the list of all scenes.
pub const SET: Set = Set {
    name: "grid",
    about: "fourteen balls, one for each material of the array; by themselves from dull to sharp",
    make: scene,
};

pub fn scene() -> Scene {
    let ball = Shape::sphere(0.62, (72, 36));
    let object = |index: usize| {
        let (row, column) = (index / COLUMNS, index % COLUMNS);
        // The last row has one ball less.
        let columns = COLUMNS.min(BALLS - row * COLUMNS) as f64;
        let x = 1.4 * (column as f64 - 0.5 * (columns - 1.0));
        let place = placed_at(x, 1.4 * (1.0 - row as f64), 0.0, 0.0);
        let shininess = 4.0 * 1.55_f64.powi(index as i32);
        let roughness = 0.92 - 0.06 * index as f64;
        let own = Material { ambient: INDIGO, diffuse: INDIGO, ..Material::default() };
        let material = Material { roughness, ..own.glossy(0.3).shiny(shininess) };
        Object::new(ball.clone(), place, DVec3::ONE).of(material, index as u32)
    };
    let objects = (0..BALLS).map(object).collect();
    let eye = Eye {
        position: DVec3::new(0.0, 0.5, 13.6),
        target: DVec3::new(0.0, 0.0, 0.0),
        fov_y: 0.4,
        near: 0.5,
        far: 40.0,
    };
    base_scene(objects, eye, palette::over_the_shoulder())
}
