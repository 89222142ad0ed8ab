//! Low hills of triangles that can be told apart, under a lamp that is seen: what shading by face,
//! vertex and fragment makes of them.

use glam::{DMat4, DVec2, DVec3};

use super::palette;
use super::{
    Eye, Lamp, LampKind, Maps, Material, Object, Scene, Set, TextureMap, base_scene, maps,
};
use crate::shape::Shape;

/// Quads along each side, and the side, scene units.
const CELLS: u32 = 24;
const SIDE: f64 = 15.0;
/// How often the texture is repeated along each side.
const TIMES: f64 = 3.0;

/// The entry in the list of all scenes.
pub const SET: Set = Set {
    name: "hills",
    about: "low hills of triangles under a lamp that is seen, so that faces and corners can be told apart",
    make: scene,
};

fn hill_height(x: f64, z: f64) -> f64 {
    0.55 * (0.9 * x + 0.4).sin() * (0.8 * z - 0.3).cos() + 0.25 * (0.5 * x - 1.1 * z).sin()
}

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
    Maps { base: earth_map(512), ..maps::bricks() }
}

/// Earth with patches of grass, of so many texels along an edge.
pub(super) fn earth_map(side: usize) -> TextureMap {
    TextureMap::of(side, |at| {
        let lumpy_noise = |cells| 0.5 + 0.5 * maps::value_noise(at, cells);
        let fine = lumpy_noise(60);
        let tone = 0.8 + 0.25 * fine + 0.15 * lumpy_noise(170);
        let lumps = 0.6 * lumpy_noise(5) + 0.4 * lumpy_noise(14);
        let grass = ((lumps + 0.25 * (fine - 0.5) - 0.46) / 0.1).clamp(0.0, 1.0);
        let color = DVec3::new(0.6, 0.45, 0.3).lerp(DVec3::new(0.34, 0.45, 0.16), grass);
        (color * tone).extend(1.0)
    })
}
