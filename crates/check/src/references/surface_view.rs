//! Source: OpenGL Programming Guide, "Lighting Coordinate Systems".

use super::Source::Published;
use super::ReferenceEntry;
use glam::DVec3;

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "surface::view",
    functions: &[
        ("view_local", Published, |a| (-a.vec3()).try_normalize().unwrap_or(DVec3::Z).into()),
        ("view_infinite", Published, |_| DVec3::Z.into()),
    ],
};
