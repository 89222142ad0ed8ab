//! Sources: OpenGL Programming Guide, example 7.13; Karis, "Real Shading in Unreal Engine 4", 2013;
//! Lagarde and Zanuttini, 2012.

use super::Source::Published;
use super::{CallArguments, Expected, ReferenceEntry};
use glam::DVec3;

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "ambient::ibl",
    functions: &[
        ("ibl_mix", Published, ibl_mix),
        ("reflect_world", Published, reflect_world),
        ("split_sum", Published, split_sum),
        ("box_project", Published, box_project),
        ("prefilter_lod_filament", Published, |a| lod_filament(a.f64(), a.f64()).into()),
        ("prefilter_lod", Published, |a| (a.f64().clamp(0.0, 1.0) * (a.f64() - 1.0).max(0.0)).into()),
    ],
};

/// c = mix(B, D*B, dp), then mix(c, S + c, sp).
fn ibl_mix(a: &mut CallArguments<'_>) -> Expected {
    let (base, diffuse, specular, dp, sp) = (a.vec3(), a.vec3(), a.vec3(), a.f64(), a.f64());
    let c = base.lerp(diffuse * base, dp);
    c.lerp(specular + c, sp).into()
}

/// The mirror direction of the view vector, turned from eye to world space.
fn reflect_world(a: &mut CallArguments<'_>) -> Expected {
    let (view, n, v) = (a.mat3(), a.vec3(), a.vec3());
    (view.transpose() * (2.0 * n.dot(v) * n - v)).into()
}

fn split_sum(a: &mut CallArguments<'_>) -> Expected {
    let (f0, dfg, prefiltered) = (a.vec3(), a.vec2(), a.vec3());
    (prefiltered * (f0 * dfg.x + dfg.y)).into()
}

/// The vector from the point `c` of the environment to where the ray from `p` along `r` first meets
/// a plane of the box. Planes behind `p` count as if `p` were on them.
fn box_project(a: &mut CallArguments<'_>) -> Expected {
    let (r, p, lo, hi, c) = (a.vec3(), a.vec3(), a.vec3(), a.vec3(), a.vec3());
    if r == DVec3::ZERO {
        return (p - c).into();
    }
    let axis = |r: f64, p: f64, lo: f64, hi: f64| {
        let plane = if r > 0.0 { hi } else { lo };
        if r == 0.0 { f64::INFINITY } else { ((plane - p) / r).max(0.0) }
    };
    let x = axis(r.x, p.x, lo.x, hi.x);
    let y = axis(r.y, p.y, lo.y, hi.y);
    let z = axis(r.z, p.z, lo.z, hi.z);
    (p + r * x.min(y).min(z) - c).into()
}

/// The mip level is proportional to 1 - (1 - roughness)^2.
fn lod_filament(roughness: f64, mips: f64) -> f64 {
    (1.0 - (1.0 - roughness.clamp(0.0, 1.0)).powi(2)) * (mips - 1.0).max(0.0)
}
