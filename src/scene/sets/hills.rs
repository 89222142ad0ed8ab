//! A coarse field of heights from nearby: what shading by face, vertex and fragment makes of it.

use glam::DVec3;

use super::{Eye, Scene, Set, terrain};

/// The scene, for the table of all.
pub const SET: Set = Set {
    name: "hills",
    about: "a coarse field of heights from nearby, so that its faces and corners can be told apart",
    make: scene,
};

/// The scene itself.
pub fn scene() -> Scene {
    let eye = Eye {
        position: DVec3::new(2.4, 4.4, 7.6),
        target: DVec3::new(0.2, 0.1, 0.4),
        fov_y: 0.6,
        near: 0.5,
        far: 60.0,
    };
    terrain::field(26, eye)
}
