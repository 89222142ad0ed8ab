//! Colours, lamps and materials that scenes choose from.

use glam::DVec3;

use super::sets::{Lamp, LampKind, Material};

pub const CORAL: DVec3 = DVec3::new(0.82, 0.26, 0.2);
pub const AMBER: DVec3 = DVec3::new(0.86, 0.52, 0.13);
pub const LEAF: DVec3 = DVec3::new(0.33, 0.58, 0.2);
pub const TEAL: DVec3 = DVec3::new(0.1, 0.5, 0.55);
pub const INDIGO: DVec3 = DVec3::new(0.22, 0.27, 0.7);
pub const CHALK: DVec3 = DVec3::new(0.78, 0.76, 0.72);
pub const SLATE: DVec3 = DVec3::new(0.3, 0.32, 0.36);

/// Fourteen materials, each with one for its back side.
pub fn materials() -> Vec<[Material; 2]> {
    const FRONTS: [(DVec3, f64, f64); 14] = [
        (DVec3::new(0.75, 0.08, 0.07), 0.6, 60.0),
        (DVec3::new(0.75, 0.6, 0.2), 0.6, 50.0),
        (DVec3::new(0.07, 0.5, 0.22), 0.5, 77.0),
        (DVec3::new(0.4, 0.24, 0.12), 0.05, 8.0),
        (DVec3::new(0.12, 0.3, 0.75), 0.7, 90.0),
        (DVec3::new(0.5, 0.5, 0.52), 0.8, 52.0),
        (DVec3::new(0.7, 0.27, 0.08), 0.3, 13.0),
        (DVec3::new(0.6, 0.6, 0.58), 0.1, 6.0),
        (DVec3::new(0.03, 0.03, 0.035), 0.5, 32.0),
        (DVec3::new(0.1, 0.55, 0.55), 0.4, 40.0),
        (DVec3::new(0.45, 0.12, 0.5), 0.5, 70.0),
        (DVec3::new(0.8, 0.72, 0.6), 0.2, 20.0),
        (DVec3::new(0.35, 0.55, 0.1), 0.1, 12.0),
        (DVec3::new(0.75, 0.35, 0.45), 0.35, 30.0),
    ];
    let material = |(color, specular, shininess): (DVec3, f64, f64)| {
        Material { ambient: color, diffuse: color, ..Material::default() }
            .glossy(specular)
            .shiny(shininess)
    };
    let back = |index: usize| material(FRONTS[(index + 4) % FRONTS.len()]);
    FRONTS.iter().enumerate().map(|(index, front)| [material(*front), back(index)]).collect()
}

/// Lamps for shapes that float in space. The first one is a directional light from beside the
/// viewer.
pub fn over_the_shoulder() -> Vec<Lamp> {
    let key = Lamp {
        color: DVec3::splat(0.95),
        position: DVec3::new(-3.5, 5.5, 6.5),
        target: DVec3::ZERO,
        half_angle: 0.5,
        kind: LampKind::Directional,
    };
    lamps(key, 5.0, 4.0, 0.22)
}

/// Ten lamps: the given key light, then coloured ones on a ring around its target.
pub fn lamps(key: Lamp, radius: f64, height: f64, share: f64) -> Vec<Lamp> {
    const COLORS: [DVec3; 9] = [
        DVec3::new(1.0, 0.35, 0.25),
        DVec3::new(0.3, 0.55, 1.0),
        DVec3::new(0.35, 0.95, 0.4),
        DVec3::new(1.0, 0.75, 0.25),
        DVec3::new(0.8, 0.3, 0.95),
        DVec3::new(0.25, 0.9, 0.95),
        DVec3::new(1.0, 0.5, 0.7),
        DVec3::new(0.6, 0.8, 0.3),
        DVec3::new(0.9, 0.9, 0.9),
    ];
    const KINDS: [LampKind; 3] = [LampKind::Point, LampKind::Spot, LampKind::Spot];
    let ring = COLORS.iter().enumerate().map(|(index, color)| {
        // Placed by the golden angle, so that any number of lamps is spread evenly.
        let (sin, cos) = (2.399_963 * index as f64 + 0.6).sin_cos();
        let kind = KINDS[index % KINDS.len()];
        let place = key.target + DVec3::new(cos, 0.0, sin) * radius * (0.55 + 0.05 * index as f64);
        Lamp {
            // A point light also reaches what a spot light leaves dark, so it is dimmer.
            color: *color * share * if kind == LampKind::Point { 0.25 } else { 1.0 },
            position: DVec3::new(place.x, height, place.z),
            target: DVec3::new(place.x, key.target.y, place.z),
            half_angle: 0.5,
            kind,
        }
    });
    std::iter::once(key).chain(ring).collect()
}
