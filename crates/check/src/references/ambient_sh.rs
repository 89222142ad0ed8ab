//! Sources: Ramamoorthi and Hanrahan, "An Efficient Representation for Irradiance Environment
//! Maps", 2001, equations 3 and 13; OpenGL Programming Guide, equation 7.1; Hazel,
//! 2015; Roughton et al., 2024; Sloan, 2008.

use super::Source::Published;
use super::{CallArguments, Expected, ReferenceEntry};
use glam::DVec3;
use std::f64::consts::PI;

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "ambient::sh",
    functions: &[
        ("sh9_irradiance", Published, |a| irradiance(a, 9).into()),
        ("sh9_irradiance_clamped", Published, |a| irradiance(a, 9).max(DVec3::ZERO).into()),
        ("sh4_irradiance", Published, |a| irradiance(a, 4).into()),
        ("sh9_basis", Published, |a| Expected::words(basis(a.vec3()))),
        ("sh4_irradiance_geomerics", Published, geomerics),
        ("geomerics_channel", Published, |a| lobe(a.vec3(), a.f64(), a.vec3()).into()),
        ("sh4_irradiance_zh3", Published, zh3),
        ("sh_window", Published, |a| window(a.f64(), a.f64()).into()),
    ],
};

/// Equation 3, in the order L00, L1m1, L10, L11, L2m2, L2m1, L20, L21, L22.
fn basis(n: DVec3) -> [f64; 9] {
    let (x, y, z) = (n.x, n.y, n.z);
    [
        0.282095,
        0.488603 * y,
        0.488603 * z,
        0.488603 * x,
        1.092548 * x * y,
        1.092548 * y * z,
        0.315392 * (3.0 * z * z - 1.0),
        1.092548 * x * z,
        0.546274 * (x * x - y * y),
    ]
}

/// Equation 13, as printed with c1 to c5, over the first `count` coefficients.
fn irradiance(a: &mut CallArguments<'_>, count: usize) -> DVec3 {
    let n = a.vec3();
    let mut sh = [DVec3::ZERO; 9];
    sh[..count].iter_mut().for_each(|coefficient| *coefficient = a.vec3());
    let [l00, l1m1, l10, l11, l2m2, l2m1, l20, l21, l22] = sh;
    let (x, y, z) = (n.x, n.y, n.z);
    let [c1, c2, c3, c4, c5] = [0.429043, 0.511664, 0.743125, 0.886227, 0.247708];
    c1 * l22 * (x * x - y * y) + c3 * l20 * z * z + c4 * l00 - c5 * l20
        + 2.0 * c1 * (l2m2 * x * y + l21 * x * z + l2m1 * y * z)
        + 2.0 * c2 * (l11 * x + l1m1 * y + l10 * z)
}

/// R0*(a + (1 - a)*(p + 1)*q^p) with the irradiance's mean R0 and half its linear band R1.
fn lobe(n: DVec3, constant: f64, axis: DVec3) -> f64 {
    let mean = 0.886227 * constant.max(0.0);
    if mean <= 1e-30 || axis.length() <= 1e-30 {
        return mean;
    }
    let r1 = axis * 1.023328 / 2.0;
    let rho = (r1.length() / mean).min(1.0);
    let (a, p) = ((1.0 - rho) / (1.0 + rho), 1.0 + 2.0 * rho);
    let q = ((1.0 + n.dot(axis.normalize())) / 2.0).clamp(0.0, 1.0);
    mean * (a + (1.0 - a) * (p + 1.0) * q.powf(p))
}

fn four(a: &mut CallArguments<'_>) -> [DVec3; 4] {
    [(); 4].map(|()| a.vec3())
}

fn geomerics(a: &mut CallArguments<'_>) -> Expected {
    let (n, [l00, l1m1, l10, l11]) = (a.vec3(), four(a));
    let channel = |c: usize| lobe(n, l00[c], DVec3::new(l11[c], l1m1[c], l10[c]));
    DVec3::new(channel(0), channel(1), channel(2)).into()
}

/// The bands 0 and 1, and for band 2 a zonal coefficient about the axis of the luminance.
fn zh3(a: &mut CallArguments<'_>) -> Expected {
    let (n, [l00, l1m1, l10, l11]) = (a.vec3(), four(a));
    let luma = DVec3::new(0.2126, 0.7152, 0.0722);
    let axis = DVec3::new(l11.dot(luma), l1m1.dot(luma), l10.dot(luma)).normalize_or_zero();
    let channel = |c: usize| {
        let linear = DVec3::new(l11[c], l1m1[c], l10[c]);
        let constant = l00[c].max(0.0);
        let ratio = (linear.dot(axis).abs() / constant.max(1e-30)).min(3f64.sqrt());
        let zonal = constant * (0.08 * ratio + 0.6 * ratio * ratio);
        let basis = (5.0 / (16.0 * PI)).sqrt() * (3.0 * n.dot(axis).powi(2) - 1.0);
        0.886227 * l00[c] + 1.023328 * linear.dot(n) + PI / 4.0 * zonal * basis
    };
    DVec3::new(channel(0), channel(1), channel(2)).into()
}

/// The square of a cosine: 1 at band 0, and 0 from the width on.
fn window(band: f64, width: f64) -> f64 {
    match band {
        band if band <= 0.0 => 1.0,
        band if band >= width => 0.0,
        band => (PI * band / width / 2.0).cos().powi(2),
    }
}
