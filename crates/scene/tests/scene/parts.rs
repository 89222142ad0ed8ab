//! Cascades of shadow maps: where they end, and the spheres that they fit around.

use glam::DVec3;
use lamplight_scene as scene;

use super::Outcome;
use lamplight_testing::numbers::near;

/// Cascades are split evenly, logarithmically, or by a mix of both.
pub fn cascades() -> Outcome {
    let even = scene::cascade_splits(1.0, 101.0, 4, 0.0);
    if even != [26.0, 51.0, 76.0, 101.0] {
        return Err(format!("even splits should be 26, 51, 76, 101, found {even:?}").into());
    }
    let logarithmic = scene::cascade_splits(1.0, 10_000.0, 4, 1.0);
    for (found, wanted) in logarithmic.iter().zip([10.0, 100.0, 1000.0, 10_000.0]) {
        near("logarithmic", *found, wanted, 1e-9)?;
    }
    let mixed = scene::cascade_splits(0.1, 250.0, 5, 0.7);
    if mixed.is_sorted() && mixed.last() == Some(&250.0) && mixed[0] > 0.1 {
        Ok(())
    } else {
        Err(format!("mixed splits should rise from above 0.1 to 250, found {mixed:?}").into())
    }
}

/// The sphere around a slice of a frustum has all its corners, and no smaller one around a point of
/// the view axis does.
pub fn spheres() -> Outcome {
    for (from, to, tangents) in
        [(0.3, 4.0, [0.6, 0.4]), (4.0, 9.0, [0.2, 0.3]), (2.0, 3.0, [1.5, 1.1])]
    {
        let (centre, radius) = scene::bounding_sphere(from, to, tangents);
        let corner = |depth: f64| DVec3::new(tangents[0] * depth, tangents[1] * depth, depth);
        let needed = |centre: f64| {
            let middle = DVec3::Z * centre;
            corner(from).distance(middle).max(corner(to).distance(middle))
        };
        near("radius", radius, needed(centre), 1e-12)?;
        for other in [0.99 * centre, 1.01 * centre] {
            if needed(other) < radius {
                return Err(
                    format!("a sphere around {other} is smaller than that of {centre}").into()
                );
            }
        }
    }
    Ok(())
}
