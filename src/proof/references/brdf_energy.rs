//! Sources: this library's fit, whose coefficients are repeated; Turquin, 2019, equation 16;
//! Fdez-Agüera, 2019; Kulla and Conty, 2017; Karis, 2014; Lazarov, 2013, as Knarkowicz has it.

use super::{Arguments, Entry, Expected};
use glam::DVec3;

pub const REFERENCES: Entry = Entry {
    module: "brdf::energy",
    functions: &[
        ("dfg_approx", dfg_approx),
        ("energy_compensation", energy_compensation),
        ("split_sum_multi", split_sum_multi),
        ("ms_lobe", ms_lobe),
        ("dfg_approx_karis", |a| karis(a.f64().clamp(0.0, 1.0), a.f64().clamp(0.0, 1.0))),
        ("dfg_approx_lazarov", |a| lazarov(a.f64().clamp(0.0, 1.0), a.f64().clamp(0.0, 1.0))),
    ],
};

/// The sum of terms `coefficient*x^i*r^j`.
fn polynomial(x: f64, r: f64, terms: &[(f64, i32, i32)]) -> f64 {
    terms.iter().map(|(coefficient, i, j)| coefficient * x.powi(*i) * r.powi(*j)).sum()
}

/// What is lost, and what light at grazing angles adds, as quotients of polynomials in the cosine
/// and the roughness.
fn dfg_approx(a: &mut Arguments<'_>) -> Expected {
    let (x, r) = (a.f64().clamp(0.0, 1.0), a.f64().clamp(f64::from(0.001f32), 1.0));
    let lost = polynomial(
        x,
        r,
        &[
            (0.23276, 1, 2),
            (-0.515853, 1, 3),
            (1.65042, 1, 4),
            (-0.195382, 2, 2),
            (0.113177, 0, 4),
            (-0.449665, 0, 5),
            (0.389169, 0, 6),
        ],
    );
    let below_lost =
        [(0.662638, 0, 4), (0.615166, 1, 2), (0.752615, 1, 3), (1.0, 2, 0), (-1.29414, 2, 1)];
    let rim =
        [(0.000408534, 0, 0), (1.0, 0, 1), (1.04599, 0, 2), (1.57997, 1, 0), (-4.38461, 1, 1)];
    let below_rim = [
        (0.000408534, 0, 0),
        (0.995197, 0, 1),
        (4.01817, 0, 2),
        (35.8067, 0, 4),
        (1.52364, 1, 0),
        (-7.0989, 1, 1),
        (5.55121, 2, 0),
    ];
    let albedo = 1.0 - lost / polynomial(x, r, &below_lost);
    let offset = (1.0 - x).powi(3) * polynomial(x, r, &rim) / polynomial(x, r, &below_rim);
    let offset = offset.clamp(0.0, 1.0);
    Expected::words([(albedo - offset).clamp(0.0, 1.0), offset])
}

/// 1 + f0*(1 - E)/E.
fn energy_compensation(a: &mut Arguments<'_>) -> Expected {
    let (f0, dfg) = (a.vec3(), a.vec2());
    let albedo = (dfg.x + dfg.y).clamp(f64::from(0.05f32), 1.0);
    (1.0 + f0 * (1.0 - albedo) / albedo).into()
}

/// The light that is lost at once is reflected again and again: a geometric series of the average
/// reflectance.
fn split_sum_multi(a: &mut Arguments<'_>) -> Expected {
    let (f0, ks, dfg) = (a.vec3().clamp(DVec3::ZERO, DVec3::ONE), a.vec3(), a.vec2());
    let single = ks * dfg.x + dfg.y;
    let lost = 1.0 - (dfg.x + dfg.y).clamp(f64::from(0.05f32), 1.0);
    let average = f0 + (1.0 - f0) / 21.0;
    let series = |a: f64| (1..2000).map(|n| (a * lost).powi(n)).sum::<f64>();
    let multiple = single * DVec3::new(series(average.x), series(average.y), series(average.z));
    Expected::words(single.to_array().into_iter().chain(multiple.to_array()))
}

/// What is left of light that is lost at once, then kept in part and lost in part at each bounce.
fn ms_lobe(a: &mut Arguments<'_>) -> Expected {
    let (eo, ei) = (a.f64().clamp(0.0, 1.0), a.f64().clamp(0.0, 1.0));
    let kept = a.f64().clamp(f64::from(0.05f32), f64::from(0.9999f32));
    let white = (1.0 - eo) * (1.0 - ei) / (std::f64::consts::PI * (1.0 - kept));
    let one = |f: f64| {
        let bounces = (0..2000).map(|bounce| (f * (1.0 - kept)).powi(bounce)).sum::<f64>();
        white * f * f * kept * bounces
    };
    a.vec3().clamp(DVec3::ZERO, DVec3::ONE).map(one).into()
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
