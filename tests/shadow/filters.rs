//! Filters at the edges of shadows.

use lamplight::execute::fixture::{Compare, FixtureTexture, TextureKind};

use super::{Run, comparing, depths, plain};

/// A filtered comparison is 0 and 1 at the centres of texels, and one half on the border between
/// them, across and down.
pub fn texel_borders(run: &mut Run<'_>) -> Result<(), String> {
    let across = depths(8, |u, _| if u < 0.5 { 0.25 } else { 0.75 });
    let down = depths(8, |_, v| if v < 0.5 { 0.25 } else { 0.75 });
    let steps = [(0.4375f32, 0.0), (0.46875, 0.25), (0.5, 0.5), (0.53125, 0.75), (0.5625, 1.0)];
    for (map, is_down) in [(across, false), (down, true)] {
        let place = |at: f32| if is_down { vec![0.3, at, 0.5] } else { vec![at, 0.3, 0.5] };
        let rows: Vec<_> = steps.iter().map(|(at, _)| place(*at)).collect();
        let found = run.call("stored", Some((map, comparing(Compare::LessEqual, true))), &rows)?;
        if found.iter().zip(steps).any(|(found, (_, expected))| (found - expected).abs() > 1e-6) {
            let expected = steps.map(|(_, lit)| lit);
            return Err(format!("down {is_down}: found {found:?}, expected {expected:?}"));
        }
    }
    Ok(())
}

/// Every filter only rises, from 0 to 1, on the way from the dark to the lit side of an edge.
pub fn penumbra_is_monotone(run: &mut Run<'_>) -> Result<(), String> {
    let map = depths(32, |u, _| if u < 0.5 { 0.25 } else { 0.75 });
    let rows: Vec<_> = (0..=256).map(|i| vec![0.25 + 0.5 * i as f32 / 256.0, 0.47, 0.5]).collect();
    let found = run.call("filters", Some((map, comparing(Compare::LessEqual, true))), &rows)?;
    for filter in 0..6 {
        let values: Vec<f64> = found.iter().skip(filter).step_by(6).copied().collect();
        let falls = values.windows(2).any(|pair| pair[1] < pair[0] - 1e-5);
        let (first, last) = (values[0], values[256]);
        if falls || first.abs() > 1e-5 || (last - 1.0).abs() > 1e-5 {
            return Err(format!("filter {filter} should rise from 0 to 1: {values:?}"));
        }
    }
    Ok(())
}

pub fn moments_of_two_depths(run: &mut Run<'_>) -> Result<(), String> {
    two_depths(run, "moments", 1e-4, |depth| [depth, depth * depth, 0.0, 1.0])
}

pub fn warped_moments_of_two_depths(run: &mut Run<'_>) -> Result<(), String> {
    two_depths(run, "warped", 1e-3, |depth| {
        let z = 5.0 * (2.0 * depth - 1.0);
        [z.exp(), (2.0 * z).exp(), -(-z).exp(), (-2.0 * z).exp()]
    })
}

/// A map of moments that is filtered between an occluder and the receiver behind it. For that
/// receiver, Chebyshev's bound is exactly the lit share, so the penumbra is a straight line. For other
/// depths it is an upper bound of the lit share.
fn two_depths(
    run: &mut Run<'_>,
    function: &str,
    error: f64,
    moments: impl Fn(f64) -> [f64; 4],
) -> Result<(), String> {
    const SIDE: u32 = 32;
    let (near, far) = (0.25, 0.75);
    let share = |x: u32| (f64::from(x) / f64::from(SIDE - 1)).clamp(0.0, 1.0);
    let (before, behind) = (moments(near), moments(far));
    let texel = |x: u32| {
        (0..4).map(move |channel| {
            (before[channel] * (1.0 - share(x)) + behind[channel] * share(x)) as f32
        })
    };
    let texels = (0..SIDE).flat_map(texel).collect();
    let map = FixtureTexture { kind: TextureKind::Color2d, width: SIDE, height: 1, texels };
    let depths = [0.2f32, 0.25, 0.3, 0.5, 0.75];
    let rows: Vec<_> = depths
        .iter()
        .flat_map(|t| (0..SIDE).map(move |x| vec![(x as f32 + 0.5) / SIDE as f32, 0.5, *t]))
        .collect();
    let found = run.call(function, Some((map, plain(false))), &rows)?;
    for (values, t) in found.chunks(SIDE as usize).zip(depths) {
        let lit = |x: usize| if f64::from(t) <= near { 1.0 } else { share(x as u32) };
        let bounds = values.iter().enumerate().all(|(x, value)| *value >= lit(x) - error);
        let rises = values.windows(2).all(|pair| pair[1] >= pair[0] - error);
        let exact =
            t != 0.75 || values.iter().enumerate().all(|(x, value)| (value - lit(x)).abs() < error);
        if !(bounds && rises && exact) {
            let what = format!("is a bound: {bounds}, rises: {rises}, is exact: {exact}");
            return Err(format!("depth {t}: {what}: {values:?}"));
        }
    }
    Ok(())
}

/// The taps of the published recipe all lie to one side, so its shadows move by 0.125/w. The centred
/// taps of the safe form do not move them.
pub fn random_taps_shift(run: &mut Run<'_>) -> Result<(), String> {
    let map = depths(64, |u, _| if u < 0.5 { 0.25 } else { 0.75 });
    let (places, pixels) = (128u32, 64u32);
    for w in [1.0f32, 2.0, 4.0] {
        let mut rows = Vec::new();
        for (place, pixel) in
            (0..places).flat_map(|place| (0..pixels).map(move |pixel| (place, pixel)))
        {
            let u = 0.1 + 0.6 * (place as f32 + 0.5) / places as f32;
            rows.push(vec![
                (2.0 * u - 1.0) * w,
                0.1,
                0.5 * w,
                w,
                (pixel * 7 + place * 13 % 256) as f32 + 0.5,
                (pixel * 31 % 97) as f32 + 0.5,
            ]);
        }
        let found =
            run.call("random", Some((map.clone(), comparing(Compare::LessEqual, true))), &rows)?;
        // The mean position of the shadow's edge, computed from the shadow's area.
        let edge = |form: usize| {
            0.7 - 0.6 * found.iter().skip(form).step_by(2).sum::<f64>() / f64::from(places * pixels)
        };
        let shift = 0.125 / f64::from(w);
        if (edge(0) - 0.5).abs() > 0.002
            || (edge(1) - (0.5 - shift)).abs() > 0.01 * f64::from(1.0 / w)
        {
            return Err(format!(
                "w {w}: the edges are at {} and {}, expected 0.5 and {}",
                edge(0),
                edge(1),
                0.5 - shift
            ));
        }
    }
    Ok(())
}

/// The 21 weights of the Gaussian kernel add up to 1, are symmetric, and have the variance of the
/// kernel.
pub fn kernel_adds_up(run: &mut Run<'_>) -> Result<(), String> {
    let words: Vec<u32> = (-10..=10i32).map(|i| i as u32).collect();
    let weights = run.call_words("weight", None, &words)?;
    let sum: f64 = weights.iter().sum();
    let mirrored = weights.iter().eq(weights.iter().rev());
    let variance: f64 =
        weights.iter().zip(-10..).map(|(weight, i)| weight * f64::from(i * i)).sum();
    if (sum - 1.0).abs() < 1e-6 && mirrored && (7.9..8.0).contains(&variance) {
        Ok(())
    } else {
        let what = format!("the sum is {sum}, the variance {variance}, symmetric: {mirrored}");
        Err(format!("{what}, expected 1, 7.9 to 8, and true: {weights:?}"))
    }
}
