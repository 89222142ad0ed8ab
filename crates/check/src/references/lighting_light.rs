//! Sources: OpenGL Programming Guide, examples 7.3 to 7.8.

use super::Source::Published;
use super::lighting_attenuation::polynomial;
use super::lighting_spot::cone_exponent;
use super::{CallArguments, Expected, ReferenceEntry};
use glam::DVec3;

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "lighting::light",
    functions: &[
        ("sample_directional", Published, |a| directional(&Light::read(a)).words()),
        ("sample_point", Published, |a| point(&Light::read(a), a.vec3()).words()),
        ("sample_spot", Published, |a| spot(&Light::read(a), a.vec3()).words()),
        ("sample_light", Published, sample_light),
    ],
};

/// The fields of a light in the order in which they are declared.
#[derive(Debug, Clone, Copy)]
pub struct Light {
    pub color: DVec3,
    pub kind: f64,
    pub ambient: DVec3,
    pub position: DVec3,
    pub exponent: f64,
    pub axis: DVec3,
    pub cutoff: f64,
    pub attenuation: DVec3,
    pub strength: f64,
}

/// What arrives at a point.
#[derive(Debug, Clone, Copy)]
pub struct Sample {
    pub l: DVec3,
    pub distance: f64,
    pub attenuation: f64,
    pub spot: f64,
}

impl Light {
    /// Reads all fourteen fields.
    pub fn read(a: &mut CallArguments<'_>) -> Self {
        let (color, kind, ambient, _range) = (a.vec3(), a.f64(), a.vec3(), a.f64());
        let (position, exponent, axis, cutoff) = (a.vec3(), a.f64(), a.vec3(), a.f64());
        let (attenuation, _inner, _outer, strength) = (a.vec3(), a.f64(), a.f64(), a.f64());
        let (_shadow_strength, _shadow_layer) = (a.f64(), a.f64());
        Self { color, kind, ambient, position, exponent, axis, cutoff, attenuation, strength }
    }
}

impl Sample {
    /// Reads the four fields.
    pub fn read(a: &mut CallArguments<'_>) -> Self {
        Self { l: a.vec3(), distance: a.f64(), attenuation: a.f64(), spot: a.f64() }
    }

    fn words(self) -> Expected {
        Expected::words(self.l.to_array().into_iter().chain([
            self.distance,
            self.attenuation,
            self.spot,
        ]))
    }
}

fn directional(light: &Light) -> Sample {
    Sample { l: (-light.axis).normalize_or_zero(), distance: 0.0, attenuation: 1.0, spot: 1.0 }
}

fn point(light: &Light, p: DVec3) -> Sample {
    let offset = light.position - p;
    let distance = offset.length();
    Sample {
        l: offset.normalize_or_zero(),
        distance,
        attenuation: polynomial(distance, light.attenuation),
        spot: 1.0,
    }
}

fn spot(light: &Light, p: DVec3) -> Sample {
    let sample = point(light, p);
    Sample {
        spot: cone_exponent(-sample.l.dot(light.axis), light.cutoff, light.exponent),
        ..sample
    }
}

/// By kind: 1 directional, 2 point, 3 spot; a light that is off sends nothing.
fn sample_light(a: &mut CallArguments<'_>) -> Expected {
    let (light, p) = (Light::read(a), a.vec3());
    match light.kind as u32 {
        1 => directional(&light).words(),
        2 => point(&light, p).words(),
        3 => spot(&light, p).words(),
        _ => Expected::words([0.0; 6]),
    }
}
