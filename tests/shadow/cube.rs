//! Shadows of point lights.

use glam::DVec3;
use lamplight::execute::fixture::{FixtureTexture, TextureKind};

use super::{Run, comparing, reversal};

/// Directions within an octant. Each is nearest to another axis, so it falls on another face.
const SHAPES: [DVec3; 3] =
    [DVec3::new(1.0, 0.6, 0.5), DVec3::new(0.5, 1.0, 0.6), DVec3::new(0.6, 0.5, 1.0)];

/// A point light with an occluder in one octant: only points behind the occluder are dark.
pub fn cube_octants(run: &mut Run<'_>) -> Result<(), String> {
    const SIDE: u32 = 8;
    let (near, far) = (0.1, 20.0);
    let depth = |distance: f64| far / (far - near) * (1.0 - near / distance);
    let octant = |index: u32| {
        DVec3::from_array([0, 1, 2].map(|axis| if index & (1 << axis) == 0 { 1.0 } else { -1.0 }))
    };
    let within = |p: DVec3, index: u32| (p * octant(index)).min_element() > 0.0;
    for reversed in [false, true] {
        let (held, compare) = reversal(reversed);
        for covered in 0..8 {
            let texel = |face: u32, x: u32, y: u32| {
                let place = |index: u32| (f64::from(index) + 0.5) / f64::from(SIDE) * 2.0 - 1.0;
                let towards = face_direction(face, place(x), place(y));
                held(if within(towards, covered) { depth(2.0) } else { 1.0 }) as f32
            };
            let texels = (0..6)
                .flat_map(|face| (0..SIDE * SIDE).map(move |i| texel(face, i % SIDE, i / SIDE)))
                .collect();
            let map =
                FixtureTexture { kind: TextureKind::DepthCube, width: SIDE, height: SIDE, texels };
            let (mut rows, mut expected) = (Vec::new(), Vec::new());
            for (index, distance) in
                (0..8).flat_map(|index| [1.0, 1.99, 2.01, 4.0].map(|distance| (index, distance)))
            {
                for shape in SHAPES {
                    let offset = (octant(index) * shape * distance).to_array();
                    let rest = [near, far, f64::from(u8::from(reversed))];
                    rows.push(offset.into_iter().chain(rest).map(|value| value as f32).collect());
                    expected.push(f64::from(u8::from(!(index == covered && distance > 2.0))));
                }
            }
            let found = run.call("cube", Some((map, comparing(compare, true))), &rows)?;
            if found != expected {
                return Err(format!(
                    "reversed {reversed}, octant {covered}: found {found:?}, expected {expected:?}"
                ));
            }
        }
    }
    Ok(())
}

/// The direction of a place on a face of a cube map. `x` runs to the right and `y` down, both from
/// -1 to 1.
fn face_direction(face: u32, x: f64, y: f64) -> DVec3 {
    match face {
        0 => DVec3::new(1.0, -y, -x),
        1 => DVec3::new(-1.0, -y, x),
        2 => DVec3::new(x, 1.0, y),
        3 => DVec3::new(x, -1.0, -y),
        4 => DVec3::new(x, -y, 1.0),
        _ => DVec3::new(-x, -y, -1.0),
    }
}
