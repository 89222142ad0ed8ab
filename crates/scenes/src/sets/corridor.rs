//! A long colonnade beside a wall, in the sun: shadows from near to far.

use glam::{DMat4, DVec3};

use super::palette::{self, CHALK, LEAF};
use super::{Eye, Lamp, LampKind, Material, Object, Scene, Set, base_scene};
use crate::lathe::{Turn, turned_shape};
use crate::shape::Shape;

/// Columns of the row, and the distance between them.
const COLUMNS: usize = 14;
const STEP: f64 = 4.0;
/// Half the width of the corridor.
const HALF: f64 = 2.4;
/// Where the floor begins, and how long it is.
const FRONT: f64 = 4.0;
const LENGTH: f64 = STEP * COLUMNS as f64;
/// Slabs of the floor along its width.
const SLABS: u32 = 6;

/// A Tuscan column: a torus, a shaft that becomes thinner upwards, a ring and an echinus.
const COLUMN: &[Turn] = &[
    (0.5, 0.16, 0.0),
    (0.5, 0.34, 0.9),
    (0.42, 0.36, 0.0),
    (0.42, 0.4, 0.0),
    (0.36, 0.5, -0.4),
    (0.3, 3.1, 0.012),
    (0.34, 3.12, 0.0),
    (0.34, 3.18, 0.6),
    (0.3, 3.2, 0.0),
    (0.3, 3.3, 0.0),
    (0.46, 3.44, 0.35),
    (0.46, 3.46, 0.0),
];

/// The entry in the list of all scenes.
pub const SET: Set =
    Set { name: "corridor", about: "a long colonnade beside a wall, in the sun", make: scene };

/// A box from one corner to the opposite one.
fn block(low: DVec3, high: DVec3) -> Shape {
    let place = DMat4::from_translation(0.5 * (low + high));
    Shape::cuboid(0.5 * (high - low), 1).transformed(place)
}

/// A column with the slabs below and above it.
fn column_shape() -> Shape {
    let slab = |half: f64, low: f64, high: f64| {
        block(DVec3::new(-half, low, -half), DVec3::new(half, high, half))
    };
    turned_shape(COLUMN, 28).with(slab(0.56, 0.0, 0.16)).with(slab(0.52, 3.46, 3.6))
}

/// Copies of a shape, one at every column.
fn along_row(shape: &Shape, x: f64) -> Shape {
    (0..COLUMNS).fold(Shape::default(), |row, index| {
        let place = DVec3::new(x, 0.0, 2.0 - STEP * index as f64);
        row.with(shape.clone().transformed(DMat4::from_translation(place)))
    })
}

/// Slabs of stone in two tones.
fn floor_shape() -> Shape {
    let side = 2.0 * (HALF + 0.6) / f64::from(SLABS);
    let rows = (LENGTH / side).ceil() as u32;
    let places = (0..rows).flat_map(|row| (0..SLABS).map(move |column| (row, column)));
    places.fold(Shape::default(), |shape, (row, column)| {
        let x = side * f64::from(column) - HALF - 0.6;
        let corner = DVec3::new(x, 0.0, FRONT - side * f64::from(row));
        let tone = if (row + column) % 2 == 0 { 1.0 } else { 0.84 };
        let slab = Shape::patch(corner, DVec3::X * side, DVec3::NEG_Z * side, (1, 1));
        shape.with(slab.map(|vertex| vertex.color = DVec3::splat(tone)))
    })
}

/// The wall with a base, a cornice, and a pilaster opposite every column.
fn wall_shape() -> Shape {
    let back = FRONT - LENGTH;
    let band = |out: f64, low: f64, high: f64| {
        block(DVec3::new(HALF - out, low, back), DVec3::new(HALF + 0.4, high, FRONT))
    };
    let pilaster = block(DVec3::new(-0.12, 0.5, -0.36), DVec3::new(0.1, 3.6, 0.36))
        .with(block(DVec3::new(-0.17, 3.4, -0.42), DVec3::new(0.1, 3.6, 0.42)));
    band(0.0, 0.0, 4.8)
        .with(band(0.16, 0.0, 0.5))
        .with(band(0.2, 3.6, 3.9))
        .with(band(0.3, 4.5, 4.8))
        .with(along_row(&pilaster, HALF))
}

/// The beam on the columns, with a cornice.
fn beam_shape() -> Shape {
    let back = FRONT - LENGTH;
    let band = |half: f64, low: f64, high: f64| {
        block(DVec3::new(-HALF - half, low, back), DVec3::new(-HALF + half, high, FRONT))
    };
    band(0.42, 3.6, 4.1).with(band(0.6, 4.1, 4.3))
}

/// The garden beside the colonnade. It casts no shadow, so that the shadow map holds only the
/// building.
fn garden() -> [Object; 2] {
    let grass =
        Shape::patch(DVec3::new(-90.0, -0.06, 30.0), DVec3::X * 180.0, DVec3::Z * -180.0, (1, 1));
    let hedge = block(DVec3::new(-11.0, 0.0, -130.0), DVec3::new(-9.8, 1.5, 30.0));
    let leafy = Material::default().glossy(0.0);
    [(grass, LEAF * 0.5), (hedge, LEAF * 0.28)].map(|(shape, color)| {
        let part = Object::new(shape, DMat4::IDENTITY, color).of(leafy, 12);
        Object { casts: false, ..part }
    })
}

pub fn scene() -> Scene {
    let matt = Material::default().glossy(0.05).shiny(20.0);
    let stone = CHALK * DVec3::new(0.95, 0.9, 0.82);
    let part = |shape, color| Object::new(shape, DMat4::IDENTITY, color).of(matt, 7);
    let mut objects = vec![
        part(floor_shape(), stone),
        part(wall_shape(), CHALK * DVec3::new(0.92, 0.74, 0.56)),
        part(beam_shape(), stone),
        part(along_row(&column_shape(), -HALF), stone),
    ];
    objects.extend(garden());
    let eye = Eye {
        position: DVec3::new(0.9, 1.75, 6.0),
        target: DVec3::new(-0.15, 1.6, 0.0),
        fov_y: 0.75,
        near: 0.3,
        far: 160.0,
    };
    let key = Lamp {
        color: DVec3::new(1.2, 1.05, 0.82),
        position: DVec3::new(-8.0, 4.8, 1.0),
        target: DVec3::new(0.0, 0.0, -4.0),
        half_angle: 0.6,
        kind: LampKind::Directional,
    };
    let mut scene = base_scene(objects, eye, palette::lamps(key, 5.0, 4.0, 0.2));
    scene.ambient = DVec3::new(0.16, 0.19, 0.25);
    scene.haze_range = (10.0, 60.0);
    scene.map_size = Some(1024);
    scene
}
