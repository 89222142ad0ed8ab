//! Directional albedo of GGX, split by Fresnel's term of Schlick: `f0 * scale + f90 * offset`.
//!
//! Karis, "Real Shading in Unreal Engine 4", 2013, section "Image-Based Lighting"; the visibility
//! is Smith's with correlated heights.

use std::f64::consts::PI;

use crate::Cell;
use crate::quadrature::{Direction, dot, gauss_legendre, ggx_normal, mirrored, v_smith, viewer};

/// Steps in the polar angle of the facets; there are twice as many azimuths.
const STEPS: usize = 128;

/// The scale and the offset of a cell.
pub fn cell(at: Cell) -> Vec<f64> {
    albedo(at.nv(), at.alpha(), STEPS).to_vec()
}

/// The scale and the offset, by a quadrature with `steps` polar angles.
pub fn albedo(nv: f64, alpha: f64, steps: usize) -> [f64; 2] {
    let (v, azimuths) = (viewer(nv), 2 * steps);
    let mut sum = [0.0; 2];
    for (x, weight) in gauss_legendre(steps, 0.0, 1.0) {
        // Half a turn is enough, since the integrand is symmetric. The quadratic substitution moves
        // nodes to the tail.
        let u = x * (2.0 - x);
        let weight = weight * 2.0 * (1.0 - x) / azimuths as f64;
        for step in 0..azimuths {
            let azimuth = PI * (step as f64 + 0.5) / azimuths as f64;
            let part = reflected(v, ggx_normal(u, azimuth, alpha), alpha);
            sum = [sum[0] + weight * part[0], sum[1] + weight * part[1]];
        }
    }
    sum
}

/// What a facet that is sampled from GGX's distribution adds to the scale and the offset.
fn reflected(v: Direction, h: Direction, alpha: f64) -> [f64; 2] {
    let vh = dot(v, h);
    let l = mirrored(v, h);
    if vh <= 0.0 || l[2] <= 0.0 {
        return [0.0; 2];
    }
    let all = v_smith(l[2], v[2], alpha) * l[2] * 4.0 * vh / h[2];
    let grazing = (1.0 - vh).powi(5);
    [all * (1.0 - grazing), all * grazing]
}
