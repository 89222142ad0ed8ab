//! A room with windows and a polished floor, whose walls are the environment.

use glam::{DMat4, DVec3};

use super::floor::tiles;
use super::palette::{self, CHALK, CORAL};
use super::{Eye, Lamp, LampKind, Layers, Material, Object, Scene, Set, base_scene, placed_at};
use crate::interior::{self, Panel, RoomSide};
use crate::shape::Shape;

/// The entry in the list of all scenes.
pub const SET: Set = Set {
    name: "parlour",
    about: "a ball, a ring and a block on the polished floor of a room with windows",
    make: scene,
};

/// Metal with this roughness.
fn metal(roughness: f64) -> Material {
    let layers = Some(Layers { metallic: 1.0, ..Layers::default() });
    Material { roughness, layers, ..Material::default() }
}

/// Polished stone or lacquer.
fn polished(roughness: f64) -> Material {
    let layers = Some(Layers { ior: 1.7, ..Layers::default() });
    Material { roughness, layers, ..Material::default() }
}

/// A panel of a wall as it is drawn: only its own light is seen.
fn wall_panel((index, panel): (usize, &Panel)) -> Object {
    // Later panels are in front of earlier ones.
    let depth = 1e-3 * index as f64;
    let (mut along, up) = (
        panel.side.place(glam::DVec2::X * (panel.high.x - panel.low.x), 0.0)
            - panel.side.place(glam::DVec2::ZERO, 0.0),
        panel.side.place(glam::DVec2::Y * (panel.high.y - panel.low.y), 0.0)
            - panel.side.place(glam::DVec2::ZERO, 0.0),
    );
    let mut corner = panel.side.place(panel.low, depth);
    if panel.side.is_left_handed() {
        (corner, along) = (corner + along, -along);
    }
    let layers = Some(Layers { specular: 0.0, ..Layers::default() });
    let material = Material { emission: panel.color, layers, ..Material::default() };
    let shape = Shape::patch(corner, along, up, (1, 1));
    Object::new(shape, DMat4::IDENTITY, DVec3::ZERO).of(material, 7)
}

pub fn scene() -> Scene {
    let floor = tiles(interior::TILES_ALONG, 1.0, [CHALK * 0.4, CHALK * 0.12], 2);
    let floor = floor.map(|vertex| vertex.position.x *= 0.8);
    let ring = placed_at(0.95, 0.98, 1.1, -0.5) * DMat4::from_rotation_x(1.4);
    let gold = DVec3::new(1.0, 0.71, 0.29);
    let mut objects = vec![
        Object::new(floor, DMat4::IDENTITY, DVec3::ONE).of(polished(0.08), 7),
        Object::new(Shape::sphere(0.95, (72, 36)), placed_at(-1.3, 0.95, 0.2, 0.0), CHALK * 1.2)
            .of(metal(0.05), 5),
        Object::new(Shape::torus(0.74, 0.24, (72, 32)), ring, gold).of(metal(0.2), 1),
        Object::new(
            Shape::cuboid(DVec3::new(0.6, 1.2, 0.6), 1),
            placed_at(2.1, 1.2, -1.2, 0.6),
            CORAL * 0.6,
        )
        .of(polished(0.12), 0),
    ];
    let panels = interior::panels();
    let seen = panels.iter().enumerate();
    let seen = seen.filter(|(_, panel)| !matches!(panel.side, RoomSide::Floor | RoomSide::Front));
    objects.extend(seen.map(wall_panel).map(|object| Object { casts: false, ..object }));
    let eye = Eye {
        position: DVec3::new(0.35, 1.9, 4.9),
        target: DVec3::new(0.1, 1.25, -1.0),
        fov_y: 0.78,
        near: 0.3,
        far: 40.0,
    };
    let key = Lamp {
        color: DVec3::new(1.0, 0.85, 0.65),
        position: DVec3::new(0.0, 4.3, -1.0),
        target: DVec3::new(0.0, 0.0, 0.4),
        half_angle: 0.7,
        kind: LampKind::Point,
    };
    Scene {
        around: Some("parlour"),
        room: Some([interior::LOW, interior::HIGH, interior::CENTRE]),
        ..base_scene(objects, eye, palette::lamps(key, 3.0, 3.0, 0.2))
    }
}
