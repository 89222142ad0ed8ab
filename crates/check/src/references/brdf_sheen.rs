//! Sources: Estevez and Kulla, 2017; Neubelt and Pettineo, 2013; Khronos Group,
//! KHR_materials_sheen, 2020; the fit of the albedo: MaterialX shader library, 2020;
//! Zeltner et al., 2022, in the fit of MaterialX, 2023.

use super::Source::{Published, Specification};
use super::{CallArguments, Expected, ReferenceEntry};
use glam::{DMat3, DVec3};
use std::f64::consts::PI;

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "brdf::sheen",
    functions: &[
        ("d_charlie", Specification, |a| d_charlie(a.f64(), a.f64()).into()),
        ("v_neubelt", Published, v_neubelt),
        ("charlie_exponent", Specification, |a| exponent(a.f64(), a.f64()).into()),
        ("charlie_lambda", Specification, |a| lambda(a.f64(), a.f64()).into()),
        ("v_charlie", Specification, v_charlie),
        ("sheen_albedo", Published, |a| sheen_albedo(a.f64(), a.f64()).into()),
        ("sheen_scale", Specification, sheen_scale),
        ("sheen_ltc", Published, |a| ltc(a.f64(), a.f64())),
        ("sheen_ltc_lobe", Published, |a| ltc_lobe(a.vec3(), a.vec3()).into()),
        ("v_neubelt_fast", Published, v_neubelt),
    ],
};

/// (2 + 1/alpha)*sin^(1/alpha)/(2*pi).
pub fn d_charlie(nh: f64, alpha: f64) -> f64 {
    let (power, cosine) = (1.0 / alpha.max(f64::from(0.001f32)), nh.clamp(0.0, 1.0));
    (2.0 + power) * cosine.acos().sin().powf(power) / (2.0 * PI)
}

fn v_neubelt(a: &mut CallArguments<'_>) -> Expected {
    let (nl, nv) = (a.f64(), a.f64());
    if nl <= 0.0 || nv <= 0.0 {
        return 0.0.into();
    }
    (1.0 / (4.0 * (nl + nv - nl * nv).max(f64::from(1e-6f32)))).into()
}

/// The fitted curve L(x). Its five coefficients are mixed by the weight from those for roughness 0
/// and 1.
fn exponent(x: f64, weight: f64) -> f64 {
    let smooth = [25.3245, 3.32435, 0.16801, -1.27393, -4.85967];
    let rough = [21.5473, 3.82987, 0.19823, -1.97760, -4.32054];
    let mixed: Vec<f64> = smooth
        .iter()
        .zip(rough)
        .map(|(smooth, rough)| weight * smooth + (1.0 - weight) * rough)
        .collect();
    let [a, b, c, d, e] = mixed[..] else { return f64::NAN };
    a / (1.0 + b * x.powf(c)) + d * x + e
}

/// exp(L(x)), where above 1/2 the exponent is 2*L(1/2) - L(1 - x).
fn lambda(mu: f64, alpha: f64) -> f64 {
    let x = mu.clamp(f64::from(1e-6f32), f64::from(0.999999f32));
    let weight = (1.0 - alpha.clamp(0.0, 1.0)).powi(2);
    let power = if x < 0.5 {
        exponent(x, weight)
    } else {
        2.0 * exponent(0.5, weight) - exponent(1.0 - x, weight)
    };
    power.exp()
}

fn v_charlie(a: &mut CallArguments<'_>) -> Expected {
    let (nl, nv, alpha) = (a.f64(), a.f64(), a.f64());
    if nl <= 0.0 || nv <= 0.0 {
        return 0.0.into();
    }
    let shown = 1.0 / (1.0 + lambda(nv, alpha) + lambda(nl, alpha));
    (shown / (4.0 * (nl * nv).max(f64::from(1e-12f32)))).into()
}

/// The fit of the albedo: a quotient of two quadratics in the cosine and alpha.
fn sheen_albedo(nv: f64, alpha: f64) -> f64 {
    let (x, y) = (nv.clamp(0.0, 1.0), alpha.clamp(0.0, 1.0));
    let terms = [1.0, x, y, x * y, x * x, y * y];
    let sum = |by: [f64; 6]| terms.iter().zip(by).map(|(term, by)| term * by).sum::<f64>();
    let over = sum([13.67300, -68.78018, 799.08825, -905.00061, 60.28956, 1086.96473]);
    let under = sum([1.0, 61.57746, 442.78211, 2597.49308, 121.81241, 3045.55075]);
    (over / under).clamp(0.0, 1.0)
}

fn sheen_scale(a: &mut CallArguments<'_>) -> Expected {
    let (color, ev, el) = (a.vec3(), a.f64(), a.f64());
    let left = |albedo: f64| 1.0 - color.max_element() * albedo;
    left(ev).min(left(el)).clamp(0.0, 1.0).into()
}

/// Two entries of the inverse matrix, and the reflectance: a Gaussian of the cosine with an offset.
fn ltc(x: f64, y: f64) -> Expected {
    let (x, y) = (x.clamp(0.0, 1.0), y.clamp(f64::from(0.01f32), 1.0));
    let a = (2.58126 * x + 0.813703 * y) * y / (1.0 + 0.310327 * x.powi(2) + 2.60994 * x * y);
    let under = 0.0000254053 + 1.71228 * x - 1.71506 * x * y + 1.34174 * y.powi(2);
    let b = (1.0 - x).sqrt() * (y - 1.0) * y.powi(3) / under;
    let deviation = y * (0.0206607 + 1.58491 * y) / (0.0379424 + 1.32227 * y + y.powi(2));
    let mean = (-0.193854 * y - 1.14885 * y.powi(2) + 1.7932 * y.powi(3) - 0.95943 * y.powi(5))
        / (0.046391 + y);
    let offset = (0.000654023 * y - 0.0207818 * y.powi(2) + 0.119681 * y.powi(3))
        / (1.26264 - 1.92021 * y + y.powi(2));
    let z = (x - mean) / deviation;
    let share = (-0.5 * z * z).exp() / (deviation * (2.0 * PI).sqrt()) + offset;
    Expected::words([a, b, share.clamp(0.0, 1.0)])
}

/// The cosine lobe of the transformed direction, times the change of solid angle: |det|/length^3.
fn ltc_lobe(t: DVec3, w: DVec3) -> f64 {
    let inverse = DMat3::from_cols_array_2d(&[[t.x, 0.0, 0.0], [0.0, t.x, 0.0], [t.y, 0.0, 1.0]]);
    let inside = inverse * w;
    let size = inside.length();
    match size > 1e-9 {
        true => (inside.z / size).max(0.0) / PI * inverse.determinant() / size.powi(3),
        false => 0.0,
    }
}
