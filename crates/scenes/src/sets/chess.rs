//! The end of a game of chess: the black king lies on a polished board, in the light of one lamp.

use glam::{DMat4, DVec2, DVec3};
use rayon::prelude::*;

use super::{
    Eye, Lamp, LampKind, Maps, Material, Object, Scene, Set, TextureMap, base_scene, maps,
    placed_at,
};
use crate::chessmen::{Man, Standing, open_share};
use crate::lathe::{Turn, framed_shape};
use crate::layers::Layers;
use crate::maps::{grid_noise, random_at};
use crate::shape::Shape;

/// The chessmen that stand: kind, whether white, and the place in squares from the middle of the
/// board.
const GAME: &[(Man, bool, f64, f64)] = &[
    (Man::King, true, -1.5, 1.5),
    (Man::Queen, true, -2.5, -0.5),
    (Man::Rook, true, 2.5, -1.5),
    (Man::Pawn, true, -0.5, 0.5),
    (Man::Bishop, false, 0.5, -2.5),
    (Man::Rook, false, -0.5, -3.5),
    (Man::Pawn, false, 2.5, 0.5),
    (Man::Pawn, false, 1.5, -0.5),
    (Man::Pawn, false, -1.5, -2.5),
];

/// The profile of the frame around the squares, from the table up.
const FRAME: &[Turn] = &[
    (4.86, -0.3, 0.0),
    (4.86, -0.22, 0.0),
    (4.82, -0.18, 0.414),
    (4.74, -0.17, 0.0),
    (4.68, -0.1, -0.414),
    (4.68, -0.02, 0.0),
    (4.6, 0.05, 0.414),
    (4.16, 0.05, 0.0),
    (4.1, 0.0, -0.3),
    (4.06, 0.0, 0.0),
];
/// The strip between the frame and the squares.
const INLAY: &[Turn] = &[(4.06, 0.0, 0.0), (4.0, 0.0, 0.0)];

const IVORY: DVec3 = DVec3::new(0.66, 0.52, 0.34);
const EBONY: DVec3 = DVec3::new(0.028, 0.022, 0.021);
const MAPLE: DVec3 = DVec3::new(0.52, 0.34, 0.18);
const WALNUT: DVec3 = DVec3::new(0.115, 0.048, 0.024);

/// The share of the textures' width that shows the board, and half the side of the square that it
/// shows, scene units. The rest of the width is blank.
const BOARD: (f64, f64) = (0.9, 4.9);
/// Texture coordinates of a blank place.
const BLANK: DVec2 = DVec2::new(0.95, 0.5);

/// The entry in the list of all scenes.
pub const SET: Set = Set {
    name: "chess",
    about: "the end of a game of chess on a polished board, in the light of one lamp",
    make: scene,
};

/// The texture coordinates of a place on the board.
fn board_uv(place: DVec3) -> DVec2 {
    (DVec2::new(place.x, place.z) / BOARD.1 * 0.5 + 0.5) * DVec2::new(BOARD.0, 1.0)
}

/// The squares, with texture coordinates over the whole board.
fn squares() -> Shape {
    let places = (0..8).flat_map(|z| (0..8).map(move |x| (x, z)));
    let board = places.fold(Shape::default(), |shape, (x, z)| {
        let corner = DVec3::new(f64::from(x) - 4.0, 0.0, f64::from(z) - 3.0);
        let color = if (x + z) % 2 == 0 { MAPLE } else { WALNUT };
        let square = Shape::patch(corner, DVec3::X, DVec3::NEG_Z, (1, 1));
        shape.with(square.map(|vertex| vertex.color = color))
    });
    on_board(board)
}

fn on_board(shape: Shape) -> Shape {
    shape.map(|vertex| vertex.uv = board_uv(vertex.position))
}

fn in_blank(shape: Shape) -> Shape {
    shape.map(|vertex| vertex.uv = BLANK)
}

/// A surface of glTF without extensions.
fn plain_material(roughness: f64, ambient: f64, specular: f64) -> Material {
    Material {
        roughness,
        ambient: DVec3::splat(ambient),
        layers: Some(Layers { specular, ..Layers::default() }),
        ..Material::default()
    }
}

fn chessman(man: Man, is_white: bool, place: DMat4) -> Object {
    let (color, roughness) = if is_white { (IVORY, 0.34) } else { (EBONY, 0.26) };
    Object::new(in_blank(man.shape()), place, color).of(plain_material(roughness, 1.0, 1.0), 9)
}

/// A king who lies on the board: on the rims of his foot and of his head.
fn fallen_king() -> Object {
    let tilt = ((0.41 - 0.265) / 1.78_f64).atan();
    let turned = DMat4::from_rotation_y(-0.9)
        * DMat4::from_rotation_z(-std::f64::consts::FRAC_PI_2 - tilt)
        * DMat4::from_rotation_y(0.35);
    let king = chessman(Man::King, false, DMat4::IDENTITY);
    let heights = king.shape.vertices.iter().map(|v| turned.transform_point3(v.position).y);
    let lowest = heights.fold(f64::INFINITY, f64::min);
    let place = DMat4::from_translation(DVec3::new(0.2, -lowest, 0.9)) * turned;
    Object { world_from_object: place, ..king }
}

/// The table, which rises to a wall far behind the board.
fn backdrop() -> Object {
    let (front, back, radius, height) = (18.0, -9.0, 7.0, 16.0);
    let shape = Shape::surface(1, 40, |u, v| {
        let x = 44.0 * (u - 0.5);
        let (floor, bend) = (front - back, 0.5 * std::f64::consts::PI * radius);
        let way = v * (floor + bend + height);
        if way < floor {
            return DVec3::new(x, -0.3, front - way);
        }
        let angle = ((way - floor) / radius).min(0.5 * std::f64::consts::PI);
        let above = (way - floor - bend).max(0.0);
        DVec3::new(x, -0.3 + radius * (1.0 - angle.cos()) + above, back - radius * angle.sin())
    });
    let cloth = plain_material(0.8, 0.25, 0.3);
    let backdrop = Object::new(in_blank(shape), DMat4::IDENTITY, DVec3::new(0.07, 0.085, 0.11));
    Object { casts: false, ..backdrop.of(cloth, 8) }
}

/// The key light, a cool one from the other side, and one that lights the wall.
fn lamps() -> Vec<Lamp> {
    let spot = |color, position, target, half_angle| Lamp {
        color,
        position,
        target,
        half_angle,
        kind: LampKind::Spot,
    };
    let mut all = vec![
        spot(
            DVec3::new(3.3, 2.6, 1.75),
            DVec3::new(-7.0, 6.0, -1.0),
            DVec3::new(0.1, 0.2, 0.2),
            0.62,
        ),
        spot(
            DVec3::new(0.32, 0.5, 0.85),
            DVec3::new(7.0, 3.4, -6.0),
            DVec3::new(0.0, 0.6, 0.0),
            0.6,
        ),
        spot(
            DVec3::new(0.55, 0.75, 1.0) * 2.2,
            DVec3::new(1.5, 1.5, -12.5),
            DVec3::new(1.5, 4.0, -16.0),
            0.9,
        ),
    ];
    all[2].kind = LampKind::Point;
    all
}

pub fn scene() -> Scene {
    let polish = plain_material(0.3, 1.0, 1.0);
    let dark = |shape, color| Object::new(on_board(shape), DMat4::IDENTITY, color).of(polish, 3);
    let mut objects = vec![
        dark(squares(), DVec3::ONE),
        dark(framed_shape(INLAY), MAPLE),
        dark(framed_shape(FRAME), WALNUT * 0.6),
        backdrop(),
        fallen_king(),
    ];
    objects.extend(
        GAME.iter()
            .map(|(man, is_white, x, z)| chessman(*man, *is_white, placed_at(*x, 0.0, *z, 0.35))),
    );
    let eye = Eye {
        position: DVec3::new(0.9, 2.75, 8.2),
        target: DVec3::new(0.15, 0.62, 0.0),
        fov_y: 0.5,
        near: 0.5,
        far: 60.0,
    };
    Scene {
        map_size: Some(1024),
        maps: chess_maps,
        lamp_size: Some(DVec2::splat(0.35)),
        ..base_scene(objects, eye, lamps())
    }
}

/// Textures of wood, and the occlusion by the men. The other maps are those of bricks.
fn chess_maps() -> Maps {
    Maps { base: wood_map(), occlusion: open_map(), ..maps::bricks() }
}

/// A square map of the board. `number` gives the value of a texel from its place on the board.
fn board_map(side: usize, number: impl Fn(DVec2) -> f64 + Sync) -> TextureMap {
    let texel = |index: usize| {
        let at = (DVec2::new((index % side) as f64, (index / side) as f64) + 0.5) / side as f64;
        let share = if at.x < BOARD.0 {
            number((DVec2::new(at.x / BOARD.0, at.y) * 2.0 - 1.0) * BOARD.1)
        } else {
            1.0
        };
        DVec3::splat(share).extend(1.0)
    };
    TextureMap {
        width: side,
        height: side,
        texels: (0..side * side).into_par_iter().map(texel).collect(),
    }
}

fn open_map() -> TextureMap {
    let men: Vec<_> =
        GAME.iter().map(|(man, _, x, z)| Standing::new(*man, DVec2::new(*x, *z))).collect();
    board_map(256, |at| open_share(at, &men))
}

/// The grain of the squares and of the frame: rings of growth, cut along, and fine fibres.
fn wood_map() -> TextureMap {
    board_map(1024, |at| {
        let is_framed = at.abs().max_element() > 4.06;
        let across = is_framed && at.x.abs() > at.y.abs();
        let along = if across { DVec2::new(at.y, at.x) } else { at };
        let cell = if is_framed { along.signum() * 9.0 } else { along.floor() };
        let tone = wood_noise(cell * 7.3 + 0.5);
        let place = DVec2::new(along.y + 11.0 * tone, along.x * 0.35 + 3.0 * cell.x);
        let ring = 5.0 * place.x + 2.2 * wood_noise(place * DVec2::new(1.4, 1.1));
        let growth = 0.5 + 0.5 * (std::f64::consts::TAU * ring).sin();
        let fibre = wood_noise(place * DVec2::new(46.0, 9.0));
        0.8 + 0.16 * tone + 0.13 * growth * growth + 0.1 * fibre
    })
}

/// Noise between 0 and 1, with cells of one unit.
fn wood_noise(at: DVec2) -> f64 {
    grid_noise(at, |x, y| random_at(x, y, 0))
}
