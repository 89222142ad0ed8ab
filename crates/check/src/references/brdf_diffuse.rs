//! Sources: Lambert, "Photometria", 1760; Valve's half Lambert; Green, GPU Gems, 2004, chapter 16
//! (wrap); Oren and Nayar, 1994 (qualitative model); Burley, 2012, section 5.3; Portsmouth, Kutz
//! and Hill, 2025 (EON); Hill's fit in MaterialX, 2021; Khronos Group,
//! KHR_materials_diffuse_transmission, 2024; McAuley, 2011 (energy of a wrap).

use super::Source::{Published, Specification};
use super::{CallArguments, Expected, ReferenceEntry};
use glam::DVec3;
use std::f64::consts::{FRAC_1_PI, PI};

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "brdf::diffuse",
    functions: &[
        ("lambert", Published, |a| lambert(a.vec3(), a.vec3()).into()),
        ("half_lambert", Published, |a| (0.5 * a.vec3().dot(a.vec3()) + 0.5).powi(2).into()),
        ("wrap", Published, wrap),
        ("oren_nayar", Published, oren_nayar),
        ("burley", Published, burley),
        ("eon_g", Published, |a| (eon_g(a.f64()) / PI).into()),
        ("eon_albedo", Published, |a| eon_albedo(a.f64(), a.f64()).min(1.0).into()),
        ("eon", Published, eon),
        ("burley_albedo", Published, burley_albedo),
        ("diffuse_transmission", Specification, diffuse_transmission),
        ("fd_wrap", Published, |a| fd_wrap(a.f64(), a.f64().max(0.0)).into()),
    ],
};

/// max(n.l, 0).
pub fn lambert(n: DVec3, l: DVec3) -> f64 {
    n.dot(l).max(0.0)
}

fn wrap(a: &mut CallArguments<'_>) -> Expected {
    let (cosine, w) = (a.vec3().dot(a.vec3()), a.f64().max(0.0));
    ((cosine + w) / (1.0 + w)).max(0.0).into()
}

/// cos(tl)*(A + B*max(cos(phi), 0)*sin(max(tl, tv))*tan(min(tl, tv))), from angles.
fn oren_nayar(a: &mut CallArguments<'_>) -> Expected {
    let (n, l, v, sigma) = (a.vec3(), a.vec3(), a.vec3(), a.f64());
    let (nl, nv) = (n.dot(l), n.dot(v).max(0.0));
    if nl <= 0.0 {
        return 0.0.into();
    }
    let (s2, tl, tv) = (sigma * sigma, nl.min(1.0).acos(), nv.min(1.0).acos());
    let (across_l, across_v) = (l - n * nl, v - n * n.dot(v));
    let cos_phi = across_l.normalize_or_zero().dot(across_v.normalize_or_zero()).max(0.0);
    let (rough, slope) = (1.0 - 0.5 * s2 / (s2 + 0.33), 0.45 * s2 / (s2 + 0.09));
    (nl * (rough + slope * cos_phi * tl.max(tv).sin() * tl.min(tv).tan())).into()
}

fn burley(a: &mut CallArguments<'_>) -> Expected {
    let (nl, nv, lh, roughness) = (a.f64(), a.f64(), a.f64(), a.f64());
    let f90 = 0.5 + 2.0 * roughness * lh * lh;
    let rise = |cosine: f64| 1.0 + (f90 - 1.0) * (1.0 - cosine.clamp(0.0, 1.0)).powi(5);
    (rise(nl) * rise(nv) * FRAC_1_PI).into()
}

/// G, a polynomial in 1 - mu with the published coefficients.
fn eon_g(mu: f64) -> f64 {
    let m = 1.0 - mu.clamp(0.0, 1.0);
    let terms = [0.0571085289, 0.491881867, -0.332181442, 0.0714429953];
    PI * terms.iter().zip(1..).map(|(term, power)| term * m.powi(power)).sum::<f64>()
}

/// The constants c1 and c2 of the model.
const C1: f64 = 0.5 - 2.0 / (3.0 * PI);
const C2: f64 = 2.0 / 3.0 - 28.0 / (15.0 * PI);

/// E = A*(1 + r*G/pi) with A = 1/(1 + c1*r).
fn eon_albedo(mu: f64, roughness: f64) -> f64 {
    let r = roughness.clamp(0.0, 1.0);
    (1.0 + r * eon_g(mu) / PI) / (1.0 + C1 * r)
}

/// The single-scattering lobe, and rho_ms/pi*(1 - E_o)*(1 - E_i)/(1 - E_avg).
fn eon(a: &mut CallArguments<'_>) -> Expected {
    let (albedo, roughness) = (a.vec3().clamp(DVec3::ZERO, DVec3::ONE), a.f64().clamp(0.0, 1.0));
    let (nl, nv, lv) = (a.f64(), a.f64(), a.f64());
    if nl <= 0.0 || nv <= 0.0 {
        return DVec3::ZERO.into();
    }
    let level = 1.0 / (1.0 + C1 * roughness);
    let s = lv - nl * nv;
    let rim = if s > 0.0 { s / nl.max(nv).max(f64::from(1e-6f32)) } else { s };
    let single = albedo * FRAC_1_PI * level * (1.0 + roughness * rim).max(0.0);
    let average = level * (1.0 + C2 * roughness);
    if roughness == 0.0 {
        return single.into();
    }
    let lost = |mu: f64| (1.0 - eon_albedo(mu, roughness)).max(0.0);
    let color = albedo * albedo * average / (1.0 - albedo * (1.0 - average));
    (single + color * FRAC_1_PI * lost(nl) * lost(nv) / (1.0 - average)).into()
}

/// A blend by roughness of two fits: for a smooth surface with the fifth power of 1 - x, for a
/// rough one a cubic in x.
fn burley_albedo(a: &mut CallArguments<'_>) -> Expected {
    let (x, r) = (a.f64().clamp(0.0, 1.0), a.f64().clamp(0.0, 1.0));
    let smooth = 0.97619 - 0.488095 * (1.0 - x).powi(5);
    let rough = 1.55754 - 2.02221 * x + 2.56283 * x * x - 1.06244 * x * x * x;
    ((1.0 - r) * smooth + r * rough).into()
}

/// Lambert's cosine: on the viewer's side the share that is not transmitted, on the other side the
/// rest.
fn diffuse_transmission(a: &mut CallArguments<'_>) -> Expected {
    let (nl, share) = (a.f64(), a.f64().clamp(0.0, 1.0));
    (((1.0 - share) * nl.max(0.0) + share * (-nl).max(0.0)) * FRAC_1_PI).into()
}

/// The wrapped cosine over (1 + w)^2, which keeps its integral over all directions.
fn fd_wrap(nl: f64, w: f64) -> f64 {
    ((nl + w) / (1.0 + w).powi(2)).clamp(0.0, 1.0)
}
