//! The casters as a near light sees them: what a picture of the depth map shows.

use glam::DVec3;

use super::{Lamp, Scene, Set, casters};

/// The scene, for the table of all.
pub const SET: Set = Set {
    name: "screen",
    about: "one triangle that covers the picture, before it the casters without their floor as the light sees them",
    make: scene,
};

/// The scene itself.
pub fn scene() -> Scene {
    let mut scene = casters::scene();
    scene.objects.remove(casters::FLOOR);
    if let Some(key) = scene.lamps.first_mut() {
        *key = Lamp { position: DVec3::new(-2.2, 5.4, 5.6), half_angle: 0.44, ..*key };
    }
    scene
}
