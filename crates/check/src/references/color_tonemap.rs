//! Sources: Sobotka, AgX, 2022, with the matrices of Blender 4; Khronos Group, PBR Neutral, 2024;
//! Hill, 2016; Hable, 2010; Reinhard et al., 2002, equation 4; Uchimura, 2017; Chow, the AgX of
//! Blender 4, 2023; Polyphony Digital, 2025.

use super::Source::{Published, Specification};
use super::color_transfer::{from_ictcp, ictcp};
use super::{CallArguments, Expected, ReferenceEntry};
use glam::{DMat3, DVec2, DVec3};

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "color::tonemap",
    functions: &[
        ("agx_curve", Published, |a| agx_curve(a.f64()).into()),
        ("agx", Published, |a| agx(a.vec3()).into()),
        ("neutral", Specification, |a| neutral(a.vec3()).into()),
        ("neutral_inverse", Specification, |a| neutral_inverse(a.vec3()).into()),
        ("aces_hill", Published, |a| aces_hill(a.vec3()).into()),
        ("hable_channel", Published, |a| hable(a.f64()).into()),
        ("hable", Published, |a| a.vec3().map(|x| (hable(2.0 * x) / hable(11.2)).clamp(0.0, 1.0)).into()),
        ("reinhard_extended", Published, reinhard_extended),
        ("uchimura_channel", Published, |a| uchimura(a.f64()).into()),
        ("uchimura", Published, |a| a.vec3().map(uchimura).into()),
        ("agx_curve_blender", Published, |a| agx_curve_blender(a.f64()).into()),
        ("agx_blender", Published, |a| agx_blender(a.vec3()).into()),
        ("gt7_curve", Published, |a| gt7_curve(a.f64()).into()),
        ("gt7", Published, |a| gt7(a.vec3()).into()),
    ],
};

/// A sigmoid u/(1 + u^p)^(1/p), with the slope at (20/33, `middle`). Each side is scaled so that
/// the curve goes through (0, 0) and (1, 1).
fn sigmoid(x: f64, middle: f64, slope: f64, powers: [f64; 2]) -> f64 {
    let pivot = 20.0 / 33.0;
    let d = x.clamp(0.0, 1.0) - pivot;
    let (sign, span, height, power) = match d < 0.0 {
        true => (-1.0, pivot, middle, powers[0]),
        false => (1.0, 1.0 - pivot, 1.0 - middle, powers[1]),
    };
    let corner = (slope * span).powf(-power) * ((slope * span / height).powf(power) - 1.0);
    let scale = corner.powf(-1.0 / power);
    let u = slope * d.abs() / scale;
    middle + sign * scale * u / (1.0 + u.powf(power)).powf(1.0 / power)
}

fn agx_curve(x: f64) -> f64 {
    sigmoid(x, 0.5, 2.0, [3.0, 3.25])
}

fn agx_curve_blender(x: f64) -> f64 {
    sigmoid(x, 0.18f64.powf(1.0 / 2.4), 2.4, [1.5, 1.5])
}

/// The matrix from linear RGB to XYZ, for primaries and the white point D65.
fn to_xyz(primaries: [DVec2; 3]) -> DMat3 {
    let xyz = |c: DVec2| DVec3::new(c.x / c.y, 1.0, (1.0 - c.x - c.y) / c.y);
    let columns = DMat3::from_cols(xyz(primaries[0]), xyz(primaries[1]), xyz(primaries[2]));
    let white = columns.inverse() * xyz(DVec2::new(0.3127, 0.3290));
    columns * DMat3::from_diagonal(white)
}

/// The matrix from linear Rec. 709 to linear Rec. 2020, from the primaries of both.
fn rec2020() -> DMat3 {
    let from = [DVec2::new(0.64, 0.33), DVec2::new(0.3, 0.6), DVec2::new(0.15, 0.06)];
    let to = [DVec2::new(0.708, 0.292), DVec2::new(0.17, 0.797), DVec2::new(0.131, 0.046)];
    to_xyz(to).inverse() * to_xyz(from)
}

/// AgX's inset matrix, which draws colours towards grey, and the matrix whose inverse is its
/// outset.
fn agx_matrices() -> [DMat3; 2] {
    let inset = [
        0.856627153315983,
        0.137318972929847,
        0.11189821299995,
        0.0951212405381588,
        0.761241990602591,
        0.0767994186031903,
        0.0482516061458583,
        0.101439036467562,
        0.811302368396859,
    ];
    let outset = [
        0.899796955911611,
        0.11142098895748,
        0.11142098895748,
        0.0871996192028351,
        0.875575586156966,
        0.0871996192028349,
        0.013003424885555,
        0.0130034248855548,
        0.801379391839686,
    ];
    [DMat3::from_cols_array(&inset), DMat3::from_cols_array(&outset)]
}

/// The colour in Rec. 2020 after the inset matrix, and `curve` over the logarithms of its channels.
fn agx_toned(c: DVec3, curve: fn(f64) -> f64) -> (DVec3, DVec3) {
    let light = agx_matrices()[0] * (rec2020() * c.clamp(DVec3::ZERO, DVec3::splat(1e20)));
    let (low, high) = ((0.18f64).log2() - 10.0, (0.18f64).log2() + 6.5);
    (light, light.map(|x| curve((x.max(1e-10).log2() - low) / (high - low))))
}

/// The toned colour after the outset, made linear by the power 2.2, in Rec. 709.
fn agx(c: DVec3) -> DVec3 {
    let (_, toned) = agx_toned(c, agx_curve);
    let shown = (agx_matrices()[1].inverse() * toned).map(|x| x.max(0.0).powf(2.2));
    (rec2020().inverse() * shown).clamp(DVec3::ZERO, DVec3::ONE)
}

/// The hue of a colour, in turns.
fn hue_of(c: DVec3) -> f64 {
    let span = c.max_element() - c.min_element();
    let sixth = if span == 0.0 {
        0.0
    } else if c.x == c.max_element() {
        (c.y - c.z) / span
    } else if c.y == c.max_element() {
        (c.z - c.x) / span + 2.0
    } else {
        (c.x - c.y) / span + 4.0
    };
    (sixth / 6.0).rem_euclid(1.0)
}

/// The colour of a hue, in turns, whose smallest and largest channels are `least` and `most`. Each
/// channel is a trapezoid over the hue.
fn with_hue(least: f64, most: f64, hue: f64) -> DVec3 {
    let channel = |start: f64| {
        let from_centre = ((hue - start + 0.5).rem_euclid(1.0) - 0.5).abs();
        least + (most - least) * (2.0 - 6.0 * from_centre).clamp(0.0, 1.0)
    };
    DVec3::new(channel(0.0), channel(1.0 / 3.0), channel(2.0 / 3.0))
}

/// The toned colour, made linear by the power 2.4, with its hue moved 60 % of the shorter way back
/// to that before the curve; then the outset, in Rec. 709.
fn agx_blender(c: DVec3) -> DVec3 {
    let (light, toned) = agx_toned(c, agx_curve_blender);
    let shown = toned.map(|x| x.max(0.0).powf(2.4));
    let (before, after) = (hue_of(light), hue_of(shown));
    let turn = (after - before + 0.5).rem_euclid(1.0) - 0.5;
    let mixed = with_hue(shown.min_element(), shown.max_element(), before + 0.4 * turn);
    let narrow = rec2020().inverse() * (agx_matrices()[1].inverse() * mixed);
    narrow.clamp(DVec3::ZERO, DVec3::ONE)
}

const START: f64 = 0.8 - 0.04;
const DESATURATION: f64 = 0.15;

/// As it is specified: an offset, a compressed peak, and white mixed in.
fn neutral(c: DVec3) -> DVec3 {
    let c = c.clamp(DVec3::ZERO, DVec3::splat(1e10));
    let least = c.min_element();
    let c = c - if least < 0.08 { least - 6.25 * least * least } else { 0.04 };
    let peak = c.max_element();
    if peak < START {
        return c;
    }
    let d = 1.0 - START;
    let bent = 1.0 - d * d / (peak + d - START);
    let white = 1.0 - 1.0 / (DESATURATION * (peak - bent) + 1.0);
    (c * bent / peak).lerp(DVec3::splat(bent), white)
}

/// The steps of `neutral`, inverted in reverse order.
fn neutral_inverse(c: DVec3) -> DVec3 {
    let mut c = c.clamp(DVec3::ZERO, DVec3::splat(f64::from(0.9999f32)));
    let bent = c.max_element();
    if bent > START {
        let d = 1.0 - START;
        let peak = d * d / (1.0 - bent) - d + START;
        let kept = 1.0 / (DESATURATION * (peak - bent) + 1.0);
        c = ((c - bent * (1.0 - kept)) / kept).max(DVec3::ZERO) * peak / bent;
    }
    let least = c.min_element();
    // least = 6.25*x^2 for x below 0.08.
    c + if least < 0.04 { (least / 6.25).sqrt() - least } else { 0.04 }
}

/// The input matrix, the rational curve and the output matrix. The matrices are written row by row.
fn aces_hill(c: DVec3) -> DVec3 {
    let enter = DMat3::from_cols_array(&[
        0.59719, 0.35458, 0.04823, 0.07600, 0.90834, 0.01566, 0.02840, 0.13383, 0.83777,
    ]);
    let leave = DMat3::from_cols_array(&[
        1.60475, -0.53108, -0.07367, -0.10208, 1.10813, -0.00605, -0.00327, -0.07276, 1.07602,
    ]);
    let v = enter.transpose() * c.clamp(DVec3::ZERO, DVec3::splat(1e6));
    let fitted = v
        .map(|v| (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081));
    (leave.transpose() * fitted).clamp(DVec3::ZERO, DVec3::ONE)
}

/// ((x*(A*x + C*B) + D*E)/(x*(A*x + B) + D*F)) - E/F.
fn hable(x: f64) -> f64 {
    let [a, b, c, d, e, f] = [0.15, 0.50, 0.10, 0.20, 0.02, 0.30];
    let x = x.clamp(0.0, 1e6);
    (x * (a * x + c * b) + d * e) / (x * (a * x + b) + d * f) - e / f
}

fn reinhard_extended(a: &mut CallArguments<'_>) -> Expected {
    let (c, white) = (a.vec3(), a.f64().max(f64::from(0.001f32)));
    c.map(|x| {
        let x = x.max(0.0);
        if x >= white { 1.0 } else { x * (1.0 + x / white.powi(2)) / (1.0 + x) }
    })
    .into()
}

/// The published form: a weighted sum of the toe, the line and the shoulder.
fn uchimura(x: f64) -> f64 {
    let (p, a, m, l, c) = (1.0, 1.0, 0.22, 0.4, 1.33);
    let x = x.max(0.0);
    let l0 = (p - m) * l / a;
    let (s0, s1) = (m + l0, m + a * l0);
    let c2 = a * p / (p - s1);
    let t = (x / m).clamp(0.0, 1.0);
    let w0 = 1.0 - t * t * (3.0 - 2.0 * t);
    let w2 = f64::from(u8::from(x >= m + l0));
    let toe = m * (x / m).powf(c);
    let shoulder = p - (p - s1) * (-c2 * (x - s0) / p).exp();
    (toe * w0 + (m + a * (x - m)) * (1.0 - w0 - w2) + shoulder * w2).clamp(0.0, 1.0)
}

const GT7_WHITE: f64 = 250.0 / 100.0;

fn smoothstep(from: f64, to: f64, x: f64) -> f64 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// The example code's curve, with its shoulder's constants from alpha.
fn gt7_curve(x: f64) -> f64 {
    let (alpha, middle, line, toe) = (0.25, 0.538, 0.444, 1.28);
    if x < 0.0 {
        return 0.0;
    }
    let k: f64 = (line - 1.0) / (alpha - 1.0);
    if x >= line * GT7_WHITE {
        let scale = GT7_WHITE * k * (line / k).exp();
        return GT7_WHITE * (line + k) - scale * (-x / (k * GT7_WHITE)).exp();
    }
    let linear = smoothstep(0.0, middle, x);
    (1.0 - linear) * middle * (x / middle).powf(toe) + linear * x
}

/// A mix of 40 % of the colour curved by channel, and 60 % of its intensity with the chroma before
/// the curve, in ICtCp. The chroma fades as the intensity before the curve nears that of white.
fn gt7(c: DVec3) -> DVec3 {
    let light = rec2020() * c.clamp(DVec3::ZERO, DVec3::splat(1e6));
    let curved = light.map(gt7_curve);
    let white = ictcp(DVec3::splat(GT7_WHITE * 100.0)).x;
    let (before, after) = (ictcp(light * 100.0), ictcp(curved * 100.0));
    let kept = 1.0 - smoothstep(0.98, 1.16, before.x / white);
    let even = from_ictcp(DVec3::new(after.x, before.y * kept, before.z * kept)) / 100.0;
    let blended = (curved * 0.4 + even * 0.6).min(DVec3::splat(GT7_WHITE));
    (rec2020().inverse() * (blended / GT7_WHITE)).clamp(DVec3::ZERO, DVec3::ONE)
}
