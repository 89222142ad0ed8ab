//! Ways to keep a surface from shadowing itself, which is called shadow acne.

use glam::{DVec3, DVec4};
use lamplight::execute::fixture::Compare;

use super::lights::{look_at, orthographic};
use super::{Run, comparing, depths, flip, reversal};

/// A receiver at exactly the stored depth is lit. The next f32 numbers above and below it are lit or
/// dark as their side demands.
pub fn equal_depth_is_lit(run: &mut Run<'_>) -> Result<(), String> {
    let map = depths(8, |u, v| (u * 7.31 + v * 3.77).fract() * 0.9 + 0.05);
    for (compare, nearer, farther) in
        [(Compare::LessEqual, 1.0, 0.0), (Compare::GreaterEqual, 0.0, 1.0)]
    {
        let (mut rows, mut expected) = (Vec::new(), Vec::new());
        for (index, stored) in map.texels.iter().enumerate() {
            let (u, v) = ((index % 8) as f32 / 8.0 + 0.0625, (index / 8) as f32 / 8.0 + 0.0625);
            for (depth, lit) in
                [(*stored, 1.0), (stored.next_down(), nearer), (stored.next_up(), farther)]
            {
                rows.push(vec![u, v, depth]);
                expected.push(lit);
            }
        }
        let found = run.call("stored", Some((map.clone(), comparing(compare, false))), &rows)?;
        if let Some(wrong) = (0..rows.len()).find(|index| found[*index] != expected[*index]) {
            return Err(format!(
                "{compare:?} with u, v, depth {:?}: found {}, expected {}",
                rows[wrong], found[wrong], expected[wrong]
            ));
        }
    }
    Ok(())
}

/// A sloped receiver shadows itself without a bias. With a bias of half a texel along its slope it
/// does not, and a receiver well behind it stays dark.
pub fn bias_removes_acne(run: &mut Run<'_>) -> Result<(), String> {
    for slope in [0.1, 0.4, 0.6] {
        let receiver = |u: f64| 0.3 + slope * u;
        let map = depths(16, |u, _| receiver(u));
        let cosine = (1.0 / (1.0 + slope * slope)).sqrt() as f32;
        let places: Vec<f64> = (0..128).map(|i| (f64::from(i) + 0.5) / 128.0).collect();
        let mut dark = |beyond: f64, texels: f32| -> Result<usize, String> {
            let rows: Vec<_> = places
                .iter()
                .map(|u| {
                    vec![*u as f32, 0.5, (receiver(*u) + beyond) as f32, cosine, texels / 16.0]
                })
                .collect();
            let found = run.call(
                "sloped",
                Some((map.clone(), comparing(Compare::LessEqual, false))),
                &rows,
            )?;
            Ok(found.iter().filter(|lit| **lit == 0.0).count())
        };
        let counts = [dark(0.0, 0.0)?, dark(0.0, 0.501)?, dark(0.08, 0.501)?];
        if counts != [64, 0, 128] {
            let what = "of 128 are dark (no bias, bias, behind), expected 64, 0 and 128";
            return Err(format!("slope {slope}: {counts:?} {what}"));
        }
    }
    Ok(())
}

/// A floor under slanting light shadows itself. If the lookup is moved along the normal by three
/// quarters of a texel it does not, and a floor below an occluder stays dark.
pub fn normal_offset_removes_acne(run: &mut Run<'_>) -> Result<(), String> {
    const SIDE: u32 = 16;
    let direction = DVec3::new(0.7, 0.6, 0.3).normalize();
    let plain_matrix =
        orthographic(4.0, 0.1, 20.0) * look_at(direction * 10.0, DVec3::ZERO, DVec3::Y);
    let from_map = plain_matrix.inverse();
    // The depth of the floor: along a ray of parallel light, the height falls linearly with depth.
    let floor = |u: f64, v: f64| {
        let height =
            |depth: f64| (from_map * DVec4::new(2.0 * u - 1.0, 1.0 - 2.0 * v, depth, 1.0)).y;
        height(0.0) / (height(0.0) - height(1.0))
    };
    let texel = 8.0 / f64::from(SIDE);
    for reversed in [false, true] {
        let (held, compare) = reversal(reversed);
        let matrix = if reversed { flip() * plain_matrix } else { plain_matrix };
        let mut dark = |nearer: f64, scale: f64| -> Result<usize, String> {
            let map = depths(SIDE, |u, v| held(floor(u, v) - nearer));
            let places = (0..144).map(|i| {
                DVec3::new(f64::from(i % 12) / 3.0 - 1.9, 0.0, f64::from(i / 12) / 3.0 - 1.8)
            });
            let row = |p: DVec3| {
                let vectors =
                    [p, DVec3::Y, direction].into_iter().flat_map(|vector| vector.to_array());
                matrix
                    .to_cols_array()
                    .into_iter()
                    .chain(vectors)
                    .chain([texel, scale])
                    .map(|value| value as f32)
                    .collect()
            };
            let rows: Vec<Vec<f32>> = places.map(row).collect();
            let found = run.call("raised", Some((map, comparing(compare, false))), &rows)?;
            Ok(found.iter().filter(|lit| **lit == 0.0).count())
        };
        let counts = [dark(0.0, 0.0)?, dark(0.0, 0.75)?, dark(0.05, 0.75)?];
        if !(36..108).contains(&counts[0]) || counts[1..] != [0, 144] {
            return Err(format!(
                "reversed {reversed}: {counts:?} of 144 are dark (no offset, offset, below an \
                 occluder), expected about half, 0 and 144"
            ));
        }
    }
    Ok(())
}

/// A wide filter over a sloped receiver. With one depth for all taps, some taps are dark. With depths
/// that follow the slope, none are, and a receiver well behind stays dark.
pub fn receiver_plane_follows_slope(run: &mut Run<'_>) -> Result<(), String> {
    const SLOPE: [f64; 2] = [0.2, -0.15];
    let receiver = |u: f64, v: f64| 0.4 + SLOPE[0] * u + SLOPE[1] * v;
    // A tap reads a whole texel, so its depth may be off by half a texel along each axis. The bias
    // covers that.
    let bias = 0.51 / 32.0 * (SLOPE[0].abs() + SLOPE[1].abs());
    for reversed in [false, true] {
        let (held, compare) = reversal(reversed);
        let sign = if reversed { -1.0 } else { 1.0 };
        let map = depths(32, |u, v| held(receiver(u, v)));
        let mut lit = |beyond: f64, share: f64| -> Result<[f64; 2], String> {
            let places =
                (0..64).map(|i| (0.3 + 0.05 * f64::from(i % 8), 0.3 + 0.05 * f64::from(i / 8)));
            let row = |(u, v): (f64, f64)| {
                let (duv_dx, duv_dy) = ([0.01, 0.002], [-0.003, 0.008]);
                let rise = |duv: [f64; 2]| sign * (SLOPE[0] * duv[0] + SLOPE[1] * duv[1]);
                let depth = held(receiver(u, v) + beyond - bias);
                [u, v, depth]
                    .into_iter()
                    .chain(duv_dx)
                    .chain(duv_dy)
                    .chain([rise(duv_dx), rise(duv_dy), share])
                    .map(|value| value as f32)
                    .collect()
            };
            let rows: Vec<Vec<f32>> = places.map(row).collect();
            let found =
                run.call("planar", Some((map.clone(), comparing(compare, false))), &rows)?;
            Ok([
                found.iter().copied().fold(1.0, f64::min),
                found.iter().copied().fold(0.0, f64::max),
            ])
        };
        let (followed, level, behind) = (lit(0.0, 1.0)?, lit(0.0, 0.0)?, lit(0.1, 1.0)?);
        if followed != [1.0, 1.0] || level[1] > 0.9 || behind != [0.0, 0.0] {
            return Err(format!(
                "reversed {reversed}: least and most visibility {followed:?} along the slope, \
                 {level:?} with one depth, {behind:?} behind; expected 1, below 0.9, and 0"
            ));
        }
    }
    Ok(())
}
