//! A sphere with eight cubes around it, of few triangles: the scene of a published recipe.

use std::f64::consts::TAU;

use glam::{DMat4, DVec3};

use super::palette::{self, AMBER, CORAL, INDIGO, LEAF, TEAL};
use super::{Eye, Lamp, LampKind, Material, Object, Scene, Set, base_scene, placed_at};
use crate::shape::Shape;

/// The entry in the list of all scenes.
pub const SET: Set = Set {
    name: "carousel",
    about: "a sphere of few triangles with eight cubes on a circle around it",
    make: scene,
};

/// Where Movania, Build High Performance Graphics, 2017, chapter 4, has the sphere and its colour.
/// Its cubes are half a unit above the ground.
const MIDDLE: DVec3 = DVec3::Y;
const PALE: DVec3 = DVec3::new(0.9, 0.9, 1.0);
const CUBES: usize = 8;
const CUBE_HEIGHT: f64 = 0.5;
/// Our own: the circle of the cubes, half of the side of one, and their colours.
const CIRCLE: f64 = 1.9;
const HALF: f64 = 0.28;
const COLORS: [DVec3; 5] = [CORAL, AMBER, LEAF, TEAL, INDIGO];

pub fn scene() -> Scene {
    let glossy = Material::default().glossy(0.8).shiny(40.0);
    let cube = |index: usize| {
        let angle = TAU * index as f64 / CUBES as f64;
        let place = placed_at(CIRCLE * angle.cos(), CUBE_HEIGHT, CIRCLE * angle.sin(), 0.0);
        let color = COLORS[index % COLORS.len()];
        Object::new(Shape::cuboid(DVec3::splat(HALF), 1), place, color).of(glossy, 9)
    };
    let ball = Shape::sphere(1.0, (16, 9));
    let ball = Object::new(ball, DMat4::from_translation(MIDDLE), PALE).of(glossy, 7);
    let objects = std::iter::once(ball).chain((0..CUBES).map(cube)).collect();
    let eye = Eye {
        position: DVec3::new(0.0, 3.0, 6.4),
        target: DVec3::new(0.0, 0.75, 0.0),
        fov_y: 0.6,
        near: 0.5,
        far: 40.0,
    };
    let key = Lamp {
        color: DVec3::ONE,
        position: DVec3::new(-1.3, 1.5, 2.6),
        target: MIDDLE,
        half_angle: 0.6,
        kind: LampKind::Point,
    };
    base_scene(objects, eye, palette::lamps(key, 5.0, 4.0, 0.22))
}
