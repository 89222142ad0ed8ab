//! Sources: Phong, 1975; Blinn, 1977; Igalia, part I; Akenine-Möller et al., Real-Time Rendering,
//! 3rd edition, section 7.6; Walter et al., 2007, equation 33; Heitz, 2014, equation 99; Schlick,
//! 1994, equation 15.

use super::Source::Published;
use super::math_safe::safe_pow;
use super::{CallArguments, Expected, ReferenceEntry};
use glam::DVec3;
use std::f64::consts::PI;

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "brdf::specular",
    functions: &[
        ("phong", Published, |a| phong(a.vec3(), a.vec3(), a.vec3(), a.f64()).into()),
        ("phong_igl", Published, phong_igl),
        ("phong_oglpg_7_21", Published, |a| phong_oglpg(a.vec3(), a.vec3(), a.vec3(), a.f64()).into()),
        ("blinn_phong", Published, |a| blinn_phong(a.vec3(), a.vec3(), a.vec3(), a.f64()).into()),
        ("blinn_phong_half", Published, blinn_phong_half),
        ("blinn_phong_hpg", Published, |a| blinn_phong_hpg(a.vec3(), a.vec3(), a.vec3(), a.f64()).into()),
        ("blinn_phong_normalized", Published, blinn_phong_normalized),
        ("d_ggx", Published, d_ggx),
        ("v_smith_ggx", Published, v_smith_ggx),
        ("f_schlick", Published, f_schlick),
        ("v_smith_ggx_fast", Published, v_smith_ggx),
        ("phong_fast", Published, |a| phong_fast(a.vec3(), a.vec3(), a.vec3(), a.f64()).into()),
        ("blinn_phong_fast", Published, |a| {
            blinn_phong_fast(a.vec3(), a.vec3(), a.vec3(), a.f64()).into()
        }),
    ],
};

/// The mirror direction of the light: 2(n.l)n - l.
fn mirrored(n: DVec3, l: DVec3) -> DVec3 {
    2.0 * n.dot(l) * n - l
}

fn phong(n: DVec3, l: DVec3, v: DVec3, s: f64) -> f64 {
    if n.dot(l) > 0.0 { safe_pow(mirrored(n, l).dot(v), s) } else { 0.0 }
}

fn phong_igl(a: &mut CallArguments<'_>) -> Expected {
    let (n, l, v, s) = (a.vec3(), a.vec3(), a.vec3(), a.f64());
    let value = if n.dot(l) >= 0.0 { mirrored(n, l).dot(v).max(0.0).powf(s) } else { 0.0 };
    value.into()
}

/// NaN for a base of 0 or less, for which the shader's `pow` is indeterminate. Every result is
/// accepted there.
pub fn phong_oglpg(n: DVec3, l: DVec3, v: DVec3, s: f64) -> f64 {
    let base = mirrored(n, l).dot(v);
    if base > 0.0 { base.powf(s) } else { f64::NAN }
}

/// max(n.h, 0)^s with h halfway between l and v; 0 at and behind the horizon.
pub fn blinn_phong(n: DVec3, l: DVec3, v: DVec3, s: f64) -> f64 {
    if n.dot(l) > 0.0 { safe_pow(n.dot((l + v).normalize_or_zero()), s) } else { 0.0 }
}

fn blinn_phong_half(a: &mut CallArguments<'_>) -> Expected {
    let (cosine, n_dot_l, s) = (a.vec3().dot(a.vec3()), a.f64(), a.f64());
    let value = if n_dot_l > 0.0 { safe_pow(cosine, s) } else { 0.0 };
    value.into()
}

fn blinn_phong_hpg(n: DVec3, l: DVec3, v: DVec3, s: f64) -> f64 {
    let base = n.dot((l + v).normalize());
    if base > 0.0 { base.powf(s) } else { f64::NAN }
}

fn blinn_phong_normalized(a: &mut CallArguments<'_>) -> Expected {
    let (n, l, v, s) = (a.vec3(), a.vec3(), a.vec3(), a.f64());
    ((s + 8.0) / (8.0 * PI) * blinn_phong(n, l, v, s)).into()
}

/// a^2/(pi*(|n x h|^2 + (n.h)^2 a^2)^2), which is a^2/(pi*((n.h)^2(a^2 - 1) + 1)^2).
fn d_ggx(a: &mut CallArguments<'_>) -> Expected {
    let (nh, cross2, alpha) = (a.f64(), a.f64(), a.f64());
    if alpha == 0.0 {
        return 0.0.into();
    }
    (alpha * alpha / (PI * (cross2 + (nh * alpha).powi(2)).powi(2))).into()
}

fn v_smith_ggx(a: &mut CallArguments<'_>) -> Expected {
    let (nv, nl, a2) = (a.f64(), a.f64(), a.f64().powi(2));
    if nv <= 0.0 || nl <= 0.0 {
        return 0.0.into();
    }
    let side = |one: f64, other: f64| one * (other * other * (1.0 - a2) + a2).sqrt();
    (0.5 / (side(nl, nv) + side(nv, nl))).into()
}

fn f_schlick(a: &mut CallArguments<'_>) -> Expected {
    let (f0, f90, vh) = (a.vec3(), a.f64(), a.f64());
    (f0 + (f90 - f0) * (1.0 - vh.clamp(0.0, 1.0)).powi(5)).into()
}

fn phong_fast(n: DVec3, l: DVec3, v: DVec3, s: f64) -> f64 {
    safe_pow(mirrored(n, l).dot(v), s)
}

fn blinn_phong_fast(n: DVec3, l: DVec3, v: DVec3, s: f64) -> f64 {
    safe_pow(n.dot((l + v).normalize_or_zero()), s)
}
