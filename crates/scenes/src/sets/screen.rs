//! The objects of the scene `casters` without the floor, as a near light sees them: what a picture
//! of the depth map shows.

use glam::DVec3;

use super::{Lamp, Scene, Set, casters};

/// The entry in the list of all scenes.
pub const SET: Set = Set {
    name: "screen",
    about: "one triangle that covers the picture, before it the casters without their floor as the light sees them",
    make: scene,
};

pub fn scene() -> Scene {
    let mut scene = casters::scene();
    scene.objects.remove(casters::FLOOR);
    if let Some(key) = scene.lamps.first_mut() {
        let (position, target) = (DVec3::new(-1.4, 6.6, 7.4), DVec3::new(-0.1, 0.9, 0.4));
        *key = Lamp { position, target, half_angle: 0.44, ..*key };
    }
    scene
}
