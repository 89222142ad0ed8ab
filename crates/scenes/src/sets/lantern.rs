//! Shapes around a lamp that is seen, near and far: each is lit from its own side.

use std::f64::consts::TAU;

use glam::{DMat4, DVec3};

use super::floor::tiles;
use super::palette::{self, AMBER, CHALK, CORAL, INDIGO, LEAF, SLATE};
use super::{Eye, Lamp, LampKind, Material, Object, Scene, Set, base_scene, placed_at};
use crate::bulbs::{glow, glowing_material};
use crate::shape::Shape;

/// The colours of the balls, then of the posts.
const COLORS: [DVec3; 8] = [CORAL, LEAF, INDIGO, AMBER, LEAF, INDIGO, AMBER, CORAL];

/// The entry in the list of all scenes.
pub const SET: Set = Set {
    name: "lantern",
    about: "balls close to a lamp that is seen, and posts farther away, on a floor",
    make: scene,
};

/// Balls near the lamp, their distance from its post, and their radius.
const BALLS: (usize, f64, f64) = (4, 2.4, 0.7);
/// Posts behind the balls, their distance from the post of the lamp, and half their height.
const POSTS: (usize, f64, f64) = (4, 5.7, 0.55);
const HEIGHT: f64 = 3.4;

/// The lamp as it is drawn: a globe on a thin pole. Neither casts a shadow.
fn lamp_parts(lamp: &Lamp) -> [Object; 2] {
    let globe = Object::new(
        Shape::sphere(0.3, (40, 20)),
        DMat4::from_translation(lamp.position),
        glow(lamp),
    );
    let pole = Shape::cuboid(DVec3::new(0.05, 0.5 * HEIGHT, 0.05), 1);
    let pole = Object::new(pole, placed_at(0.0, 0.5 * HEIGHT, 0.0, 0.4), SLATE * 0.5);
    [globe.of(glowing_material(lamp), 7), pole.of(Material::default().glossy(0.1), 8)]
        .map(|part| Object { casts: false, ..part })
}

/// The shapes around the lamp, each with a side towards it.
fn shapes_around() -> Vec<Object> {
    let matt = Material::default().glossy(0.25).shiny(40.0);
    let placed = |shape: Shape, angle: f64, (reach, height): (f64, f64)| {
        let place = placed_at(reach * angle.cos(), height, reach * angle.sin(), -angle);
        Object::new(shape, place, DVec3::ONE).of(matt, 7)
    };
    let ball = |index: usize| {
        let angle = TAU * (index as f64 + 0.62) / BALLS.0 as f64;
        placed(Shape::sphere(BALLS.2, (56, 28)), angle, (BALLS.1, BALLS.2))
    };
    let post = |index: usize| {
        // On the far side of the lamp, so that the lit sides are seen.
        let angle = TAU * (0.55 + 0.4 * index as f64 / (POSTS.0 - 1) as f64);
        let shape = Shape::cuboid(DVec3::new(0.4, POSTS.2, 0.4), 1);
        placed(shape, angle, (POSTS.1, POSTS.2))
    };
    let shapes = (0..BALLS.0).map(ball).chain((0..POSTS.0).map(post));
    shapes.zip(COLORS).map(|(object, color)| Object { color, ..object }).collect()
}

pub fn scene() -> Scene {
    let floor = tiles(14, 2.0, [CHALK, CHALK * 0.8], 4);
    let polished = Material::default().glossy(0.25).shiny(600.0);
    let key = Lamp {
        color: DVec3::new(1.0, 0.95, 0.85),
        position: DVec3::Y * HEIGHT,
        target: DVec3::new(1.9, 0.8, 1.9),
        half_angle: 0.9,
        kind: LampKind::Point,
    };
    let mut objects = vec![Object::new(floor, DMat4::IDENTITY, DVec3::ONE).of(polished, 7)];
    objects.extend(shapes_around());
    objects.extend(lamp_parts(&key));
    let eye = Eye {
        position: DVec3::new(0.0, 11.6, 11.2),
        target: DVec3::new(0.0, 0.2, 0.3),
        fov_y: 0.66,
        near: 0.5,
        far: 60.0,
    };
    base_scene(objects, eye, palette::lamps(key, 4.0, 3.0, 0.2))
}
