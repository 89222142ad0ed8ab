//! Directional albedo of cloth: the distribution of Charlie, with the visibility of Neubelt and
//! Pettineo and with that of Charlie.
//!
//! Estevez, Kulla, "Production Friendly Microfacet Sheen BRDF", 2017, sections 2 and 3; Neubelt,
//! Pettineo, "Crafting a Next-Gen Material Pipeline for The Order: 1886", 2013.

use std::f64::consts::PI;

use crate::Cell;
use crate::quadrature::{Direction, dot, gauss_legendre, mirrored, polar, viewer};

/// Steps in the polar angle of the facets; there are twice as many azimuths.
const STEPS: usize = 128;

/// The least alpha of `brdf::sheen`.
const LEAST_SHEEN: f64 = 0.001;

/// Albedo with Neubelt's visibility, and with Charlie's.
pub fn cell(at: Cell) -> Vec<f64> {
    albedo(at.nv(), at.alpha(), STEPS).to_vec()
}

/// The same, by a quadrature with `steps` polar angles.
pub fn albedo(nv: f64, alpha: f64, steps: usize) -> [f64; 2] {
    let alpha = alpha.max(LEAST_SHEEN);
    let (v, azimuths, power) = (viewer(nv), 2 * steps, 1.0 / alpha);
    // Facets whose cosine to the surface's normal is larger are fewer than one in 10^13.
    let most = (8.0 / power.sqrt()).min(1.0);
    let mut sum = [0.0; 2];
    for (x, weight) in gauss_legendre(steps, 0.0, 1.0) {
        let c = most * x * x;
        let weight = weight * 2.0 * most * x * 2.0 * PI / azimuths as f64;
        let s = (1.0 - c * c).sqrt();
        let distribution = (2.0 + power) * s.powf(power) / (2.0 * PI);
        for step in 0..azimuths {
            let azimuth = PI * (step as f64 + 0.5) / azimuths as f64;
            let part = reflected(v, polar(c, s, azimuth), alpha);
            sum = [0, 1].map(|i| sum[i] + weight * distribution * part[i]);
        }
    }
    sum
}

/// What facets of a normal add to the albedo, for a distribution of 1.
fn reflected(v: Direction, h: Direction, alpha: f64) -> [f64; 2] {
    let vh = dot(v, h);
    let l = mirrored(v, h);
    if vh <= 0.0 || l[2] <= 0.0 {
        return [0.0; 2];
    }
    let (nl, nv) = (l[2], v[2]);
    let neubelt = 1.0 / (4.0 * (nl + nv - nl * nv));
    let charlie = 1.0 / ((1.0 + lambda(nl, alpha) + lambda(nv, alpha)) * 4.0 * nl * nv);
    [neubelt, charlie].map(|visibility| visibility * nl * 4.0 * vh)
}

/// The fit of Smith's lambda, section 3, table 1.
pub fn lambda(cosine: f64, alpha: f64) -> f64 {
    let t = (1.0 - alpha) * (1.0 - alpha);
    let mix = |rough: f64, smooth: f64| rough + (smooth - rough) * t;
    let (a, b) = (mix(21.5473, 25.3245), mix(3.82987, 3.32435));
    let (c, d, e) = (mix(0.19823, 0.16801), mix(-1.97760, -1.27393), mix(-4.32054, -4.85967));
    let fit = |x: f64| a / (1.0 + b * x.powf(c)) + d * x + e;
    if cosine < 0.5 { fit(cosine).exp() } else { (2.0 * fit(0.5) - fit(1.0 - cosine)).exp() }
}
