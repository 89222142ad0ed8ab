//! Rules of quadrature, and the microfacet terms that the tables are integrals of.

use std::f64::consts::PI;

/// A direction with z along the normal.
pub type Direction = [f64; 3];

/// Nodes and weights of the Gauss-Legendre rule on [low, high].
pub fn gauss_legendre(count: usize, low: f64, high: f64) -> Vec<(f64, f64)> {
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    let rule = lamplight::quadrature::gauss_legendre(count);
    rule.into_iter().map(|(x, weight)| (middle - half * x, half * weight)).collect()
}

pub fn dot(a: Direction, b: Direction) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn normalized(a: Direction) -> Direction {
    let length = dot(a, a).sqrt();
    a.map(|component| component / length)
}

/// The direction to a viewer at a cosine, in the plane of x and z.
pub fn viewer(nv: f64) -> Direction {
    [(1.0 - nv * nv).max(0.0).sqrt(), 0.0, nv]
}

/// A direction of polar cosine `c` and sine `s` at an azimuth.
pub fn polar(c: f64, s: f64, azimuth: f64) -> Direction {
    [s * azimuth.cos(), s * azimuth.sin(), c]
}

/// `v` reflected about the facet's normal `h`.
pub fn mirrored(v: Direction, h: Direction) -> Direction {
    let twice = 2.0 * dot(v, h);
    [0, 1, 2].map(|i| twice * h[i] - v[i])
}

/// Distribution of normals of GGX. Walter et al., "Microfacet Models for Refraction through Rough
/// Surfaces", 2007, equation 33.
pub fn d_ggx(nh: f64, alpha: f64) -> f64 {
    let a2 = alpha * alpha;
    let below = (1.0 - nh * nh) + a2 * nh * nh;
    a2 / (PI * below * below)
}

/// Smith's height-correlated masking and shadowing, divided by 4 nl nv. Heitz, "Understanding the
/// Masking-Shadowing Function in Microfacet-Based BRDFs", 2014, equation 99.
pub fn v_smith(nl: f64, nv: f64, alpha: f64) -> f64 {
    let a2 = alpha * alpha;
    let side = |a: f64, b: f64| a * (b * b * (1.0 - a2) + a2).sqrt();
    0.5 / (side(nl, nv) + side(nv, nl))
}

/// The specular lobe without Fresnel's term, times the cosine of the light.
pub fn ggx_lobe(v: Direction, l: Direction, alpha: f64) -> f64 {
    if l[2] <= 0.0 {
        return 0.0;
    }
    let h = normalized([v[0] + l[0], v[1] + l[1], v[2] + l[2]]);
    d_ggx(h[2].min(1.0), alpha) * v_smith(l[2], v[2], alpha) * l[2]
}

/// The normal at the value `u` of the cumulative distribution of GGX's polar angle.
pub fn ggx_normal(u: f64, azimuth: f64, alpha: f64) -> Direction {
    let tan2 = alpha * alpha * u / (1.0 - u);
    let c = 1.0 / (1.0 + tan2).sqrt();
    polar(c, (1.0 - c * c).max(0.0).sqrt(), azimuth)
}
