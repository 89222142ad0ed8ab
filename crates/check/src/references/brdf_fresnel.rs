//! Sources: Fresnel's equations, for a real and for a complex index (Born, Wolf, Principles of
//! Optics, sections 1.5 and 14.2); Kutz, Hašan, Edmondson, 2021; Jakob et al., 2014; this library's
//! fit of the average; Duntley, 1942; Gulbrandsen, 2014.

use super::Source::Published;
use super::{CallArguments, Expected, ReferenceEntry};
use glam::{DVec2, DVec3};

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "brdf::fresnel",
    functions: &[
        ("f0_from_ior", Published, |a| dielectric(1.0, a.f64().max(0.0)).into()),
        ("ior_from_f0", Published, |a| ior_from_f0(a.f64()).into()),
        ("f_dielectric", Published, |a| dielectric(a.f64(), a.f64()).into()),
        ("f_conductor", Published, f_conductor),
        ("f_conductor_channel", Published, |a| conductor(a.f64(), a.f64(), a.f64()).into()),
        ("f_schlick_f82", Published, f_schlick_f82),
        ("f_average_schlick", Published, f_average_schlick),
        ("f_average_dielectric", Published, |a| average(a.f64()).into()),
        ("ior_artistic", Published, ior_artistic),
    ],
};

/// The mean of the squared amplitudes of both polarisations, with the angles from Snell's law; 1,
/// total reflection, where it gives no angle.
pub fn dielectric(mu: f64, eta: f64) -> f64 {
    let (cos_i, eta) = (mu.clamp(0.0, 1.0), eta.clamp(0.0, 1e9));
    if eta == 1.0 {
        return 0.0;
    }
    let sin2_t = (1.0 - cos_i * cos_i) / (eta * eta);
    if eta == 0.0 || sin2_t >= 1.0 {
        return 1.0;
    }
    let cos_t = (1.0 - sin2_t).sqrt();
    let across = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    let along = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    (across * across + along * along) / 2.0
}

/// (1 + s)/(1 - s) with s = sqrt(f0). `f0` is clamped to at most 0.9999, rounded to f32.
fn ior_from_f0(f0: f64) -> f64 {
    let s = f0.clamp(0.0, f64::from(0.9999f32)).sqrt();
    (1.0 + s) / (1.0 - s)
}

fn mul(a: DVec2, b: DVec2) -> DVec2 {
    DVec2::new(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x)
}

fn div(a: DVec2, b: DVec2) -> DVec2 {
    mul(a, DVec2::new(b.x, -b.y)) / b.length_squared()
}

/// The root with a positive real part.
fn sqrt(z: DVec2) -> DVec2 {
    let size = z.length();
    let imaginary = ((size - z.x).max(0.0) / 2.0).sqrt();
    DVec2::new(((size + z.x).max(0.0) / 2.0).sqrt(), imaginary.copysign(z.y))
}

/// The mean of the squared amplitudes for the complex index n + ik. There w is eta*cos_t, which is
/// sqrt(eta^2 - sin^2).
pub fn conductor(c: f64, n: f64, k: f64) -> f64 {
    let eta2 = mul(DVec2::new(n, k), DVec2::new(n, k));
    let w = sqrt(eta2 - DVec2::new(1.0 - c * c, 0.0));
    let share = |a: DVec2, b: DVec2| div(a - b, a + b).length_squared();
    (share(DVec2::new(c, 0.0), w) + share(eta2 * c, w)) / 2.0
}

/// The reflectance at three wavelengths, with parameters clamped to the range that the
/// documentation names.
fn f_conductor(a: &mut CallArguments<'_>) -> Expected {
    let (mu, n, k) = (a.f64(), a.vec3(), a.vec3());
    let [least, thin, most] = [1e-7f32, 1e-4, 1e4].map(f64::from);
    let one =
        |n: f64, k: f64| conductor(mu.clamp(least, 1.0), n.clamp(thin, most), k.clamp(0.0, most));
    DVec3::new(one(n.x, k.x), one(n.y, k.y), one(n.z, k.z)).into()
}

/// Schlick's approximation, less a term by which the result at the cosine of 1/7 is `tint` times as
/// large.
fn f_schlick_f82(a: &mut CallArguments<'_>) -> Expected {
    let (f0, tint, mu) = (a.vec3(), a.vec3(), a.f64().clamp(0.0, 1.0));
    let schlick = |mu: f64| f0 + (1.0 - f0) * (1.0 - mu).powi(5);
    let lobe = |mu: f64| mu * (1.0 - mu).powi(6);
    let m = 1.0 / 7.0;
    (schlick(mu) - lobe(mu) / lobe(m) * schlick(m) * (1.0 - tint)).max(DVec3::ZERO).into()
}

fn f_average_schlick(a: &mut CallArguments<'_>) -> Expected {
    let (f0, f90) = (a.vec3(), a.vec3());
    (f0 + (f90 - f0) / 21.0).into()
}

/// The average reflectance over the hemisphere: a fit in the Fresnel amplitude at normal incidence.
/// For an index below 1, it follows by reciprocity: as much light enters as leaves, spread over n^2
/// of the solid angle.
pub fn average(eta: f64) -> f64 {
    let eta = eta.clamp(0.0, 1e6);
    let amplitude = ((eta - 1.0) / (eta + 1.0)).abs();
    let sum = |terms: [f64; 4]| {
        terms.iter().zip(0..).map(|(term, power)| term * amplitude.powi(power)).sum::<f64>()
    };
    let over = amplitude * sum([0.630748, 1.559664, 0.58983, -2.30022]);
    let inside = (over / sum([1.0, 7.526047, -11.661933, 3.615908])).clamp(0.0, 1.0);
    if eta < 1.0 { 1.0 - eta * eta * (1.0 - inside) } else { inside }
}

/// n follows from the mapping of Gulbrandsen. k follows from n and the reflectance r at normal
/// incidence: r*((n + 1)^2 + k^2) = (n - 1)^2 + k^2.
fn ior_artistic(a: &mut CallArguments<'_>) -> Expected {
    let (r, g) = (a.vec3(), a.vec3().clamp(DVec3::ZERO, DVec3::ONE));
    let r = r.clamp(DVec3::ZERO, DVec3::splat(f64::from(0.999f32)));
    let one = |r: f64, g: f64| {
        let most = (1.0 + r.sqrt()) / (1.0 - r.sqrt());
        let n = most + ((1.0 - r) / (1.0 + r) - most) * g;
        let k2 = (r * (n + 1.0).powi(2) - (n - 1.0).powi(2)) / (1.0 - r);
        let ends = r == 0.0 || g == 0.0;
        (n, if ends { 0.0 } else { k2.max(0.0).sqrt() })
    };
    let ends = [one(r.x, g.x), one(r.y, g.y), one(r.z, g.z)];
    Expected::words(ends.map(|end| end.0).into_iter().chain(ends.map(|end| end.1)))
}
