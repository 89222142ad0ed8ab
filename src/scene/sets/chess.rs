//! A game of chess near its end: turned pieces on a polished board.

use glam::{DMat4, DVec2, DVec3};

use super::floor::tiles;
use super::palette;
use super::{Eye, Lamp, LampKind, Material, Object, Scene, Set, base_scene, placed_at};
use crate::scene::shape::Shape;

/// Radius and height of a profile, from the bottom up; two points near each other are an edge.
type Profile = &'static [(f64, f64)];

/// The foot and the collar that all pieces share, for a stem of height 1.
const PAWN: Profile = &[
    (0.0, 0.0),
    (0.38, 0.0),
    (0.4, 0.03),
    (0.4, 0.1),
    (0.33, 0.16),
    (0.3, 0.2),
    (0.31, 0.24),
    (0.2, 0.32),
    (0.14, 0.5),
    (0.12, 0.62),
    (0.22, 0.66),
    (0.22, 0.69),
    (0.13, 0.73),
    (0.19, 0.8),
    (0.22, 0.9),
    (0.19, 1.0),
    (0.1, 1.07),
    (0.0, 1.1),
];
const ROOK: Profile = &[
    (0.0, 0.0),
    (0.42, 0.0),
    (0.44, 0.03),
    (0.44, 0.12),
    (0.36, 0.2),
    (0.34, 0.26),
    (0.25, 0.36),
    (0.21, 0.6),
    (0.2, 0.9),
    (0.29, 1.0),
    (0.32, 1.03),
    (0.32, 1.14),
    (0.32, 1.25),
    (0.317, 1.28),
    (0.305, 1.3),
    (0.28, 1.302),
    (0.25, 1.302),
    (0.232, 1.295),
    (0.224, 1.275),
    (0.22, 1.24),
    (0.22, 1.2),
    (0.212, 1.175),
    (0.18, 1.165),
    (0.0, 1.165),
];
const BISHOP: Profile = &[
    (0.0, 0.0),
    (0.41, 0.0),
    (0.43, 0.03),
    (0.43, 0.12),
    (0.34, 0.2),
    (0.32, 0.26),
    (0.22, 0.38),
    (0.14, 0.7),
    (0.13, 0.9),
    (0.26, 0.95),
    (0.26, 0.99),
    (0.14, 1.04),
    (0.2, 1.14),
    (0.22, 1.26),
    (0.16, 1.44),
    (0.07, 1.54),
    (0.05, 1.56),
    (0.08, 1.61),
    (0.06, 1.66),
    (0.0, 1.68),
];
const QUEEN: Profile = &[
    (0.0, 0.0),
    (0.45, 0.0),
    (0.47, 0.03),
    (0.47, 0.13),
    (0.38, 0.22),
    (0.36, 0.28),
    (0.25, 0.42),
    (0.16, 0.85),
    (0.15, 1.1),
    (0.29, 1.16),
    (0.29, 1.2),
    (0.17, 1.26),
    (0.19, 1.42),
    (0.29, 1.62),
    (0.31, 1.68),
    (0.28, 1.72),
    (0.22, 1.72),
    (0.15, 1.72),
    (0.08, 1.74),
    (0.06, 1.77),
    (0.1, 1.83),
    (0.08, 1.89),
    (0.0, 1.91),
];
const KING: Profile = &[
    (0.0, 0.0),
    (0.46, 0.0),
    (0.48, 0.03),
    (0.48, 0.13),
    (0.39, 0.22),
    (0.37, 0.28),
    (0.26, 0.44),
    (0.17, 0.9),
    (0.16, 1.2),
    (0.31, 1.26),
    (0.31, 1.3),
    (0.18, 1.36),
    (0.21, 1.52),
    (0.29, 1.76),
    (0.28, 1.8),
    (0.1, 1.9),
    (0.05, 1.93),
    (0.0, 1.94),
];

/// A colour with what it is polished to.
const IVORY: (DVec3, f64) = (DVec3::new(0.82, 0.7, 0.5), 0.045);
const EBONY: (DVec3, f64) = (DVec3::new(0.045, 0.035, 0.035), 0.05);

/// Who stands where, in squares from the middle.
const GAME: &[(Profile, bool, f64, f64)] = &[
    (KING, true, -0.5, 1.5),
    (QUEEN, true, -2.5, 0.5),
    (BISHOP, true, 1.5, 1.5),
    (PAWN, true, -1.5, 2.5),
    (PAWN, true, 0.5, 2.5),
    (PAWN, true, 2.5, 2.5),
    (KING, false, 2.5, -1.5),
    (ROOK, false, 0.5, -0.5),
    (ROOK, false, -1.5, -2.5),
    (BISHOP, false, -0.5, -1.5),
    (PAWN, false, 1.5, -0.5),
    (PAWN, false, 3.5, -0.5),
    (PAWN, false, -2.5, -1.5),
];

/// The scene, for the table of all.
pub const SET: Set = Set {
    name: "chess",
    about: "turned pieces of ivory and ebony on a polished board",
    make: scene,
};

fn chess_piece(profile: Profile, x: f64, z: f64, (color, share): (DVec3, f64)) -> Object {
    let points: Vec<DVec2> = profile.iter().map(|(r, h)| DVec2::new(*r, *h)).collect();
    let mut shape = Shape::lathe(&points, (56, 7 * points.len() as u32));
    if std::ptr::eq(profile, KING) {
        let cross = |half| {
            Shape::cuboid(half, 1)
                .transformed(DMat4::from_translation(DVec3::new(0.0, 2.06, 0.0)))
        };
        shape = shape.with(cross(DVec3::new(0.045, 0.15, 0.03)));
        shape = shape.with(cross(DVec3::new(0.12, 0.04, 0.028)));
    }
    let polish = Material::default().glossy(share).shiny(180.0);
    let polish = Material { roughness: 0.24, ..polish };
    Object::new(shape, placed_at(x, 0.0, z, 0.35), color).of(polish, 9)
}

/// The scene itself.
pub fn scene() -> Scene {
    let board = Material { roughness: 0.3, ..Material::default().glossy(0.05).shiny(90.0) };
    let squares = [DVec3::new(0.66, 0.5, 0.31), DVec3::new(0.16, 0.075, 0.04)];
    let frame = Shape::cuboid(DVec3::new(4.5, 0.16, 4.5), 1);
    let table = Shape::patch(DVec3::new(-16.0, -0.34, 16.0), DVec3::X * 32.0, DVec3::Z * -32.0, (8, 8));
    let matt = Material { roughness: 0.6, ..Material::default().glossy(0.03) };
    let mut objects = vec![
        Object::new(tiles(8, 1.0, squares, 1), DMat4::IDENTITY, DVec3::ONE).of(board, 3),
        Object::new(frame, placed_at(0.0, -0.165, 0.0, 0.0), DVec3::new(0.13, 0.055, 0.03))
            .of(board, 3),
        Object::new(table, DMat4::IDENTITY, DVec3::new(0.2, 0.22, 0.24)).of(matt, 8),
    ];
    objects.extend(GAME.iter().map(|(profile, is_white, x, z)| {
        chess_piece(profile, *x, *z, if *is_white { IVORY } else { EBONY })
    }));
    let eye = Eye {
        position: DVec3::new(2.9, 3.6, 7.7),
        target: DVec3::new(-0.05, 0.55, 0.2),
        fov_y: 0.56,
        near: 0.5,
        far: 40.0,
    };
    let key = Lamp {
        color: DVec3::new(1.5, 1.36, 1.1) * 1.6,
        position: DVec3::new(-5.2, 6.4, -2.2),
        target: DVec3::new(0.2, 0.3, 0.3),
        half_angle: 0.62,
        kind: LampKind::Spot,
    };
    let lamps = palette::lamps(key, 5.0, 4.5, 0.12);
    Scene { map_size: Some(2048), ..base_scene(objects, eye, lamps) }
}
