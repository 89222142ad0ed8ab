//! Sources: Lambert, "Photometria", 1760; Valve's half Lambert; Green, GPU Gems, 2004, chapter 16
//! (wrap); Oren and Nayar, 1994 (qualitative model); Burley, 2012, section 5.3.

use super::{Arguments, Entry, Expected};
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

pub const REFERENCES: Entry = Entry {
    module: "brdf::diffuse",
    functions: &[
        ("lambert", |a| lambert(a.vec3(), a.vec3()).into()),
        ("half_lambert", |a| (0.5 * a.vec3().dot(a.vec3()) + 0.5).powi(2).into()),
        ("wrap", wrap),
        ("oren_nayar", oren_nayar),
        ("burley", burley),
    ],
};

/// max(n.l, 0).
pub fn lambert(n: DVec3, l: DVec3) -> f64 {
    n.dot(l).max(0.0)
}

fn wrap(a: &mut Arguments<'_>) -> Expected {
    let (cosine, w) = (a.vec3().dot(a.vec3()), a.f64().max(0.0));
    ((cosine + w) / (1.0 + w)).max(0.0).into()
}

/// cos(tl)*(A + B*max(cos(phi), 0)*sin(max(tl, tv))*tan(min(tl, tv))), from angles.
fn oren_nayar(a: &mut Arguments<'_>) -> Expected {
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

fn burley(a: &mut Arguments<'_>) -> Expected {
    let (nl, nv, lh, roughness) = (a.f64(), a.f64(), a.f64(), a.f64());
    let f90 = 0.5 + 2.0 * roughness * lh * lh;
    let rise = |cosine: f64| 1.0 + (f90 - 1.0) * (1.0 - cosine.clamp(0.0, 1.0)).powi(5);
    (rise(nl) * rise(nv) * FRAC_1_PI).into()
}
