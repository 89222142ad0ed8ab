//! Sources: Khronos Group, KHR_materials_specular, _ior, _volume, _transmission and _dispersion,
//! 2021 to 2024; Beer's and Snell's laws; Walter et al., 2007, equations 21, 33 and 34.

use super::Source::{Published, Specification};
use super::brdf_fresnel::dielectric;
use super::{CallArguments, Expected, ReferenceEntry};
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "brdf::transmission",
    functions: &[
        ("specular_f0", Specification, specular_f0),
        ("volume_transmittance", Specification, volume_transmittance),
        ("refract_exit", Specification, refract_exit),
        ("transmission_roughness", Specification, |a| (a.f64() * (2.0 * a.f64() - 2.0).clamp(0.0, 1.0)).into()),
        ("btdf_thin", Specification, btdf_thin),
        ("dispersion_ior", Specification, dispersion_ior),
        ("btdf_volume", Published, btdf_volume),
        ("volume_transmittance_fast", Specification, volume_transmittance),
    ],
};

fn specular_f0(a: &mut CallArguments<'_>) -> Expected {
    let (f0, weight) = (dielectric(1.0, a.f64().max(0.0)), a.f64().clamp(0.0, 1.0));
    ((f0 * a.vec3()).clamp(DVec3::ZERO, DVec3::ONE) * weight).into()
}

/// exp(-x*sigma) with sigma = -ln(color)/d.
fn volume_transmittance(a: &mut CallArguments<'_>) -> Expected {
    let (color, x, d) = (a.vec3(), a.f64(), a.f64());
    if x <= 0.0 || d <= 0.0 {
        return DVec3::ONE.into();
    }
    let ways = (x / d).min(1e6);
    let one = |color: f64| if color <= 0.0 { 0.0 } else { (ways * color.min(1.0).ln()).exp() };
    Expected::words(color.to_array().map(one))
}

/// The refracted ray inside, by Snell's law, times the thickness: the part along the surface is
/// divided by the index, and the rest points inwards.
fn refract_exit(a: &mut CallArguments<'_>) -> Expected {
    let (v, n, ior, thickness) = (a.vec3(), a.vec3(), a.f64().max(1.0), a.f64());
    let along = -(v - n * n.dot(v)) / ior;
    let sine2 = (1.0 - n.dot(v).powi(2)) / (ior * ior);
    ((along - n * (1.0 - sine2).max(0.0).sqrt()) * thickness).into()
}

/// D*G1(l)*G1(v)/(4*nl*nv) for the light mirrored onto the viewer's side.
fn btdf_thin(a: &mut CallArguments<'_>) -> Expected {
    let (n, l, v, alpha) = (a.vec3(), a.vec3(), a.vec3(), a.f64());
    let l = l - 2.0 * n.dot(l) * n;
    let (nl, nv) = (n.dot(l), n.dot(v));
    if nl <= 0.0 || nv <= 0.0 || alpha == 0.0 {
        return 0.0.into();
    }
    let h = (l + v).normalize();
    let (a2, cos2) = (alpha * alpha, n.dot(h).powi(2));
    let d = a2 / (PI * (n.cross(h).length_squared() + cos2 * a2).powi(2));
    let side = |cosine: f64| cosine + (a2 + (1.0 - a2) * cosine * cosine).sqrt();
    (d / (side(nl) * side(nv)).max(f64::from(1e-12f32))).into()
}

fn dispersion_ior(a: &mut CallArguments<'_>) -> Expected {
    let ends = DVec2::new(a.f64().max(1.0), a.f64().max(0.0));
    let half_spread = (ends.x - 1.0) * 0.025 * ends.y;
    DVec3::new((ends.x - half_spread).max(1.0), ends.x, ends.x + half_spread).into()
}

/// Equation 21 without 1 - F, for an index of 1 on the viewer's side, with G1 by equation 34.
fn btdf_volume(a: &mut CallArguments<'_>) -> Expected {
    let (n, l, v, alpha, ior) = (a.vec3(), a.vec3(), a.vec3(), a.f64(), a.f64());
    let h = -(ior * l + v);
    let h = h * if ior < 1.0 { -1.0 } else { 1.0 } / h.length();
    let (nl, nv, lh, vh, nh) = (n.dot(l), n.dot(v), l.dot(h), v.dot(h), n.dot(h));
    if nl >= 0.0 || nv <= 0.0 || lh >= 0.0 || vh <= 0.0 || nh <= 0.0 || alpha == 0.0 {
        return 0.0.into();
    }
    let a2 = alpha * alpha;
    let d = a2 / (PI * (n.cross(h).length_squared() + nh * nh * a2).powi(2));
    let g1 = |cosine: f64| {
        let tangent2 = (1.0 - cosine * cosine) / (cosine * cosine);
        2.0 / (1.0 + (1.0 + a2 * tangent2.max(0.0)).sqrt())
    };
    let facets = (lh * vh / (nl * nv)).abs();
    (facets * g1(nl) * g1(nv) * d / (ior * lh + vh).powi(2)).into()
}
