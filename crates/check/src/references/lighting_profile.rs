//! Sources: IES LM-63; Segal et al., 1992, section 3.

use super::Source::{Published, Specification};
use super::{CallArguments, Expected, ReferenceEntry};
use glam::DVec3;
use std::f64::consts::PI;

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "lighting::profile",
    functions: &[
        ("ies_u", Specification, |a| (a.f64().clamp(-1.0, 1.0).acos() / PI).into()),
        ("ies_uv", Specification, ies_uv),
        ("cookie_uv", Published, cookie_uv),
    ],
};

/// The polar angle to the axis over pi, and the azimuth around it over 2 pi.
fn ies_uv(a: &mut CallArguments<'_>) -> Expected {
    let (away, axis, right) = (-a.vec3(), a.vec3(), a.vec3());
    let vertical = away.dot(axis).clamp(-1.0, 1.0).acos() / PI;
    let (x, y) = (away.dot(right), away.dot(axis.cross(right)));
    if x * x + y * y <= 1e-30 {
        return Expected::words([vertical, 0.0]);
    }
    let turn = y.atan2(x) / (2.0 * PI);
    // Azimuths of 0 and of a full turn are the same. Rounding decides which of them results, so
    // either is accepted.
    let found = Expected::words([vertical, turn.rem_euclid(1.0)]);
    found.or(Expected::words([vertical, turn])).or(Expected::words([vertical, turn + 1.0]))
}

/// The homogeneous point divided by its last coordinate.
fn cookie_uv(a: &mut CallArguments<'_>) -> Expected {
    let (p, m) = (a.vec3(), a.mat4());
    let q = m * p.extend(1.0);
    let seen = q.w > f64::from(1e-30f32);
    if seen { DVec3::new(q.x / q.w, q.y / q.w, 1.0).into() } else { DVec3::ZERO.into() }
}
