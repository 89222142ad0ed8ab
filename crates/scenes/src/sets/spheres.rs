//! A row of spheres of rising shininess. As glTF surfaces, they are more metallic from ball to
//! ball.

use glam::DVec3;

use super::palette::{self, AMBER, CORAL, INDIGO, LEAF, TEAL};
use super::{Eye, Layers, Material, Object, Scene, Set, base_scene, placed_at};
use crate::shape::Shape;

const COLORS: [DVec3; 5] = [CORAL, AMBER, LEAF, TEAL, INDIGO];

/// The entry in the list of all scenes.
pub const SET: Set = Set {
    name: "spheres",
    about: "a row of spheres of rising shininess before the viewer",
    make: scene,
};

pub fn scene() -> Scene {
    let ball = Shape::sphere(0.95, (48, 24));
    let object = |(index, color): (usize, &DVec3)| {
        // Away from the viewer and upwards, from the left to the right.
        let step = index as f64 - 2.0;
        let place = placed_at(1.38 * step, 0.57 * step, -1.1 * step, 0.0);
        let material = Material::default().glossy(0.55).shiny(16.0 * 2.2_f64.powi(index as i32));
        let metallic = index as f64 / (COLORS.len() - 1) as f64;
        let layers = Some(Layers { metallic, ..Layers::default() });
        let material = Material { layers, ..material };
        Object::new(ball.clone(), place, *color).of(material, index as u32)
    };
    let objects = COLORS.iter().enumerate().map(object).collect();
    let eye = Eye {
        position: DVec3::new(-0.6, 0.6, 12.4),
        target: DVec3::new(-0.5, -0.1, 0.0),
        fov_y: 0.63,
        near: 0.5,
        far: 40.0,
    };
    base_scene(objects, eye, palette::over_the_shoulder())
}
