//! A fence and a twig with leaves: shadows with thin bars, gaps and points.

use glam::{DMat4, DVec2, DVec3};

use super::floor::tiles;
use super::palette::{self, AMBER, CHALK, LEAF};
use super::{Eye, Lamp, LampKind, Material, Object, Scene, Set, base_scene, placed_at};
use crate::scene::shape::Shape;

/// The scene, for the table of all.
pub const SET: Set = Set {
    name: "fence",
    about: "a fence and a twig with leaves, whose shadows have thin bars, gaps and points",
    make: scene,
};

/// Bars of the fence.
const BARS: i32 = 8;
/// Leaves to each side of the twig.
const LEAVES: i32 = 4;

/// Bars on two rails, along x.
fn fence_shape() -> Shape {
    let bar = |index: i32| {
        let x = 0.42 * (f64::from(index) - 0.5 * f64::from(BARS - 1));
        let body = Shape::cuboid(DVec3::new(0.11, 0.67, 0.05), 1);
        let body = body.transformed(DMat4::from_translation(DVec3::new(x, 0.67, 0.0)));
        body.with(bar_top().transformed(DMat4::from_translation(DVec3::new(x, 1.34, 0.0))))
    };
    let rail = |y: f64| {
        let length = 0.21 * f64::from(BARS);
        Shape::cuboid(DVec3::new(length, 0.05, 0.03), 1)
            .transformed(DMat4::from_translation(DVec3::new(0.0, y, -0.07)))
    };
    (0..BARS).fold(rail(0.42).with(rail(1.05)), |shape, index| shape.with(bar(index)))
}

/// The point of a bar: a prism on its upper side.
fn bar_top() -> Shape {
    let (left, right, tip) = (DVec3::X * -0.11, DVec3::X * 0.11, DVec3::Y * 0.2);
    let depth = DVec3::Z * 0.05;
    // The upper edge of a side is a point, so its patch is drawn twice over along the edge.
    let side = |z: f64| {
        Shape::surface(1, 1, move |u, v| {
            let base = left.lerp(right, if z > 0.0 { u } else { 1.0 - u });
            base.lerp(tip, v) + depth * z
        })
    };
    side(1.0)
        .with(side(-1.0))
        .with(Shape::patch(right + depth, depth * -2.0, tip - right, (1, 1)))
        .with(Shape::patch(left - depth, depth * 2.0, tip - left, (1, 1)))
        .with(Shape::patch(left - depth, right - left, depth * 2.0, (1, 1)))
}

/// A bent twig with leaves to both sides: thin, and closed all around.
fn twig_shape() -> Shape {
    let line = [(-1.0, 0.05), (-0.3, 0.16), (0.4, 0.12), (1.1, -0.02)];
    let radii = [0.05, 0.04, 0.03, 0.015];
    let points: Vec<_> =
        line.iter().zip(radii).map(|((x, y), radius)| (DVec2::new(*x, *y), radius)).collect();
    let leaf = |index: i32| {
        let (step, side) = (index / 2, if index % 2 == 0 { 1.0 } else { -1.0 });
        let size = 0.44 - 0.05 * f64::from(step);
        let place = DVec3::new(-0.55 + 0.5 * f64::from(step) + 0.12 * side, 0.12, 0.0);
        // A leaf is a ball, long and flat, whose sides meet in a point.
        let blade = Shape::surface(20, 12, |u, v| {
            let ring = (std::f64::consts::PI * v).sin().powf(1.6);
            let (sin, cos) = (std::f64::consts::TAU * u).sin_cos();
            DVec3::new(0.42 * ring * cos, 0.05 * ring * sin, 1.0 - 2.0 * v) * size
                + DVec3::Z * size
        });
        let turn = DMat4::from_rotation_y(if side > 0.0 { 0.5 } else { std::f64::consts::PI - 0.5 });
        blade.transformed(DMat4::from_translation(place) * turn * DMat4::from_rotation_x(0.15))
    };
    (0..2 * LEAVES).fold(Shape::tube(&points, (12, 24)), |shape, index| shape.with(leaf(index)))
}

/// The scene itself.
pub fn scene() -> Scene {
    let matt = Material::default().glossy(0.08).shiny(20.0);
    let objects = vec![
        Object::new(tiles(12, 1.4, [CHALK, CHALK * 0.86], 2), DMat4::IDENTITY, DVec3::ONE)
            .of(matt, 7),
        Object::new(fence_shape(), placed_at(-0.75, 0.0, -0.45, 0.25), AMBER * 0.9).of(matt, 1),
        Object::new(twig_shape(), placed_at(1.6, 0.95, 0.85, -0.5) * DMat4::from_rotation_x(0.2), LEAF)
            .of(matt, 12),
    ];
    let eye = Eye {
        position: DVec3::new(1.25, 4.3, 7.8),
        target: DVec3::new(0.7, 0.45, 0.75),
        fov_y: 0.62,
        near: 0.5,
        far: 40.0,
    };
    let key = Lamp {
        color: DVec3::new(1.0, 0.97, 0.9),
        position: DVec3::new(-4.0, 6.2, -4.2),
        target: DVec3::new(0.2, 0.3, 0.7),
        half_angle: 0.46,
        kind: LampKind::Spot,
    };
    let lamps = palette::lamps(key, 4.0, 3.5, 0.25);
    Scene { map_size: Some(512), ..base_scene(objects, eye, lamps) }
}
