//! An occluder between a light and points that the light reaches, for lights from every side.

use glam::{DMat4, DVec3, DVec4};
use lamplight::execute::fixture::{Compare, FixtureTexture, TextureKind};

use super::{Run, comparing, depths, flip, plain};

/// An occluder covers the upper left quarter of the map, seen from the light. Points in all quarters,
/// in front of it and behind it, are lit or dark as they should be. This is tested with plain and with
/// reversed depth.
fn covered(
    run: &mut Run<'_>,
    view: DMat4,
    projection: DMat4,
    planes: [f64; 3],
) -> Result<(), String> {
    let depth_at = |z: f64| {
        let clip = projection * DVec4::new(0.0, 0.0, -z, 1.0);
        clip.z / clip.w
    };
    for reversed in [false, true] {
        let matrix = if reversed { flip() * projection * view } else { projection * view };
        let (stored, cleared) =
            if reversed { (1.0 - depth_at(planes[1]), 0.0) } else { (depth_at(planes[1]), 1.0) };
        let map = depths(16, |u, v| if u < 0.5 && v < 0.5 { stored } else { cleared });
        let sampler =
            comparing(if reversed { Compare::GreaterEqual } else { Compare::LessEqual }, true);
        let (mut rows, mut expected) = (Vec::new(), Vec::new());
        for (x, y, z) in places(planes) {
            // The point in the world that the shader maps to this place and distance.
            let depth = DVec4::new(0.0, 0.0, -z, 1.0);
            let w = (projection * depth).w;
            let ndc = DVec4::new(x * w, y * w, depth_at(z) * w, w);
            let point = (projection * view).inverse() * ndc;
            let point = point.truncate() / point.w;
            rows.push(
                matrix
                    .to_cols_array()
                    .into_iter()
                    .chain(point.to_array())
                    .map(|value| value as f32)
                    .collect(),
            );
            expected.push(f64::from(u8::from(!(x < 0.0 && y > 0.0 && z > planes[1]))));
        }
        let found = run.call("lit", Some((map, sampler)), &rows)?;
        if found != expected {
            return Err(format!("reversed {reversed}: found {found:?}, expected {expected:?}"));
        }
    }
    Ok(())
}

/// The centres of the quarters, in front of and behind the occluder.
fn places(planes: [f64; 3]) -> impl Iterator<Item = (f64, f64, f64)> {
    let sides = [-0.5, 0.5];
    let corners = sides.into_iter().flat_map(move |x| sides.into_iter().map(move |y| (x, y)));
    corners.flat_map(move |(x, y)| [planes[0], planes[2]].into_iter().map(move |z| (x, y, z)))
}

/// The view matrix of an eye. In view space the eye looks along -z.
pub fn look_at(eye: DVec3, target: DVec3, up: DVec3) -> DMat4 {
    let back = (eye - target).normalize();
    let right = up.cross(back).normalize();
    let world = DMat4::from_cols(
        right.extend(0.0),
        back.cross(right).extend(0.0),
        back.extend(0.0),
        eye.extend(1.0),
    );
    world.inverse()
}

/// The projection of a box from `-half` to `half`. Depth is 0 at the near plane and 1 at the far.
pub fn orthographic(half: f64, near: f64, far: f64) -> DMat4 {
    let depth = 1.0 / (near - far);
    DMat4::from_cols(
        DVec4::X / half,
        DVec4::Y / half,
        DVec4::Z * depth,
        DVec4::new(0.0, 0.0, near * depth, 1.0),
    )
}

/// The projection of a square frustum. Depth is 0 at the near plane and 1 at the far.
fn perspective(angle: f64, near: f64, far: f64) -> DMat4 {
    let (scale, depth) = (1.0 / (angle / 2.0).tan(), far / (near - far));
    DMat4::from_cols(
        DVec4::X * scale,
        DVec4::Y * scale,
        DVec4::new(0.0, 0.0, depth, -1.0),
        DVec4::Z * near * depth,
    )
}

/// Directional light from every octant and along the axes.
pub fn octants(run: &mut Run<'_>) -> Result<(), String> {
    let signs = [-1.0, 1.0];
    let octants = signs.into_iter().flat_map(|x| {
        signs.into_iter().flat_map(move |y| signs.into_iter().map(move |z| DVec3::new(x, y, z)))
    });
    for octant in
        octants.chain([DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z])
    {
        let direction = (octant * DVec3::new(0.6, 0.7, 0.4)).normalize();
        let up = if direction.y.abs() > 0.9 { DVec3::Z } else { DVec3::Y };
        let view = look_at(direction * 10.0, DVec3::ZERO, up);
        let projection = orthographic(4.0, 0.1, 20.0);
        covered(run, view, projection, [6.0, 8.0, 12.0])
            .map_err(|error| format!("light from {direction}: {error}"))?;
    }
    Ok(())
}

pub fn spot(run: &mut Run<'_>) -> Result<(), String> {
    let view = look_at(DVec3::new(3.0, 5.0, -2.0), DVec3::new(0.5, 0.0, 0.25), DVec3::Y);
    covered(run, view, perspective(1.2, 0.5, 30.0), [2.0, 4.0, 9.0])
}

/// With a map that is covered everywhere, points inside the frustum are dark. Points on every side of
/// it, and behind the light, are lit.
pub fn outside_is_lit(run: &mut Run<'_>) -> Result<(), String> {
    const CLIPS: &[([f32; 4], f32, f64)] = &[
        ([0.0, 0.0, 0.5, 1.0], 0.0, 0.0),
        ([0.9, -0.9, 1.0, 2.0], 0.0, 0.0),
        ([0.99, 0.99, 0.99, 1.0], 0.0, 0.0),
        ([1.01, 0.0, 0.5, 1.0], 0.0, 1.0),
        ([-1.01, 0.0, 0.5, 1.0], 0.0, 1.0),
        ([0.0, 1.01, 0.5, 1.0], 0.0, 1.0),
        ([0.0, -1.01, 0.5, 1.0], 0.0, 1.0),
        ([0.0, 0.0, 1.01, 1.0], 0.0, 1.0),
        ([0.0, 0.0, -0.01, 1.0], 0.0, 1.0),
        ([0.0, 0.0, -0.5, -1.0], 0.0, 1.0),
        ([0.0, 0.0, 0.0, 0.0], 0.0, 1.0),
        ([0.0, 0.0, 0.5, -0.0], 0.0, 1.0),
        ([0.0, 0.0, 0.5, 1.0], 1.0, 1.0),
        ([0.0, 0.0, 0.5, 1.0], 0.99, 0.0),
        ([f32::MAX, 0.0, 0.5, 1.0], 0.0, 1.0),
        ([0.0, 0.0, 0.5, 1e-39], 0.0, 1.0),
    ];
    let rows: Vec<_> =
        CLIPS.iter().map(|(clip, min_w, _)| [clip.as_slice(), &[*min_w]].concat()).collect();
    let found = run.call(
        "clip",
        Some((depths(4, |_, _| 0.0), comparing(Compare::LessEqual, true))),
        &rows,
    )?;
    let expected: Vec<_> = CLIPS.iter().map(|(_, _, lit)| *lit).collect();
    if found != expected {
        return Err(format!("found {found:?}, expected {expected:?}"));
    }
    // A map of moments, read as in `forward`. The least variance leaves a millionth of the light.
    let map = FixtureTexture {
        kind: TextureKind::Color2d,
        width: 4,
        height: 4,
        texels: [0.0, 0.0, 0.0, 1.0].repeat(16),
    };
    let found = run.call("clip_moments", Some((map, plain(true))), &rows)?;
    let near = |(found, expected): (&f64, &f64)| (found - expected).abs() < 1e-4;
    if found.iter().zip(&expected).all(near) {
        Ok(())
    } else {
        Err(format!("moments: found {found:?}, expected {expected:?}"))
    }
}
