//! A fence and a plant in a pot: shadows with thin bars, gaps and points.

use glam::{DMat4, DVec2, DVec3};

use super::floor::tiles;
use super::palette::{self, AMBER, CHALK, CORAL, LEAF};
use super::{Eye, Lamp, LampKind, Material, Object, Scene, Set, base_scene, placed_at};
use crate::lathe::{Turn, turned_shape};
use crate::shape::Shape;

/// The entry in the list of all scenes.
pub const SET: Set = Set {
    name: "fence",
    about: "a fence and a plant in a pot, whose shadows have thin bars, gaps and points",
    make: scene,
};

/// Bars of the fence, and the distance between them.
const BARS: i32 = 8;
const STEP: f64 = 0.42;
/// Leaves of the plant.
const LEAVES: i32 = 9;

/// A turned bar with a knob and a point.
const BAR: &[Turn] = &[
    (0.09, 0.0, 0.0),
    (0.09, 1.16, 0.0),
    (0.055, 1.19, 0.0),
    (0.055, 1.24, 0.0),
    (0.1, 1.33, 0.3),
    (0.06, 1.45, 0.2),
    (0.0, 1.6, -0.1),
];

/// The pot, from its foot to the middle of its soil.
const POT: &[Turn] = &[
    (0.24, 0.0, 0.0),
    (0.31, 0.4, 0.0),
    (0.345, 0.4, 0.0),
    (0.36, 0.415, 0.414),
    (0.36, 0.515, 0.0),
    (0.345, 0.53, 0.414),
    (0.32, 0.53, 0.0),
    (SOIL, 0.48, 0.0),
    (0.0, 0.5, 0.0),
];
/// The radius of the soil.
const SOIL: f64 = 0.3;

/// Bars on two rails, along x.
fn fence_shape() -> Shape {
    let bar = turned_shape(BAR, 24);
    let bar_at = |index: i32| {
        let x = STEP * (f64::from(index) - 0.5 * f64::from(BARS - 1));
        bar.clone().transformed(DMat4::from_translation(DVec3::X * x))
    };
    let rail = |y: f64| {
        let half = 0.5 * STEP * f64::from(BARS);
        Shape::cuboid(DVec3::new(half, 0.05, 0.03), 1)
            .transformed(DMat4::from_translation(DVec3::Y * y))
    };
    (0..BARS).fold(rail(0.36).with(rail(1.02)), |shape, index| shape.with(bar_at(index)))
}

/// A leaf along z that hangs over: thin, closed all around, and pointed at both ends.
fn leaf_shape(length: f64) -> Shape {
    Shape::surface(20, 14, |u, v| {
        let ring = (std::f64::consts::PI * v).sin();
        let (sin, cos) = (std::f64::consts::TAU * u).sin_cos();
        let bend = 0.5 * v - 0.75 * v * v;
        DVec3::new(0.26 * ring * cos, 0.03 * ring * sin + bend, v) * length
    })
}

/// A stem with leaves to all sides, from the ground up.
fn plant_shape() -> Shape {
    let line = [(0.0, 0.0), (0.03, 0.4), (-0.03, 0.8), (0.0, 1.15)];
    let radii = [0.04, 0.035, 0.025, 0.015];
    let points: Vec<_> =
        line.iter().zip(radii).map(|((x, y), radius)| (DVec2::new(*x, *y), radius)).collect();
    let leaf = |index: i32| {
        let share = f64::from(index) / f64::from(LEAVES - 1);
        // Turned by the golden angle, as on many plants.
        let turn = DMat4::from_rotation_y(2.4 * f64::from(index) + 0.9);
        let place = DMat4::from_translation(DVec3::Y * (0.3 + 0.8 * share));
        leaf_shape(0.8 - 0.3 * share).transformed(place * turn)
    };
    (0..LEAVES).fold(Shape::tube(&points, (12, 24)), |shape, index| shape.with(leaf(index)))
}

/// The pot with its soil.
fn pot_shape() -> Shape {
    turned_shape(POT, 40).map(|vertex| {
        let radius = vertex.position.x.hypot(vertex.position.z);
        let is_soil = vertex.normal.y > 0.5 && radius < SOIL + 1e-6 && vertex.position.y > 0.4;
        vertex.color = if is_soil { DVec3::new(0.12, 0.08, 0.05) } else { CORAL };
    })
}

pub fn scene() -> Scene {
    let matt = Material::default().glossy(0.08).shiny(20.0);
    let glossy = Material::default().glossy(0.7).shiny(24.0);
    let pot = DVec3::new(1.27, 0.0, 0.9);
    let objects = vec![
        Object::new(tiles(12, 1.4, [CHALK, CHALK * 0.86], 2), DMat4::IDENTITY, DVec3::ONE)
            .of(matt, 7),
        Object::new(fence_shape(), placed_at(-0.9, 0.0, -0.7, 0.25), AMBER * 0.9).of(glossy, 1),
        Object::new(plant_shape(), placed_at(pot.x, 0.48, pot.z, 0.0), LEAF).of(glossy, 12),
        Object::new(pot_shape(), DMat4::from_translation(pot), DVec3::ONE).of(matt, 0),
    ];
    let eye = Eye {
        position: DVec3::new(1.0, 4.3, 7.6),
        target: DVec3::new(0.75, 0.42, 0.5),
        fov_y: 0.59,
        near: 0.5,
        far: 40.0,
    };
    let key = Lamp {
        color: DVec3::new(1.0, 0.97, 0.9),
        position: DVec3::new(-4.3, 6.9, -3.5),
        target: DVec3::new(0.5, 0.3, 0.6),
        half_angle: 0.46,
        kind: LampKind::Spot,
    };
    let lamps = palette::lamps(key, 4.0, 3.5, 0.25);
    Scene { map_size: Some(512), ..base_scene(objects, eye, lamps) }
}
