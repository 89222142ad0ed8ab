//! Sources: OpenGL Programming Guide, examples 7.8, 7.10 and 7.21; Newcastle University, tutorial
//! 11; OpenGL: Build High Performance Graphics, recipe 5 (a shadow of part strength).

use super::Source::Published;
use super::brdf_diffuse::lambert;
use super::brdf_specular::{blinn_phong, phong_oglpg};
use super::lighting_light::{Light, Sample};
use super::{CallArguments, Expected, ReferenceEntry};
use glam::DVec3;

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "lighting::classic",
    functions: &[
        ("accumulate", Published, accumulate),
        ("resolve", Published, resolve),
        ("shadow_mix", Published, |a| shadow_mix(a.f64(), a.f64()).into()),
        ("shade_ncl", Published, shade_ncl),
        ("shade_oglpg_7_21", Published, shade_oglpg_7_21),
    ],
};

struct ClassicMaterial {
    emission: DVec3,
    ambient: DVec3,
    diffuse: DVec3,
    specular: DVec3,
}

impl ClassicMaterial {
    /// Reads all eight fields, in the order in which they are declared.
    fn read(a: &mut CallArguments<'_>) -> Self {
        let (emission, _shininess, ambient, _roughness) = (a.vec3(), a.f64(), a.vec3(), a.f64());
        let (diffuse, _wrap, specular, _sigma) = (a.vec3(), a.f64(), a.vec3(), a.f64());
        Self { emission, ambient, diffuse, specular }
    }
}

/// scattered += La*Ma*ambient + Lc*Md*diff*att, reflected += Lc*Ms*spec*strength*att.
fn accumulate(a: &mut CallArguments<'_>) -> Expected {
    let (scattered, reflected, material) = (a.vec3(), a.vec3(), ClassicMaterial::read(a));
    let (light, sample) = (Light::read(a), Sample::read(a));
    let (ambient, diffuse, specular, visibility) = (a.f64(), a.f64(), a.f64(), a.f64());
    let lit = light.color * sample.attenuation * sample.spot * visibility;
    let scattered =
        scattered + light.ambient * material.ambient * ambient + lit * material.diffuse * diffuse;
    let reflected = reflected + lit * material.specular * specular * light.strength;
    Expected::words(scattered.to_array().into_iter().chain(reflected.to_array()))
}

/// emission + base*scattered + reflected.
fn resolve(a: &mut CallArguments<'_>) -> Expected {
    let (base, material, scattered, reflected) =
        (a.vec3(), ClassicMaterial::read(a), a.vec3(), a.vec3());
    (material.emission + base * scattered + reflected).into()
}

/// mix(1, visibility, strength).
fn shadow_mix(visibility: f64, strength: f64) -> f64 {
    1.0 + (visibility - 1.0) * strength
}

/// (tex*Lc + Lc*spec*0.33)*att*lambert + tex*Lc*0.1, specular at 50: the tutorial's code.
fn shade_ncl(a: &mut CallArguments<'_>) -> Expected {
    let (base, color, n, l, v, attenuation) =
        (a.vec3(), a.vec3(), a.vec3(), a.vec3(), a.vec3(), a.f64());
    let lit = base * color + color * blinn_phong(n, l, v, 50.0) * 0.33;
    (lit * attenuation * lambert(n, l) + base * color * 0.1).into()
}

/// amb + f*(kd*diff + ks*spec).
fn shade_oglpg_7_21(a: &mut CallArguments<'_>) -> Expected {
    let (ambient, diffuse, specular, power) = (a.vec3(), a.vec3(), a.vec3(), a.f64());
    let (n, l, v, visibility) = (a.vec3(), a.vec3(), a.vec3(), a.f64());
    (ambient + visibility * (diffuse * lambert(n, l) + specular * phong_oglpg(n, l, v, power)))
        .into()
}
