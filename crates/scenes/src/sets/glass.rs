//! Balls of glass before a wall of squares, which shows how they bend light.

use glam::DVec3;

use super::palette;
use super::{Eye, Layers, Material, Object, Scene, Set, base_scene, placed_at};
use crate::shape::Shape;

/// Balls in a row.
const COLUMNS: usize = 4;
/// The distances of the middles of balls.
const STEP: (f64, f64) = (1.5, 1.56);

/// The entry in the list of all scenes.
pub const SET: Set = Set {
    name: "glass",
    about: "two rows of glass balls before squares, clear and rough, with more of each property to the right",
    make: scene,
};

pub fn scene() -> Scene {
    let ball = Shape::sphere(0.68, (96, 48));
    let object = |(row, column): (usize, usize)| {
        let x = STEP.0 * (column as f64 - 0.5 * (COLUMNS - 1) as f64);
        let place = placed_at(x, STEP.1 * (0.5 - row as f64), 0.0, 0.0);
        let share = column as f64 / (COLUMNS - 1) as f64;
        let roughness = if row == 0 { 0.0 } else { 0.12 + 0.36 * share };
        let layers = Some(glass_layers(share));
        let material = Material { roughness, layers, ..Material::default() };
        Object::new(ball.clone(), place, DVec3::new(0.97, 0.98, 1.0)).of(material, column as u32)
    };
    let all = (0..2).flat_map(|row| (0..COLUMNS).map(move |column| (row, column)));
    let eye = Eye {
        position: DVec3::new(0.0, 0.0, 8.2),
        target: DVec3::ZERO,
        fov_y: 0.56,
        near: 0.5,
        far: 40.0,
    };
    let lamps = palette::over_the_shoulder();
    Scene { around: Some("checks"), ..base_scene(all.map(object).collect(), eye, lamps) }
}

/// Glass with a share of each property.
fn glass_layers(share: f64) -> Layers {
    Layers {
        transmission: share,
        thickness: 1.0,
        attenuation_color: DVec3::new(0.28, 0.8, 0.42),
        // From nearly clear to dark.
        attenuation_distance: 8.0 * 0.08_f64.powf(share),
        dispersion: 12.0 * share,
        ..Layers::default()
    }
}
