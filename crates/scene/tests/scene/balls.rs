//! Light probes, by the mirror's law and by what comes back of a sky.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use lamplight_scene::{
    Equirect, MirrorBall, ProbeMapping, directions, irradiance_sh9, sh9_project,
};
use lamplight_testing::numbers::{near, near_vector};

use super::Outcome;

const MAPPINGS: [ProbeMapping; 2] = [ProbeMapping::Photograph, ProbeMapping::Angular];

/// A sky that differs in every direction.
fn sky(d: DVec3) -> DVec3 {
    DVec3::new(1.0 + d.x, 1.0 + d.y, 1.0 + d.z * d.x)
}

/// A photograph shows in each pixel what the surface of a ball of radius 1 mirrors there. Debevec's
/// probes show each direction where his formula puts it.
pub fn mirror() -> Outcome {
    let side = 64;
    let blank = |mapping| MirrorBall::of(&sky, mapping, side).ok_or("no picture");
    let (photograph, angular) = (blank(ProbeMapping::Photograph)?, blank(ProbeMapping::Angular)?);
    for (column, row) in (0..side).flat_map(|row| (0..side).map(move |column| (column, row))) {
        let at = |index: usize| (2 * index + 1) as f64 / side as f64 - 1.0;
        let place = DVec2::new(at(column), -at(row));
        let height = 1.0 - place.length_squared();
        let found = (photograph.direction(column, row), angular.direction(column, row));
        let (Some(mirrored), Some(direction)) = found else {
            match (found, height < 0.0) {
                ((None, None), true) => continue,
                _ => return Err(format!("{found:?} at {place}").into()),
            }
        };
        let n = place.extend(height.sqrt());
        near_vector("mirrored", mirrored, DVec3::NEG_Z.reflect(n), 1e-9)?;
        let radius = direction.z.acos() / PI / direction.truncate().length();
        near_vector(
            "the probe",
            (direction.truncate() * radius).extend(0.0),
            place.extend(0.0),
            1e-9,
        )?;
    }
    let middle = photograph.radiance(DVec3::Z);
    near_vector("back to the camera", middle, sky(DVec3::Z), 0.05)?;
    near_vector("to the right", angular.radiance(DVec3::X), sky(DVec3::X), 0.05)?;
    near_vector("above", photograph.radiance(DVec3::Y), sky(DVec3::Y), 0.05)
}

/// A sky comes back from a picture of a ball, but for a few degrees around the direction behind it.
pub fn round_trip() -> Outcome {
    for mapping in MAPPINGS {
        let ball = MirrorBall::of(&sky, mapping, 256).ok_or("no picture")?;
        let image = Equirect::from_mirror_ball(&ball, 256, 128).ok_or("no image")?;
        for (direction, _, found) in image.samples() {
            let error = if direction.z < -0.98 { 0.25 } else { 0.02 };
            near_vector(&format!("{mapping:?} {direction}"), found, sky(direction), error)?;
        }
        let wanted = sh9_project(directions(64).into_iter().map(|(d, angle)| (d, angle, sky(d))));
        let found = sh9_project(image.samples());
        for n in [DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z, DVec3::new(0.6, 0.0, -0.8)] {
            let irradiance = irradiance_sh9(n, &wanted);
            near_vector("irradiance", irradiance_sh9(n, &found), irradiance, 0.02)?;
        }
        near("the rim", ball.radiance(DVec3::NEG_Z).y, 1.0, 0.25)?;
    }
    match MirrorBall::new(ProbeMapping::Angular, 2, vec![DVec3::ZERO; 3]) {
        None => Ok(()),
        Some(_) => Err("a picture with too few pixels was accepted".into()),
    }
}
