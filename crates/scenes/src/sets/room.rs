//! A box seen from inside, with textures and baked light.

use std::f64::consts::{PI, TAU};

use glam::{DMat4, DVec2, DVec3};
use rayon::prelude::*;

use super::palette::{self, AMBER, CHALK, CORAL, LEAF};
use super::{
    Eye, Lamp, LampKind, Maps, Material, Object, Scene, Set, TextureMap, base_scene, maps,
    placed_at,
};
use crate::bulbs::{glow, glowing_material};
use crate::shape::Shape;

/// Half of the room along each axis, its middle at the origin.
const HALF: DVec3 = DVec3::new(3.0, 2.2, 3.4);
/// The crate: its middle, half its sides, turned about y.
const CRATE: (DVec3, DVec3, f64) =
    (DVec3::new(1.15, -1.35, -1.2), DVec3::new(0.85, 0.85, 0.85), 0.45);
/// The ball: its middle and radius.
const BALL: (DVec3, f64) = (DVec3::new(-1.35, -1.4, -0.2), 0.8);
/// The lamp in the ceiling: half its sides along x and z, just below the ceiling.
const PANEL: (f64, f64) = (1.0, 0.7);

/// Bricks of the texture, by column and row: a matt one, and in the textures of `material_maps` one
/// that glows and one of polished metal.
const MATT: (f64, f64) = (0.0, 4.0);
const GLOWING: (f64, f64) = (0.0, 0.0);
const POLISHED: (f64, f64) = (1.0, 0.0);

/// Which of the walls is the ceiling.
const CEILING: usize = 4;

/// The walls that are seen: a corner, along, up, the colour, and repetitions of the texture.
fn room_walls() -> [(DVec3, DVec3, DVec3, DVec3, DVec2); 5] {
    let (x, y, z) = (DVec3::X * HALF.x, DVec3::Y * HALF.y, DVec3::Z * HALF.z);
    [
        (-x - y + z, 2.0 * x, -2.0 * z, CHALK * 0.85, DVec2::new(3.0, 3.0)),
        (-x - y - z, 2.0 * x, 2.0 * y, CHALK * 1.1, DVec2::new(3.0, 2.0)),
        (-x - y + z, -2.0 * z, 2.0 * y, CORAL * 1.05, DVec2::new(3.0, 2.0)),
        (x - y - z, 2.0 * z, 2.0 * y, LEAF * 1.15, DVec2::new(3.0, 2.0)),
        (-x + y - z, 2.0 * x, 2.0 * z, CHALK * 1.15, DVec2::new(3.0, 3.0)),
    ]
}

/// The faces of the crate in its own space: a corner, along, up.
fn crate_sides() -> [(DVec3, DVec3, DVec3); 6] {
    [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z].map(|normal| {
        let along = if normal.y == 0.0 { DVec3::Y.cross(normal) } else { DVec3::X };
        let up = normal.cross(along);
        ((normal - along - up) * CRATE.1, along * CRATE.1 * 2.0, up * CRATE.1 * 2.0)
    })
}

fn crate_place() -> DMat4 {
    let (middle, _, turn) = CRATE;
    placed_at(middle.x, middle.y, middle.z, turn)
}

/// Columns and rows of charts in the lightmap. The charts are, in order: the walls, the ball, the
/// sides of the crate, the lamp.
const CHARTS: (usize, usize) = (4, 4);
const BALL_CHART: usize = 5;
const CRATE_CHART: usize = 6;
const PANEL_CHART: usize = 12;
/// Texels along the side of a chart.
const CHART: usize = 48;

/// The place in the lightmap of a place in a chart.
fn place_in_map(index: usize, uv: DVec2) -> DVec2 {
    // A margin of a texel and a half, so that filtering stays inside.
    let margin = 1.5 / CHART as f64;
    let inside = DVec2::splat(margin) + uv * (1.0 - 2.0 * margin);
    let place = DVec2::new((index % CHARTS.0) as f64, (index / CHARTS.0) as f64);
    (place + inside) / DVec2::new(CHARTS.0 as f64, CHARTS.1 as f64)
}

/// The entry in the list of all scenes.
pub const SET: Set = Set {
    name: "room",
    about: "a box seen from inside, with textures and a baked lightmap",
    make: scene,
};

pub fn scene() -> Scene {
    let plaster = Material::default().glossy(0.08);
    let mut objects: Vec<Object> = room_walls()
        .into_iter()
        .enumerate()
        .map(|(index, (corner, along, up, color, times))| {
            let shape = charted_shape(Shape::patch(corner, along, up, (16, 16)), index);
            let is_plain = index == CEILING;
            let shape = if is_plain { on_brick(shape, MATT, 0.02) } else { shape.tiled(times) };
            Object::new(shape, DMat4::IDENTITY, color).of(plaster, 7)
        })
        .collect();
    let wood = Material::default().glossy(0.2);
    let sides = crate_sides().into_iter().enumerate();
    let sides = sides.map(|(index, (corner, along, up))| {
        let side = charted_shape(Shape::patch(corner, along, up, (6, 6)), CRATE_CHART + index);
        on_brick(side, MATT, 1.0)
    });
    objects.push(
        Object::new(sides.fold(Shape::default(), Shape::with), crate_place(), AMBER).of(wood, 3),
    );
    let (middle, radius) = BALL;
    let ball = charted_shape(Shape::sphere(radius, (40, 20)), BALL_CHART);
    let ball = on_brick(ball, POLISHED, 0.02);
    objects.push(
        Object::new(ball, placed_at(middle.x, middle.y, middle.z, 0.0), CHALK)
            .of(Material::default().glossy(0.5), 5),
    );
    let eye = Eye {
        position: DVec3::new(0.0, 0.1, 9.2),
        target: DVec3::new(0.0, -0.1, 0.0),
        fov_y: 0.6,
        near: 0.5,
        far: 40.0,
    };
    let key = Lamp {
        color: DVec3::new(1.0, 0.95, 0.85),
        position: DVec3::new(0.0, 1.55, 0.9),
        target: DVec3::new(0.0, -1.2, -0.8),
        half_angle: 0.75,
        kind: LampKind::Point,
    };
    objects.push(panel_object(&key));
    Scene { maps: room_textures, ..base_scene(objects, eye, palette::lamps(key, 2.6, 1.6, 0.2)) }
}

/// The lamp, just below the ceiling. It casts no shadow.
fn panel_object(lamp: &Lamp) -> Object {
    let corner = DVec3::new(-PANEL.0, HALF.y - 0.02, -PANEL.1);
    let (along, up) = (DVec3::X * 2.0 * PANEL.0, DVec3::Z * 2.0 * PANEL.1);
    let shape = charted_shape(Shape::patch(corner, along, up, (1, 1)), PANEL_CHART);
    let shape = on_brick(shape, GLOWING, 0.02);
    let panel = Object::new(shape, DMat4::IDENTITY, glow(lamp)).of(glowing_material(lamp), 7);
    Object { casts: false, ..panel }
}

/// The shape with a part of one brick as its texture. The brick is given by its column and row, and
/// `part` is the side of the part, in bricks.
fn on_brick(shape: Shape, brick: (f64, f64), part: f64) -> Shape {
    let middle = DVec2::new(brick.0 + 0.5, brick.1 + 0.5);
    let bricks = DVec2::new(3.0, 6.0);
    shape.map(|vertex| vertex.uv = (middle + (vertex.uv - 0.5) * part) / bricks)
}

fn charted_shape(shape: Shape, index: usize) -> Shape {
    shape.map(|vertex| vertex.light_uv = place_in_map(index, vertex.uv))
}

fn room_textures() -> Maps {
    Maps { light: baked_light(), ..maps::bricks() }
}

/// The light of the panel on every surface, and a little from everywhere.
fn baked_light() -> TextureMap {
    let (width, height) = (CHARTS.0 * CHART, CHARTS.1 * CHART);
    let texel = |index: usize| {
        let (column, row) = (index % width, index / width);
        let chart = column / CHART + CHARTS.0 * (row / CHART);
        let place = |at: usize| ((at % CHART) as f64 + 0.5 - 1.5) / (CHART as f64 - 3.0);
        let (point, normal) =
            surface_at(chart, DVec2::new(place(column), place(row)).clamp(DVec2::ZERO, DVec2::ONE));
        let light =
            if chart == PANEL_CHART { DVec3::splat(2.0) } else { arriving_light(point, normal) };
        light.extend(1.0)
    };
    TextureMap { width, height, texels: (0..width * height).into_par_iter().map(texel).collect() }
}

/// The point and the normal at a chart's place.
fn surface_at(chart: usize, uv: DVec2) -> (DVec3, DVec3) {
    let flat = |corner: DVec3, along: DVec3, up: DVec3| {
        (corner + along * uv.x + up * uv.y, along.cross(up).normalize())
    };
    if let Some((corner, along, up, _, _)) = room_walls().get(chart) {
        return flat(*corner, *along, *up);
    }
    if let Some((corner, along, up)) =
        chart.checked_sub(CRATE_CHART).and_then(|side| crate_sides().get(side).copied())
    {
        let (point, normal) = flat(corner, along, up);
        return (crate_place().transform_point3(point), crate_place().transform_vector3(normal));
    }
    let (sin, cos) = (TAU * uv.x).sin_cos();
    let (ring, height) = ((PI * uv.y).sin(), -(PI * uv.y).cos());
    let normal = DVec3::new(ring * cos, height, -ring * sin);
    (BALL.0 + normal * BALL.1, normal)
}

/// Light from the panel, by a grid of places on it, and from everywhere.
fn arriving_light(point: DVec3, normal: DVec3) -> DVec3 {
    const SIDE: usize = 8;
    let mut sum = 0.0;
    for index in 0..SIDE * SIDE {
        let place = |at: usize, half: f64| ((at as f64 + 0.5) / SIDE as f64 * 2.0 - 1.0) * half;
        let lamp =
            DVec3::new(place(index % SIDE, PANEL.0), HALF.y - 0.02, place(index / SIDE, PANEL.1));
        let offset = lamp - point;
        let towards = offset.normalize();
        let cosines = normal.dot(towards).max(0.0) * towards.y.max(0.0);
        if cosines > 0.0 && is_clear(point + normal * 1e-3, lamp) {
            sum += cosines / offset.length_squared();
        }
    }
    let area = 4.0 * PANEL.0 * PANEL.1;
    let direct = 5.6 * area * sum / (SIDE * SIDE) as f64;
    let glow = 0.26 + 0.06 * normal.y;
    DVec3::new(1.0, 0.95, 0.86) * direct + DVec3::new(0.9, 0.95, 1.0) * glow
}

/// Whether nothing stands between two points.
fn is_clear(from: DVec3, to: DVec3) -> bool {
    let ray = to - from;
    let to_ball = from - BALL.0;
    let (a, b, c) = (ray.dot(ray), ray.dot(to_ball), to_ball.dot(to_ball) - BALL.1 * BALL.1);
    let ball = b * b > a * c && { (-b - (b * b - a * c).sqrt()) / a } > 0.0;
    !ball && !crosses_crate(from, ray)
}

fn crosses_crate(from: DVec3, ray: DVec3) -> bool {
    let turned = DMat4::from_rotation_y(-CRATE.2);
    let (from, ray) = (turned.transform_point3(from - CRATE.0), turned.transform_vector3(ray));
    let (low, high) = ((-CRATE.1 - from) / ray, (CRATE.1 - from) / ray);
    let (enter, leave) = (low.min(high).max_element(), low.max(high).min_element());
    enter < leave && leave > 0.0 && enter < 1.0
}
