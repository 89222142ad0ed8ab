//! Balls with every layer of glTF: none on the left, all of it on the right.

use glam::{DMat4, DVec3};

use super::palette::{self, AMBER, TEAL};
use super::{Eye, Layers, Material, Object, Scene, Set, base_scene, placed_at};
use crate::shape::Shape;

/// Balls in a row. A permutation shows the layers that it has.
const COLUMNS: usize = 5;
/// The colour and the roughness of each row.
const ROWS: [(DVec3, f64); 2] = [(AMBER, 0.18), (TEAL, 0.5)];

/// How rough the sheen of each row is.
const SHEEN_ROUGHNESS: [f64; 2] = [0.28, 0.6];

/// The entry in the list of all scenes.
pub const SET: Set = Set {
    name: "layers",
    about: "two rows of balls, smooth and rough, with more of each layer of glTF to the right",
    make: scene,
};

pub fn scene() -> Scene {
    let ball = Shape::sphere(0.66, (96, 48));
    let object = |(row, column): (usize, usize)| {
        let x = 1.42 * (column as f64 - 0.5 * (COLUMNS - 1) as f64);
        // Tilted, so that the upper pole, where tangents converge, is on the far side.
        let tilt = DMat4::from_rotation_x(-0.3);
        let place = placed_at(x, 0.74 - 1.48 * row as f64, 0.0, 0.0) * tilt;
        let (color, roughness) = ROWS[row];
        let sheen_roughness = SHEEN_ROUGHNESS[row];
        let share = column as f64 / (COLUMNS - 1) as f64;
        let layers = Some(Layers { sheen_roughness, ..all_layers(share) });
        let material = Material { roughness, layers, ..Material::default() };
        Object::new(ball.clone(), place, color).of(material, column as u32)
    };
    let all = (0..ROWS.len()).flat_map(|row| (0..COLUMNS).map(move |column| (row, column)));
    let eye = Eye {
        position: DVec3::new(0.0, 0.6, 13.0),
        target: DVec3::ZERO,
        fov_y: 0.42,
        near: 0.5,
        far: 40.0,
    };
    base_scene(all.map(object).collect(), eye, palette::over_the_shoulder())
}

/// A share of every layer. The film also becomes thicker, since that shows more than its strength.
fn all_layers(share: f64) -> Layers {
    Layers {
        clearcoat: share,
        clearcoat_roughness: 0.1,
        sheen_color: DVec3::new(0.85, 0.88, 1.0) * share,
        anisotropy: 0.85 * share,
        iridescence: share.min(0.25) * 4.0,
        iridescence_thickness: 180.0 + 320.0 * share,
        transmission: share,
        thickness: 1.0,
        attenuation_color: DVec3::new(0.75, 0.92, 0.85),
        attenuation_distance: 1.0,
        dispersion: 8.0 * share,
        diffuse_transmission: share,
        diffuse_transmission_color: DVec3::new(0.55, 0.85, 0.2),
        ..Layers::default()
    }
}
