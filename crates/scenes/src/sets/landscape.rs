//! A height map with a lamp above its middle: the scene of a published tutorial.

use glam::{DMat4, DVec2, DVec3, DVec4};

use super::palette;
use super::{
    Eye, Lamp, LampKind, Maps, Material, Object, Scene, Set, TextureMap, base_scene,
};
use crate::shape::Shape;
use lamplight_scene::smooth_normals;

/// The entry in the list of all scenes.
pub const SET: Set = Set {
    name: "landscape",
    about: "a height map with a lamp above its middle, as a whole",
    make: scene,
};

/// Newcastle University, Graphics for Games, tutorial 11, has the lamp above the middle, and a camera
/// that sees 45 degrees. It begins as high as the lamp, above the middle of an edge. From there, the
/// dark corners behind it are not seen, so ours is farther away.
const HEIGHT: f64 = 2.6;
const FOV: f64 = std::f64::consts::FRAC_PI_4;
const AWAY: DVec3 = DVec3::new(0.0, 8.6, 15.2);
/// Our own: quads along each side, the side, and how often the texture is repeated.
const CELLS: u32 = 32;
const SIDE: f64 = 15.0;
const TIMES: f64 = 3.0;

fn land_height(x: f64, z: f64) -> f64 {
    0.75 * (0.9 * x + 0.4).sin() * (0.8 * z - 0.3).cos() + 0.3 * (0.5 * x - 1.1 * z).sin()
}

/// The land, with the normals that the tutorial computes: sums over the faces of a corner.
fn land_shape() -> Shape {
    let at = |u: f64, v: f64| {
        let (x, z) = (SIDE * (u - 0.5), SIDE * (0.5 - v));
        DVec3::new(x, land_height(x, z), z)
    };
    let mut land = Shape::surface(CELLS, CELLS, at).tiled(DVec2::splat(TIMES));
    let positions: Vec<DVec3> = land.vertices.iter().map(|vertex| vertex.position).collect();
    // The indices are those of the shape, so there is a normal for each corner.
    let normals = smooth_normals(&positions, Some(&land.indices)).unwrap_or_default();
    for (vertex, normal) in land.vertices.iter_mut().zip(normals) {
        vertex.normal = normal;
    }
    land
}

pub fn scene() -> Scene {
    let matt = Material::default().glossy(0.3).shiny(30.0);
    let middle = DVec3::Y * HEIGHT;
    let key = Lamp {
        color: DVec3::ONE,
        position: middle,
        target: DVec3::ZERO,
        half_angle: 0.7,
        kind: LampKind::Point,
    };
    let eye =
        Eye { position: AWAY, target: DVec3::new(0.0, -0.4, 0.4), fov_y: FOV, near: 0.5, far: 60.0 };
    let objects = vec![Object::new(land_shape(), DMat4::IDENTITY, DVec3::ONE).of(matt, 12)];
    let scene = base_scene(objects, eye, palette::lamps(key, 4.0, HEIGHT, 0.4));
    Scene { maps: land_textures, ..scene }
}

/// Earth with patches of grass. The other maps are blank.
fn land_textures() -> Maps {
    let blank = |texel: DVec4| TextureMap::of(1, move |_| texel);
    Maps {
        base: super::hills::earth_map(256),
        normal: blank(DVec4::new(0.5, 0.5, 1.0, 1.0)),
        occlusion: blank(DVec4::ONE),
        light: blank(DVec4::ONE),
        material: std::collections::BTreeMap::new(),
        single: std::collections::BTreeSet::new(),
    }
}
