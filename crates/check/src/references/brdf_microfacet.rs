//! Sources: Burley, 2012, appendix B.2; Heitz, 2014, equations 72, 86 and 99; Khronos Group,
//! KHR_materials_anisotropy, 2023; Tokuyoshi and Kaplanyan, 2019; Filament, section 4.10.1; OpenPBR
//! 1.1; Kelemen and Szirmay-Kalos, 2001; Dupuy and Benyoub, 2023.

use super::Source::{Published, Specification};
use super::{CallArguments, Expected, ReferenceEntry};
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "brdf::microfacet",
    functions: &[
        ("d_ggx_aniso", Published, |a| d_ggx_aniso(a.vec3(), a.vec2()).into()),
        ("v_smith_ggx_aniso", Published, v_smith_ggx_aniso),
        ("alpha_aniso", Specification, alpha_aniso),
        ("specular_aa", Published, specular_aa),
        ("bent_reflection", Specification, bent_reflection),
        ("alpha_aniso_filament", Published, alpha_filament),
        ("alpha_aniso_disney", Published, alpha_disney),
        ("alpha_aniso_openpbr", Specification, alpha_openpbr),
        ("v_kelemen", Published, |a| (1.0 / (4.0 * a.f64().powi(2).max(f64::from(f32::MIN_POSITIVE)))).into()),
        ("sample_ggx_visible", Published, sample_visible),
    ],
};

/// The distribution of normals by their slopes (th/nh, bh/nh): 1/(pi*at*ab*nh^4*(1 +
/// (slopes/alphas)^2)^2). A half vector that is too short, by rounding, gives at most the peak.
pub fn d_ggx_aniso(h: DVec3, alpha: DVec2) -> f64 {
    if alpha.min_element() < f64::from(1e-9f32) {
        return 0.0;
    }
    let stretched = DVec3::new(h.x / alpha.x, h.y / alpha.y, h.z).length_squared();
    1.0 / (PI * alpha.x * alpha.y * stretched.max(1.0).powi(2))
}

/// G2/(4*nl*nv) with G2 = 1/(1 + Lambda(v) + Lambda(l)), Lambda = (sqrt(1 + a^2) - 1)/2, where
/// a^2 = (at^2*t^2 + ab^2*b^2)/n^2.
fn v_smith_ggx_aniso(a: &mut CallArguments<'_>) -> Expected {
    let (v, l, alpha) = (a.vec3(), a.vec3(), a.vec2());
    if v.z <= 0.0 || l.z <= 0.0 {
        return 0.0.into();
    }
    let lambda = |w: DVec3| {
        let a2 = (alpha * DVec2::new(w.x, w.y)).length_squared() / (w.z * w.z);
        ((1.0 + a2).sqrt() - 1.0) / 2.0
    };
    (1.0 / ((1.0 + lambda(v) + lambda(l)) * 4.0 * l.z * v.z)).into()
}

fn alpha_aniso(a: &mut CallArguments<'_>) -> Expected {
    let (alpha, strength) = (a.f64().clamp(0.0, 1.0), a.f64().clamp(0.0, 1.0));
    let share = strength * strength;
    DVec2::new(alpha * (1.0 - share) + share, alpha).into()
}

/// The variance of the shading normal within the pixel, times 2 * sigma2 and limited, is added to
/// the square of alpha.
fn specular_aa(a: &mut CallArguments<'_>) -> Expected {
    let (alpha, dx, dy, sigma2, limit) = (a.f64(), a.vec3(), a.vec3(), a.f64(), a.f64());
    let kernel = 2.0 * sigma2 * (dx.length_squared() + dy.length_squared());
    (alpha * alpha + kernel.min(limit)).clamp(0.0, 1.0).sqrt().into()
}

/// The bent normal is (b x v) x b, mixed with n and mirrored.
fn bent_reflection(a: &mut CallArguments<'_>) -> Expected {
    let (v, n, b) = (a.vec3(), a.vec3(), a.vec3());
    let (strength, roughness) = (a.f64().clamp(0.0, 1.0), a.f64().clamp(0.0, 1.0));
    let bent = b.cross(v).cross(b).try_normalize().unwrap_or(n);
    let m = bent.lerp(n, (1.0 - strength * (1.0 - roughness)).powi(4)).try_normalize().unwrap_or(n);
    (2.0 * m.dot(v) * m - v).into()
}

fn alpha_filament(a: &mut CallArguments<'_>) -> Expected {
    let (alpha, strength) = (a.f64().clamp(0.0, 1.0), a.f64().clamp(-1.0, 1.0));
    (alpha * DVec2::new(1.0 + strength, 1.0 - strength)).into()
}

/// The alphas are alpha/aspect and alpha*aspect, with aspect = sqrt(1 - 0.9*strength).
fn alpha_disney(a: &mut CallArguments<'_>) -> Expected {
    let (alpha, strength) = (a.f64().clamp(0.0, 1.0), a.f64().clamp(0.0, 1.0));
    let aspect = (1.0 - 0.9 * strength).sqrt();
    DVec2::new(alpha / aspect, alpha * aspect).into()
}

/// Both alphas have the ratio 1 - s, and the mean of their squares is that of `alpha`.
fn alpha_openpbr(a: &mut CallArguments<'_>) -> Expected {
    let (alpha, strength) = (a.f64().clamp(0.0, 1.0), a.f64().clamp(0.0, 1.0));
    let ratio = DVec2::new(1.0, 1.0 - strength);
    (alpha * ratio * (2.0 / ratio.length_squared()).sqrt()).into()
}

/// Samples the visible normals by a spherical cap: a direction whose height is even in the second
/// number from -w.z to 1, where w is the stretched view direction. The half vector of both,
/// unstretched, is the normal.
fn sample_visible(a: &mut CallArguments<'_>) -> Expected {
    let (v, alpha, u) = (a.vec3(), a.vec2(), a.vec2());
    let stretch = alpha.extend(1.0);
    let w = (DVec3::new(v.x, v.y, v.z.max(0.0)) * stretch).try_normalize().unwrap_or(DVec3::Z);
    let theta = (1.0 - u.y * (1.0 + w.z)).clamp(-1.0, 1.0).acos();
    let (sine, cosine) = (TAU * u.x - PI).sin_cos();
    let cap = DVec3::new(theta.sin() * cosine, theta.sin() * sine, theta.cos());
    ((cap + w) * stretch).try_normalize().unwrap_or(DVec3::Z).into()
}
