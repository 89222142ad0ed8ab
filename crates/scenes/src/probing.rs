//! The light probes that a scene asks for.

use glam::DVec3;

/// The light probes of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Probes {
    /// How many there are along each axis of the world.
    pub counts: [u32; 3],
    /// What they see where the scene ends.
    pub beyond: DVec3,
}

impl Default for Probes {
    fn default() -> Self {
        Self { counts: [8, 5, 8], beyond: DVec3::new(0.12, 0.14, 0.18) }
    }
}
