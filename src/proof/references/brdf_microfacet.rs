//! Sources: Burley, 2012, appendix B.2; Heitz, 2014, equations 72, 86 and 99; Khronos Group,
//! KHR_materials_anisotropy, 2023; Tokuyoshi and Kaplanyan, 2019.

use super::{Arguments, Entry, Expected};
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

pub const REFERENCES: Entry = Entry {
    module: "brdf::microfacet",
    functions: &[
        ("d_ggx_aniso", |a| d_ggx_aniso(a.vec3(), a.vec2()).into()),
        ("v_smith_ggx_aniso", v_smith_ggx_aniso),
        ("alpha_aniso", alpha_aniso),
        ("specular_aa", specular_aa),
        ("bent_reflection", bent_reflection),
    ],
};

/// The distribution of slopes (th/nh, bh/nh): 1/(pi*at*ab*nh^4*(1 + slopes over alphas)^2); a
/// vector shorter than a unit vector counts as the peak.
pub fn d_ggx_aniso(h: DVec3, alpha: DVec2) -> f64 {
    if alpha.min_element() < f64::from(1e-9f32) {
        return 0.0;
    }
    let stretched = DVec3::new(h.x / alpha.x, h.y / alpha.y, h.z).length_squared();
    1.0 / (PI * alpha.x * alpha.y * stretched.max(1.0).powi(2))
}

/// G2/(4*nl*nv) with G2 = 1/(1 + Lambda(v) + Lambda(l)), Lambda = (sqrt(1 + a^2) - 1)/2, where
/// a^2 = (at^2*t^2 + ab^2*b^2)/n^2.
fn v_smith_ggx_aniso(a: &mut Arguments<'_>) -> Expected {
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

fn alpha_aniso(a: &mut Arguments<'_>) -> Expected {
    let (alpha, strength) = (a.f64().clamp(0.0, 1.0), a.f64().clamp(0.0, 1.0));
    let share = strength * strength;
    DVec2::new(alpha * (1.0 - share) + share, alpha).into()
}

/// The variance of the slopes within the pixel is added to that of the facets.
fn specular_aa(a: &mut Arguments<'_>) -> Expected {
    let (alpha, dx, dy, sigma2, limit) = (a.f64(), a.vec3(), a.vec3(), a.f64(), a.f64());
    let kernel = 2.0 * sigma2 * (dx.length_squared() + dy.length_squared());
    (alpha * alpha + kernel.min(limit)).clamp(0.0, 1.0).sqrt().into()
}

/// The bent normal is (b x v) x b, mixed with n and mirrored.
fn bent_reflection(a: &mut Arguments<'_>) -> Expected {
    let (v, n, b) = (a.vec3(), a.vec3(), a.vec3());
    let (strength, roughness) = (a.f64().clamp(0.0, 1.0), a.f64().clamp(0.0, 1.0));
    let bent = b.cross(v).cross(b).try_normalize().unwrap_or(n);
    let m = bent.lerp(n, (1.0 - strength * (1.0 - roughness)).powi(4)).try_normalize().unwrap_or(n);
    (2.0 * m.dot(v) * m - v).into()
}
