//! A round place at night: columns, steps and a ball under many coloured lamps.

use std::f64::consts::TAU;

use glam::{DMat4, DVec2, DVec3};

use super::floor::tiles;
use super::palette::{CHALK, SLATE};
use super::{Eye, Lamp, LampKind, Material, Object, Scene, Set, base_scene, placed_at};
use crate::shape::Shape;

/// The entry in the list of all scenes.
pub const SET: Set = Set {
    name: "plaza",
    about: "a round place at night: columns and a ball under forty coloured lamps",
    make: scene,
};

/// Columns around the middle, and how far they are from it.
const COLUMNS: usize = 10;
const RADIUS: f64 = 3.6;
/// Lamps on the steps, and on a ring behind the columns.
const LOW: usize = 20;
const HIGH: usize = 20;

/// A place on a circle around the middle.
fn around(share: f64, radius: f64, height: f64) -> DVec3 {
    let (sin, cos) = (TAU * share).sin_cos();
    DVec3::new(radius * cos, height, radius * sin)
}

fn round_step(radius: f64, low: f64, high: f64) -> Object {
    let profile = [(radius, low), (radius, high - 0.02), (radius - 0.02, high), (0.0, high)];
    let rings = profile.windows(2).map(|two| {
        let (from, to) = (two[0], two[1]);
        Shape::surface(96, 6, |u, v| {
            let at = around(-u, from.0 + (to.0 - from.0) * v, 0.0);
            DVec3::new(at.x, from.1 + (to.1 - from.1) * v, at.z)
        })
    });
    let shape = rings.fold(Shape::default(), Shape::with);
    Object::new(shape, DMat4::IDENTITY, CHALK * 0.9).of(stone(), 7)
}

fn stone() -> Material {
    Material { roughness: 0.4, ..Material::default().glossy(0.06).shiny(40.0) }
}

fn column(index: usize) -> Object {
    let profile = [
        (0.34, 0.0),
        (0.34, 0.16),
        (0.22, 0.24),
        (0.2, 1.4),
        (0.2, 2.2),
        (0.32, 2.36),
        (0.32, 2.5),
    ];
    let profile = profile.map(|(radius, height)| DVec2::new(radius, height));
    let at = around(index as f64 / COLUMNS as f64, RADIUS, 0.0);
    Object::new(Shape::lathe(&profile, (40, 60)), placed_at(at.x, 0.0, at.z, 0.0), CHALK)
        .of(stone(), 7)
}

/// The colour of a lamp from its hue, as a share of the colour circle.
fn hue(share: f64) -> DVec3 {
    let turn = TAU * share;
    let hue = DVec3::new(turn.cos(), (turn - TAU / 3.0).cos(), (turn + TAU / 3.0).cos());
    (DVec3::splat(0.5) + 0.5 * hue).max(DVec3::splat(0.03))
}

fn small_lamp(position: DVec3, target: DVec3, color: DVec3) -> Lamp {
    Lamp { color, position, target, half_angle: 0.9, kind: LampKind::Point }
}

pub fn scene() -> Scene {
    let glossy = Material { roughness: 0.22, ..Material::default().glossy(0.5).shiny(90.0) };
    let floor = tiles(24, 1.0, [SLATE * 0.8, SLATE * 0.55], 2);
    let mut objects = vec![
        Object::new(floor, DMat4::IDENTITY, DVec3::ONE).of(stone(), 7),
        round_step(2.1, 0.0, 0.2),
        round_step(1.6, 0.2, 0.4),
        Object::new(Shape::sphere(0.85, (96, 48)), placed_at(0.0, 1.25, 0.0, 0.0), CHALK)
            .of(glossy, 5),
    ];
    objects.extend((0..COLUMNS).map(column));
    let eye = Eye {
        position: DVec3::new(0.6, 4.3, 10.2),
        target: DVec3::new(0.0, 0.75, 0.0),
        fov_y: 0.6,
        near: 0.5,
        far: 40.0,
    };
    let low = |index: usize| {
        let share = index as f64 / LOW as f64;
        let at = around(share, 2.6, 0.3);
        small_lamp(at, at - DVec3::Y * 1.3, hue(share) * 0.35)
    };
    let high = |index: usize| {
        let share = (index as f64 + 0.5) / HIGH as f64;
        let at = around(share, 4.7, 1.1);
        small_lamp(at, at - DVec3::Y * 1.1, hue(share + 0.5) * 0.4)
    };
    let lamps = (0..LOW).map(low).chain((0..HIGH).map(high)).collect();
    let ambient = DVec3::new(0.03, 0.033, 0.045);
    Scene { shows_lamps: true, ambient, ..base_scene(objects, eye, lamps) }
}
