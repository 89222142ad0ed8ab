//! Large shapes around the origin, lit by a lamp on its way around them: the scene of a published
//! shadow map.

use glam::{DMat4, DVec3};

use super::floor::tiles;
use super::palette::{self, AMBER, CHALK, CORAL, TEAL};
use super::{Eye, Lamp, LampKind, Material, Object, Scene, Set, base_scene};
use crate::shape::Shape;

/// The entry in the list of all scenes.
pub const SET: Set = Set {
    name: "orbit",
    about: "a ball, a box and a ring, a hundred units large, under a lamp on its way around them",
    make: scene,
};

/// The time at which the scene of Kessenich, Sellers, Shreiner, OpenGL Programming Guide, 9th
/// edition, 2016, is shown: examples 7.16 and 7.19 move the lamp and turn the shapes with it.
pub const TIME: f64 = 0.03;
/// Example 7.19: the viewer is this far from the origin, and looks straight at it.
const AWAY: f64 = 300.0;
/// Our own: the height of the ground.
const GROUND: f64 = -70.0;

/// Where example 7.16 has the lamp at a time. Its value of pi is its own.
#[expect(clippy::approx_constant, reason = "the example is shown with the pi that it prints")]
pub fn lamp_place(t: f64) -> DVec3 {
    let pi = 3.141_592;
    DVec3::new(300.0 * (t * 6.0 * pi).sin(), 200.0, 100.0 * (t * 4.0 * pi).cos() + 250.0)
}

pub fn scene() -> Scene {
    let turned = DMat4::from_rotation_y((TIME * 720.0).to_radians());
    let at = |x: f64, y: f64, z: f64| DMat4::from_translation(DVec3::new(x, y, z));
    let dim = |material: Material| Material { ambient: DVec3::splat(0.12), ..material };
    let matt = dim(Material::default().glossy(0.05).shiny(64.0));
    let glossy = dim(Material::default().glossy(0.5).shiny(64.0));
    let floor = tiles(12, 60.0, [CHALK * 0.8, CHALK * 0.65], 4);
    let ring = at(10.0, -15.0, 95.0) * DMat4::from_rotation_x(1.15);
    let made = |shape: Shape, place: DMat4, color, material| {
        Object::new(shape, turned * place, color).of(material, 7)
    };
    let objects = vec![
        made(floor, at(0.0, GROUND, 0.0), DVec3::ONE, matt),
        made(Shape::sphere(55.0, (64, 32)), at(-85.0, -15.0, 0.0), CORAL, glossy),
        made(Shape::cuboid(DVec3::new(38.0, 60.0, 38.0), 4), at(80.0, -10.0, 5.0), TEAL, matt),
        made(Shape::torus(42.0, 13.0, (64, 32)), ring, AMBER, glossy),
    ];
    let key = Lamp {
        color: DVec3::ONE,
        position: lamp_place(TIME),
        target: DVec3::ZERO,
        half_angle: 0.7,
        kind: LampKind::Point,
    };
    // A frustum of +-1 at the distance 1 is 90 degrees wide. Pictures are three quarters as high.
    let eye = Eye {
        position: DVec3::Z * AWAY,
        target: DVec3::ZERO,
        fov_y: 2.0 * 0.75_f64.atan(),
        near: 1.0,
        far: 1000.0,
    };
    base_scene(objects, eye, palette::lamps(key, 300.0, 200.0, 0.22))
}
