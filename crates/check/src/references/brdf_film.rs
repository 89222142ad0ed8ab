//! Sources: Belcour and Barla, 2017, and the coefficients of its supplement; Khronos Group,
//! KHR_materials_iridescence, 2022.

use super::Source::{Published, Specification};
use super::ReferenceEntry;
use super::brdf_fresnel::dielectric;
use glam::DVec3;
use std::f64::consts::PI;

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "brdf::film",
    functions: &[
        ("film_sensitivity", Published, |a| sensitivity(a.f64() * 1e-9, a.vec3()).into()),
        ("iridescence", Specification, |a| iridescence(a.f64(), a.f64(), a.vec3(), a.f64(), a.f64()).into()),
    ],
};

/// The Fourier transforms of the colour matching functions at an optical path difference in metres,
/// as linear sRGB. Phase shifts are 0 or half a wave, so their cosines are the signs.
fn sensitivity(difference: f64, signs: DVec3) -> DVec3 {
    let phase = 2.0 * PI * difference;
    let gaussian = |value: f64, place: f64, variance: f64, sign: f64| {
        value
            * (2.0 * PI * variance).sqrt()
            * (place * phase).cos()
            * sign
            * (-variance * phase * phase).exp()
    };
    let xyz = DVec3::new(
        gaussian(5.4856e-13, 1.6810e6, 4.3278e9, signs.x)
            + gaussian(9.7470e-14, 2.2399e6, 4.5282e9, signs.x),
        gaussian(4.4201e-13, 1.7953e6, 9.3046e9, signs.y),
        gaussian(5.2481e-13, 2.2084e6, 6.6121e9, signs.z),
    ) / 1.0685e-7;
    DVec3::new(
        xyz.dot(DVec3::new(3.2404542, -1.5371385, -0.4985314)),
        xyz.dot(DVec3::new(-0.9692660, 1.8760108, 0.0415560)),
        xyz.dot(DVec3::new(0.0556434, -0.2040259, 1.0572252)),
    )
}

/// Schlick's approximation, with a reflectance of 1 at grazing incidence.
fn schlick(f0: f64, mu: f64) -> f64 {
    f0 + (1.0 - f0) * (1.0 - mu).powi(5)
}

/// The constant term of the interference series and its first two orders. Each colour channel has
/// its own index of the base.
fn iridescence(eta_out: f64, eta_film: f64, f0: DVec3, nm: f64, mu: f64) -> DVec3 {
    let (outside, thick, mu) = (eta_out.clamp(1.0, 10.0), nm.clamp(0.0, 1e5), mu.clamp(0.0, 1.0));
    let t = (thick / f64::from(0.03f32)).min(1.0);
    let film = outside + (eta_film.clamp(1.0, 10.0) - outside) * t * t * (3.0 - 2.0 * t);
    let sine2 = (outside / film).powi(2) * (1.0 - mu * mu);
    if sine2 >= 1.0 {
        return DVec3::ONE;
    }
    let inner = (1.0 - sine2).sqrt();
    let upper = schlick(dielectric(1.0, film / outside), mu);
    let difference = 2.0 * film * thick * 1e-9 * inner;
    let base = f0.to_array().map(|f0| {
        let s = f0.clamp(0.0, f64::from(0.9999f32)).sqrt();
        (1.0 + s) / (1.0 - s)
    });
    let lower = DVec3::from(base.map(|base| schlick(dielectric(1.0, base / film), inner)));
    // A reflection at a denser medium shifts the phase by half a wave. There are two: from within
    // the film at its upper side, and at its lower side.
    let sign = |base: f64| -> f64 { if (film >= outside) != (base < film) { -1.0 } else { 1.0 } };
    let both = (upper * lower).clamp(DVec3::splat(1e-5), DVec3::splat(f64::from(0.9999f32)));
    let steady = (1.0 - upper).powi(2) * lower / (1.0 - both);
    let order = |m: i32| {
        let amplitude = DVec3::from(both.to_array().map(|both| both.sqrt().powi(m)));
        let signs = DVec3::from(base.map(|base| sign(base).powi(m)));
        2.0 * (steady - (1.0 - upper)) * amplitude * sensitivity(f64::from(m) * difference, signs)
    };
    (upper + steady + order(1) + order(2)).clamp(DVec3::ZERO, DVec3::ONE)
}
