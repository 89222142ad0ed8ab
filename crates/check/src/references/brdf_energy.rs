//! Sources: this library's fit, whose coefficients are repeated; Turquin, 2019, equation 16;
//! Fdez-Agüera, 2019; Kulla and Conty, 2017; Hill, in MaterialX; Karis, 2014; Lazarov, 2013, as
//! Knarkowicz has it.

use super::Source::{Published, Series};
use super::{CallArguments, Expected, ReferenceEntry};
use glam::DVec3;

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "brdf::energy",
    functions: &[
        ("dfg_approx", Published, dfg_approx),
        ("energy_compensation", Published, energy_compensation),
        ("split_sum_multi", Series, split_sum_multi),
        ("ms_lobe", Series, ms_lobe),
        ("dfg_approx_hill", Published, |a| hill(a.f64().clamp(0.0, 1.0), a.f64().clamp(0.0, 1.0))),
        ("dfg_approx_karis", Published, |a| karis(a.f64().clamp(0.0, 1.0), a.f64().clamp(0.0, 1.0))),
        ("dfg_approx_lazarov", Published, |a| lazarov(a.f64().clamp(0.0, 1.0), a.f64().clamp(0.0, 1.0))),
    ],
};

/// The sum of terms `coefficient*x^i*r^j`.
fn polynomial(x: f64, r: f64, terms: &[(f64, i32, i32)]) -> f64 {
    terms.iter().map(|(coefficient, i, j)| coefficient * x.powi(*i) * r.powi(*j)).sum()
}

/// Scale and bias of the split sum, from two quotients of polynomials in sqrt(nv) and the
/// roughness: `lost` is what single scattering loses, and `1 + rim` is the bias over (1 - nv)^5 of
/// the rest.
fn dfg_approx(a: &mut CallArguments<'_>) -> Expected {
    let (x, r) = (a.f64().clamp(0.0, 1.0), a.f64().clamp(f64::from(0.001f32), 1.0));
    let quotient = |above: &[(f64, i32, i32)], below: &[(f64, i32, i32)]| {
        polynomial(x.sqrt(), r, above) / polynomial(x.sqrt(), r, below)
    };
    let lost = quotient(
        &[
            (-0.0977434, 2, 2),
            (0.584869, 1, 3),
            (-0.0749448, 0, 4),
            (2.75245, 1, 7),
            (-0.059179, 0, 8),
        ],
        &[
            (1.0, 4, 0),
            (5.44816, 0, 4),
            (-3.04355, 0, 6),
            (2.15307, 0, 8),
            (1.33161, 2, 2),
            (3.50483, 2, 4),
            (-2.4634, 4, 2),
            (-3.83077, 1, 3),
            (0.373359, 5, 3),
        ],
    );
    let rim = quotient(
        &[(0.0406518, 0, 2), (-6.45071, 0, 4), (-1.51886, 0, 3), (4.0002, 4, 2)],
        &[(1.0, 2, 0), (-0.395461, 1, 1), (1.16293, 0, 2), (7.21068, 0, 4)],
    );
    let albedo = (1.0 - lost).clamp(0.0, 1.0);
    let offset = (albedo * (1.0 - x).powi(5) * (1.0 + rim)).clamp(0.0, albedo);
    Expected::words([albedo - offset, offset])
}

/// 1 + f0*(1 - E)/E.
fn energy_compensation(a: &mut CallArguments<'_>) -> Expected {
    let (f0, dfg) = (a.vec3(), a.vec2());
    let albedo = (dfg.x + dfg.y).clamp(f64::from(0.05f32), 1.0);
    (1.0 + f0 * (1.0 - albedo) / albedo).into()
}

/// Single scattering, and the light that it loses and that is reflected again: a geometric series
/// in the average reflectance times the lost share.
fn split_sum_multi(a: &mut CallArguments<'_>) -> Expected {
    let (f0, ks, dfg) = (a.vec3().clamp(DVec3::ZERO, DVec3::ONE), a.vec3(), a.vec2());
    let single = ks * dfg.x + dfg.y;
    let lost = 1.0 - (dfg.x + dfg.y).clamp(f64::from(0.05f32), 1.0);
    let average = f0 + (1.0 - f0) / 21.0;
    let series = |a: f64| (1..2000).map(|n| (a * lost).powi(n)).sum::<f64>();
    let multiple = single * DVec3::new(series(average.x), series(average.y), series(average.z));
    Expected::words(single.to_array().into_iter().chain(multiple.to_array()))
}

/// The lobe of all further bounces: (1 - Eo)*(1 - Ei)/(pi*(1 - E)), with the average albedo E, for
/// a white surface. Its colour is the sum over the bounces, of which each keeps and loses a share.
fn ms_lobe(a: &mut CallArguments<'_>) -> Expected {
    let (eo, ei) = (a.f64().clamp(0.0, 1.0), a.f64().clamp(0.0, 1.0));
    let kept = a.f64().clamp(f64::from(0.05f32), f64::from(0.9999f32));
    let white = (1.0 - eo) * (1.0 - ei) / (std::f64::consts::PI * (1.0 - kept));
    let one = |f: f64| {
        let bounces = (0..2000).map(|bounce| (f * (1.0 - kept)).powi(bounce)).sum::<f64>();
        white * f * f * kept * bounces
    };
    a.vec3().clamp(DVec3::ZERO, DVec3::ONE).map(one).into()
}

/// Two quotients of polynomials in the cosine and alpha. Each row has the coefficients of one
/// power: of the two numerators, then of the two denominators.
fn hill(nv: f64, r: f64) -> Expected {
    let terms: [([f64; 4], i32, i32); 9] = [
        ([0.1003, 0.9345, 1.0, 1.0], 0, 0),
        ([-0.6303, -2.323, -1.765, 0.2281], 1, 0),
        ([9.748, 2.229, 8.263, 15.94], 0, 2),
        ([-2.038, -3.748, 11.53, -55.83], 1, 2),
        ([29.34, 1.424, 28.96, 13.08], 2, 0),
        ([-8.245, -0.7684, -7.507, 41.26], 0, 4),
        ([-26.44, 1.436, -36.11, 54.9], 2, 2),
        ([19.99, 0.2913, 15.86, 300.2], 1, 4),
        ([-5.448, 0.6286, 33.37, -285.1], 2, 4),
    ];
    let part = |index: usize| {
        let own: Vec<_> = terms.iter().map(|(c, i, j)| (c[index], *i, *j)).collect();
        polynomial(nv, r, &own)
    };
    Expected::words([0, 1].map(|index| (part(index) / part(index + 2)).clamp(0.0, 1.0)))
}

fn karis(nv: f64, r: f64) -> Expected {
    let (c0, c1) = ([-1.0, -0.0275, -0.572, 0.022], [1.0, 0.0425, 1.04, -0.04]);
    let q: Vec<f64> = c0.iter().zip(c1).map(|(slope, start)| r * slope + start).collect();
    let a = (q[0] * q[0]).min((-9.28 * nv).exp2()) * q[0] + q[1];
    Expected::words([-1.04 * a + q[2], 1.04 * a + q[3]])
}

fn lazarov(y: f64, r: f64) -> Expected {
    let g = 1.0 - r;
    let smooth = polynomial(y, g, &[(-0.1688, 0, 1), (1.895, 0, 2)]);
    let rough = polynomial(y, g, &[(0.9903, 0, 0), (-4.853, 1, 0), (8.404, 2, 0), (-5.069, 3, 0)]);
    let bias = smooth.min(rough).clamp(0.0, 1.0);
    let total = [
        (0.6045, 0, 0),
        (1.699, 0, 1),
        (-0.5228, 1, 0),
        (-3.603, 0, 2),
        (1.404, 1, 1),
        (0.1939, 2, 0),
        (2.661, 0, 3),
    ];
    Expected::words([polynomial(y, g, &total).clamp(0.0, 1.0) - bias, bias])
}
