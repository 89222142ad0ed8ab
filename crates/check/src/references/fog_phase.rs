//! Sources: Henyey and Greenstein, 1941; Cornette and Shanks, 1992; Draine, 2003; Jendersie and
//! d'Eon, 2023.

use super::Source::Published;
use super::{CallArguments, Expected, ReferenceEntry};
use std::f64::consts::PI;

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "fog::phase",
    functions: &[
        ("hg", Published, |a| hg(a.f64(), a.f64()).into()),
        ("rayleigh_phase", Published, |a| (3.0 / (16.0 * PI) * (1.0 + cosine(a.f64()).powi(2))).into()),
        ("cornette_shanks", Published, cornette_shanks),
        ("draine", Published, |a| draine(a.f64(), a.f64(), a.f64()).into()),
        ("fog_droplet", Published, droplet),
    ],
};

fn cosine(c: f64) -> f64 {
    c.clamp(-1.0, 1.0)
}

fn asymmetry(g: f64) -> f64 {
    g.clamp(-f64::from(0.999f32), f64::from(0.999f32))
}

fn hg(c: f64, g: f64) -> f64 {
    let (c, g) = (cosine(c), asymmetry(g));
    (1.0 - g * g) / (4.0 * PI) * (1.0 + g * g - 2.0 * g * c).powf(-1.5)
}

/// 3/(8*pi)*(1 - g^2)*(1 + c^2)/((2 + g^2)*(1 + g^2 - 2*g*c)^1.5).
fn cornette_shanks(a: &mut CallArguments<'_>) -> Expected {
    let (c, g) = (cosine(a.f64()), asymmetry(a.f64()));
    let shape = (1.0 + c * c) / (1.0 + g * g - 2.0 * g * c).powf(1.5);
    (3.0 / (8.0 * PI) * (1.0 - g * g) / (2.0 + g * g) * shape).into()
}

fn draine(c: f64, g: f64, alpha: f64) -> f64 {
    let (c, g, alpha) = (cosine(c), asymmetry(g), alpha.clamp(0.0, 1e6));
    hg(c, g) * (1.0 + alpha * c * c) / (1.0 + alpha / 3.0 * (1.0 + 2.0 * g * g))
}

/// The parameters of both lobes, fitted over the diameter of the droplets, and the blend of the
/// lobes.
fn droplet(a: &mut CallArguments<'_>) -> Expected {
    let (c, d) = (a.f64(), a.f64().clamp(5.0, 50.0));
    let g_hg = (-0.0990567 / (d - 1.67154)).exp();
    let g_d = (-2.20679 / (d + 3.91029) - 0.428934).exp();
    let alpha = (3.62489 - 8.29288 / (d + 5.52825)).exp();
    let w = (-0.599085 / (d - 0.641583) - 0.665888).exp();
    ((1.0 - w) * hg(c, g_hg) + w * draine(c, g_d, alpha)).into()
}
