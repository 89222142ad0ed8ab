//! Low hills of triangles that can be told apart, under a lamp that is seen: what shading by face,
//! vertex and fragment makes of them.

use glam::{DMat4, DVec2, DVec3};

use super::palette;
use super::{Eye, Lamp, LampKind, Map, Maps, Material, Object, Scene, Set, base_scene, maps};
use crate::scene::shape::Shape;

/// Quads along each side, and the side, scene units.
const CELLS: u32 = 24;
const SIDE: f64 = 15.0;
/// How often the texture is repeated along each side.
const TIMES: f64 = 3.0;

/// The scene, for the table of all.
pub const SET: Set = Set {
    name: "hills",
    about: "low hills of triangles under a lamp that is seen, so that faces and corners can be told apart",
    make: scene,
};

fn hill_height(x: f64, z: f64) -> f64 {
    0.55 * (0.9 * x + 0.4).sin() * (0.8 * z - 0.3).cos() + 0.25 * (0.5 * x - 1.1 * z).sin()
}

/// The scene itself.
pub fn scene() -> Scene {
    let at = |u: f64, v: f64| {
        let (x, z) = (SIDE * (u - 0.5), SIDE * (0.5 - v));
        DVec3::new(x, hill_height(x, z), z)
    };
    let land = Shape::surface(CELLS, CELLS, at).tiled(DVec2::splat(TIMES));
    let matt = Material::default().glossy(0.3).shiny(30.0);
    let key = Lamp {
        color: DVec3::splat(1.0),
        position: DVec3::new(-0.6, 2.3, -1.6),
        target: DVec3::new(0.0, 0.0, 0.6),
        half_angle: 0.7,
        kind: LampKind::Point,
    };
    let eye = Eye {
        position: DVec3::new(0.4, 3.0, 7.0),
        target: DVec3::new(0.0, 0.55, 0.0),
        fov_y: 0.62,
        near: 0.5,
        far: 60.0,
    };
    let objects = vec![Object::new(land, DMat4::IDENTITY, DVec3::ONE).of(matt, 12)];
    let scene = base_scene(objects, eye, palette::lamps(key, 6.0, 4.0, 0.4));
    Scene { maps: hill_textures, shows_lamps: true, ..scene }
}

/// Earth with patches of grass. The other maps are those of bricks.
fn hill_textures() -> Maps {
    let base = Map::of(512, |at| {
        let fine = lumpy_noise(at, 60);
        let tone = 0.8 + 0.25 * fine + 0.15 * lumpy_noise(at, 170);
        let lumps = 0.6 * lumpy_noise(at, 5) + 0.4 * lumpy_noise(at, 14);
        let grass = ((lumps + 0.25 * (fine - 0.5) - 0.46) / 0.1).clamp(0.0, 1.0);
        let color = DVec3::new(0.6, 0.45, 0.3).lerp(DVec3::new(0.34, 0.45, 0.16), grass);
        (color * tone).extend(1.0)
    });
    Maps { base, ..maps::bricks() }
}

/// Smooth noise that repeats with the texture: random numbers of so many places along each side, and
/// a blend between them, [0, 1].
fn lumpy_noise(at: DVec2, places: u32) -> f64 {
    let place = at * f64::from(places);
    let (first, part) = (place.floor(), place - place.floor());
    let blend = part * part * (3.0 - 2.0 * part);
    let random = |x: u32, y: u32| {
        let corner = |first: f64, step: u32| (first as u32 + step) % places;
        random_share(corner(first.x, x), corner(first.y, y))
    };
    let row = |y: u32| random(0, y) + (random(1, y) - random(0, y)) * blend.x;
    row(0) + (row(1) - row(0)) * blend.y
}

/// A random number of a place, [0, 1].
fn random_share(x: u32, y: u32) -> f64 {
    let mixed = x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA77);
    let mixed = (mixed ^ (mixed >> 15)).wrapping_mul(0x2C1B_3C6D);
    let mixed = (mixed ^ (mixed >> 12)).wrapping_mul(0x297A_2D39);
    f64::from(mixed ^ (mixed >> 15)) / f64::from(u32::MAX)
}
