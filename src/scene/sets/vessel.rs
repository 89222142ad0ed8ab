//! A pot with a lid, a spout and a handle: a profile turned around an axis, and two tubes.

use glam::{DMat4, DVec2, DVec3};

use super::floor::tiles;
use super::palette::{self, CHALK, TEAL};
use super::{Eye, Lamp, LampKind, Material, Object, Scene, Set, base, placed};
use crate::scene::shape::Shape;

const BODY: &[(f64, f64)] = &[
    (0.0, 0.0),
    (0.75, 0.0),
    (0.95, 0.04),
    (1.32, 0.35),
    (1.55, 0.8),
    (1.5, 1.25),
    (1.2, 1.6),
    (0.85, 1.78),
    (0.8, 1.86),
    (0.72, 1.84),
];
const LID: &[(f64, f64)] = &[
    (0.8, 1.8),
    (0.83, 1.87),
    (0.6, 1.99),
    (0.25, 2.07),
    (0.12, 2.12),
    (0.13, 2.2),
    (0.2, 2.27),
    (0.16, 2.36),
    (0.0, 2.4),
];
const SPOUT: &[(f64, f64, f64)] = &[
    (1.2, 0.55, 0.42),
    (1.65, 0.7, 0.34),
    (1.95, 1.05, 0.24),
    (2.16, 1.42, 0.18),
    (2.42, 1.7, 0.16),
    (2.72, 1.88, 0.13),
];
const HANDLE: &[(f64, f64, f64)] = &[
    (-1.2, 1.45, 0.11),
    (-1.75, 1.62, 0.12),
    (-2.15, 1.4, 0.13),
    (-2.1, 0.95, 0.13),
    (-1.75, 0.6, 0.12),
    (-1.3, 0.45, 0.11),
];

/// The pot, standing on y = 0, its spout along x.
fn pot() -> Shape {
    let profile = |points: &[(f64, f64)]| {
        points.iter().map(|(radius, height)| DVec2::new(*radius, *height)).collect::<Vec<_>>()
    };
    let line = |points: &[(f64, f64, f64)]| {
        points.iter().map(|(x, y, radius)| (DVec2::new(*x, *y), *radius)).collect::<Vec<_>>()
    };
    Shape::lathe(&profile(BODY), (72, 48))
        .with(Shape::lathe(&profile(LID), (72, 32)))
        .with(Shape::tube(&line(SPOUT), (32, 32)))
        .with(Shape::tube(&line(HANDLE), (24, 40)))
}

/// A cup without a handle.
const CUP: &[(f64, f64)] = &[
    (0.0, 0.02),
    (0.3, 0.0),
    (0.36, 0.05),
    (0.46, 0.4),
    (0.5, 0.8),
    (0.46, 0.8),
    (0.42, 0.4),
    (0.3, 0.1),
    (0.0, 0.08),
];

/// The scene, for the table of all.
pub const SET: Set = Set {
    name: "vessel",
    about: "a turned pot with a spout and a handle, on a table",
    make: scene,
};

/// The scene itself.
pub fn scene() -> Scene {
    let glaze = Material::default().glossy(0.5).shiny(90.0);
    let cup: Vec<DVec2> = CUP.iter().map(|(radius, height)| DVec2::new(*radius, *height)).collect();
    let objects = vec![
        Object::new(tiles(10, 1.2, [CHALK, CHALK * 0.72], 2), DMat4::IDENTITY, DVec3::ONE)
            .of(Material::default().glossy(0.06), 11),
        Object::new(pot(), placed(-0.3, 0.0, 0.0, -0.45), TEAL).of(glaze, 9),
        Object::new(Shape::lathe(&cup, (48, 40)), placed(1.55, 0.0, 2.1, 0.0), CHALK).of(glaze, 5),
    ];
    let eye = Eye {
        position: DVec3::new(0.9, 4.0, 8.6),
        target: DVec3::new(0.2, 0.85, 0.2),
        fov_y: 0.6,
        near: 0.5,
        far: 40.0,
    };
    let key = Lamp {
        color: DVec3::new(1.0, 0.97, 0.9),
        position: DVec3::new(-4.0, 6.2, 4.6),
        target: DVec3::new(0.0, 0.7, 0.2),
        half_angle: 0.5,
        kind: LampKind::Spot,
    };
    base(objects, eye, palette::lamps(key, 4.0, 3.5, 0.25))
}
