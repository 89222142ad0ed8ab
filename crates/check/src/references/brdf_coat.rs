//! Sources: Khronos Group, KHR_materials_clearcoat, 2020; Fresnel's equation at normal incidence;
//! Academy Software Foundation, OpenPBR Surface 1.1, 2024.

use super::Source::{Published, Specification};
use super::brdf_fresnel::average;
use super::{CallArguments, Expected, ReferenceEntry};
use glam::DVec3;

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "brdf::coat",
    functions: &[("coat_mix", Specification, coat_mix), ("coat_f0", Published, coat_f0), ("coat_darkening", Specification, coat_darkening)],
};

fn coat_mix(a: &mut CallArguments<'_>) -> Expected {
    let (base, coat, share) = (a.vec3(), a.vec3(), (a.f64() * a.f64()).clamp(0.0, 1.0));
    base.lerp(coat, share).into()
}

/// The reflectance of the base, of index k, under the coat, of index n: ((k - n)/(k + n))^2. k
/// follows from the reflectance in air. For a reflectance of 1 the result is the limit, 1.
fn coat_f0(a: &mut CallArguments<'_>) -> Expected {
    let (f0, ior) = (a.vec3(), a.f64().max(0.0));
    let one = |f0: f64| {
        let s = f0.clamp(0.0, 1.0).sqrt();
        let base = (1.0 + s) / (1.0 - s);
        if base.is_finite() { ((base - ior) / (base + ior)).powi(2) } else { 1.0 }
    };
    Expected::words(f0.to_array().map(one))
}

/// (1 - K)/(1 - Eb*K), the sum of all bounces below the coat, with the albedo Eb of the base and
/// the internal reflectance K of the coat.
fn coat_darkening(a: &mut CallArguments<'_>) -> Expected {
    let (base, eta) = (a.vec3().clamp(DVec3::ZERO, DVec3::ONE), a.f64().clamp(1.0, 100.0));
    let (rough, seen) = (a.f64().clamp(0.0, 1.0), a.f64().clamp(0.0, 1.0));
    let diffuse = 1.0 - (1.0 - average(eta)) / (eta * eta);
    let k = (seen + (diffuse - seen) * rough).min(1.0 - f64::from(1e-4f32));
    base.map(|base| (1.0 - k) / (1.0 - base * k)).into()
}
