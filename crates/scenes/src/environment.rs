//! Environments with a high dynamic range, from formulas.

use glam::DVec3;

use super::interior::interior_light;

/// Radiance by unit direction.
pub type Environment = fn(DVec3) -> DVec3;

/// Environments by formula: name, what it is, radiance.
pub const ENVIRONMENTS: &[(&str, &str, Environment)] = &[
    ("studio", "a grey room with a large soft box, a strip light and a warm lamp", studio_sky),
    ("daylight", "a blue sky with a sun over brown earth", daylight_sky),
    ("dusk", "the studio with its lamps dimmed, so that white surfaces are not clipped", dusk_sky),
    ("parlour", "a room with windows, pictures and an open door", interior_light),
    ("checks", "a studio with a wall of coloured and black squares", checks_sky),
    ("constant", "radiance 1 from everywhere", constant_sky),
];

pub fn environment(name: &str) -> Option<Environment> {
    ENVIRONMENTS.iter().find(|(known, _, _)| *known == name).map(|(_, _, environment)| *environment)
}

fn constant_sky(_: DVec3) -> DVec3 {
    DVec3::ONE
}

fn studio_sky(d: DVec3) -> DVec3 {
    let wall =
        DVec3::new(0.16, 0.17, 0.2).lerp(DVec3::new(0.42, 0.44, 0.48), smoothstep(-0.6, 0.9, d.y));
    let floor = DVec3::new(0.11, 0.1, 0.09);
    let room = floor.lerp(wall, smoothstep(-0.25, -0.05, d.y));
    room + softbox_light(d, DVec3::new(-0.6, 0.65, 0.45), (0.45, 0.35)) * DVec3::new(5.5, 5.4, 5.2)
        + softbox_light(d, DVec3::new(0.95, 0.25, -0.1), (0.1, 0.6)) * DVec3::new(2.2, 2.6, 3.4)
        + softbox_light(d, DVec3::new(0.5, 0.1, -0.9), (0.07, 0.07)) * DVec3::new(4.2, 2.4, 1.1)
}

/// 1 inside a rectangle as seen from the origin, 0 outside, with a soft rim between.
fn softbox_light(d: DVec3, towards: DVec3, half: (f64, f64)) -> f64 {
    let forward = towards.normalize();
    let right = forward.cross(DVec3::Y).normalize();
    let depth = d.dot(forward);
    if depth <= 0.0 {
        return 0.0;
    }
    let inside = |place: f64, half: f64| 1.0 - smoothstep(half, 1.25 * half, (place / depth).abs());
    inside(d.dot(right), half.0) * inside(d.dot(right.cross(forward)), half.1)
}

fn dusk_sky(d: DVec3) -> DVec3 {
    0.52 * studio_sky(d)
}

/// The studio, with squares of 12 degrees on the side that viewers look at.
fn checks_sky(d: DVec3) -> DVec3 {
    const SQUARE: f64 = 0.2;
    const COLORS: [DVec3; 4] = [
        DVec3::new(0.9, 0.86, 0.78),
        DVec3::new(0.85, 0.24, 0.1),
        DVec3::new(0.9, 0.86, 0.78),
        DVec3::new(0.06, 0.36, 0.5),
    ];
    let (around, up) = (d.x.atan2(-d.z), d.y.clamp(-1.0, 1.0).asin());
    let wall = 1.0 - smoothstep(1.2, 1.25, around.abs());
    let wall = wall * (1.0 - smoothstep(0.8, 0.82, up.abs()));
    let (column, row) = ((around / SQUARE).floor(), (up / SQUARE).floor());
    let is_dark = (column + row).rem_euclid(2.0) == 0.0;
    let color = COLORS[(column + 3.0 * row).rem_euclid(8.0) as usize / 2];
    let squares = if is_dark { DVec3::splat(0.025) } else { color };
    studio_sky(d).lerp(squares, wall)
}

fn daylight_sky(d: DVec3) -> DVec3 {
    let sun = DVec3::new(-0.45, 0.6, 0.5).normalize();
    let zenith = DVec3::new(0.18, 0.36, 0.8);
    let horizon = DVec3::new(0.75, 0.82, 0.9);
    let sky = horizon.lerp(zenith, d.y.max(0.0).powf(0.5));
    let earth = DVec3::new(0.26, 0.2, 0.14);
    let glow = d.dot(sun).max(0.0);
    let shine = DVec3::new(1.0, 0.9, 0.7) * (18.0 * glow.powf(600.0) + 0.35 * glow.powf(8.0));
    earth.lerp(sky + shine, smoothstep(-0.06, 0.02, d.y))
}

fn smoothstep(low: f64, high: f64, x: f64) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
