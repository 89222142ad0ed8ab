//! A tessellated floor with a light above it.

use glam::DVec3;

use super::palette::{self, CHALK, SLATE};
use super::{Eye, Lamp, LampKind, Material, Object, Scene, Set, base_scene};
use crate::shape::Shape;
use glam::DMat4;

/// Tiles along each side.
const TILES: i32 = 12;

/// A checkerboard of `count` by `count` square tiles. `side` is the length of a tile's edge. Each
/// tile is a grid of `quads` by `quads` quadrilaterals.
pub fn tiles(count: i32, side: f64, colors: [DVec3; 2], quads: u32) -> Shape {
    let half = 0.5 * side * f64::from(count);
    let places = (0..count).flat_map(|z| (0..count).map(move |x| (x, z)));
    places.fold(Shape::default(), |shape, (x, z)| {
        let corner = DVec3::new(f64::from(x) * side - half, 0.0, f64::from(z + 1) * side - half);
        let color = colors[(x + z).rem_euclid(2) as usize];
        shape.with(
            Shape::patch(corner, DVec3::X * side, DVec3::NEG_Z * side, (quads, quads))
                .map(|vertex| vertex.color = color),
        )
    })
}

/// The entry in the list of all scenes.
pub const SET: Set =
    Set { name: "floor", about: "a tessellated floor with a light above it", make: scene };

pub fn scene() -> Scene {
    let floor = tiles(TILES, 1.0, [CHALK, SLATE * 1.4], 5);
    let glossy = Material::default().glossy(0.3).shiny(60.0);
    let objects = vec![Object::new(floor, DMat4::IDENTITY, DVec3::ONE).of(glossy, 7)];
    let eye = Eye {
        position: DVec3::new(0.0, 6.4, 10.4),
        target: DVec3::new(0.0, -0.3, 0.2),
        fov_y: 0.66,
        near: 0.5,
        far: 40.0,
    };
    let key = Lamp {
        color: DVec3::new(1.0, 0.96, 0.88),
        position: DVec3::new(-0.9, 4.6, -1.4),
        target: DVec3::new(0.0, 0.0, 0.1),
        half_angle: 0.5,
        kind: LampKind::Spot,
    };
    base_scene(objects, eye, palette::lamps(key, 5.6, 2.2, 0.55))
}
