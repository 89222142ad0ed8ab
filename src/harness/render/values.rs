//! A number for every uniform: what the source published, or else what the scene has.

use std::f64::consts::PI;

use glam::{DMat4, DVec3};

use super::light::LightView;
use super::plan::{Pass, Plan};
use super::{Shot, Surroundings};
use crate::scene::sets::{Lamp, LampKind, Material, Object, Scene};
use crate::scene::{directions, normal_matrix, sh9_project};

/// What the uniforms of one pass are filled from.
pub struct Values<'a> {
    pub plan: &'a Plan,
    pub scene: &'a Scene,
    /// The pass that draws the picture, whichever is being drawn.
    pub last: &'a Pass,
    pub light: &'a LightView,
    pub shot: &'a Shot,
}

/// The camera of a pass.
#[derive(Debug, Clone, Copy)]
pub struct Camera {
    pub clip_from_world: DMat4,
    pub world_from_view: DMat4,
}

/// Blocks of uniforms, with the group of numbers that a preset has for them.
const GROUPS: &[(&str, &str)] = &[
    ("lamps", "light"),
    ("materials", "material"),
    ("surroundings", "surroundings"),
    ("haze", "haze"),
    ("caster", "caster"),
    ("terms", "caster"),
];

/// Coefficients of the polynomial falloff.
const POLYNOMIAL: [f64; 3] = [1.0, 0.04, 0.025];
/// Reach of falloffs that have one, in distances of the target.
const RANGE: f64 = 2.4;
/// Exponent of the cone.
const CONE: f64 = 6.0;
/// Texels of the shadow map that filters without a fixed width reach; width of the light of `pcss`.
const FILTER: f64 = 2.5;
const LIGHT_WIDTH: f64 = 20.0;
const EXPONENTS: [f64; 2] = [20.0, 5.0];

/// A uniform's place: `lamps.lights[2].color` is the field `color` of the third of `lamps`.
struct Path<'p> {
    block: &'p str,
    index: usize,
    field: &'p str,
}

impl<'p> Path<'p> {
    fn new(path: &'p str) -> Self {
        let (block, rest) = path.split_once('.').unwrap_or((path, ""));
        let last = rest.rsplit('.').next().unwrap_or(rest);
        let index = rest.split(['[', ']']).nth(1).and_then(|index| index.parse().ok()).unwrap_or(0);
        Self { block, index, field: last.split('[').next().unwrap_or(last) }
    }
}

impl Values<'_> {
    /// The numbers of a uniform of every block but those of the camera and of an object.
    pub fn number(&self, path: &str) -> Vec<f64> {
        let path = Path::new(path);
        if let Some(published) = self.published(&path) {
            return published;
        }
        match path.block {
            "lamps" if path.field == "count" => vec![self.lamps() as f64],
            "lamps" => self.lamp(path.index, path.field),
            "materials" => self.materials(path.index, path.field),
            "surroundings" => self.surroundings(&path),
            "haze" => self.haze(path.field),
            "caster" | "terms" | "planes" => self.caster(path.field),
            _ => Vec::new(),
        }
    }

    /// The numbers of the camera.
    pub fn camera(&self, camera: &Camera, path: &str) -> Vec<f64> {
        match Path::new(path).field {
            "clip_from_world" => columns(camera.clip_from_world),
            _ => columns(camera.world_from_view),
        }
    }

    /// The numbers of an object's own blocks.
    pub fn object(&self, object: &Object, path: &str) -> Vec<f64> {
        let parsed = Path::new(path);
        match (parsed.block, parsed.field) {
            ("object", "world_from_object") => columns(object.world_from_object),
            ("object", "normal_from_object") => columns(DMat4::from_mat3(normal_matrix(object.world_from_object))),
            ("object", _) => object.color.extend(1.0).to_array().to_vec(),
            ("materials", field) if !self.last.is("material", "array") => {
                self.published(&parsed).unwrap_or_else(|| material(&object.material, field))
            }
            _ => self.number(path),
        }
    }

    fn published(&self, path: &Path<'_>) -> Option<Vec<f64>> {
        let (_, group) = GROUPS.iter().find(|(block, _)| *block == path.block)?;
        // The bias of a lookup is not that of the moments.
        if path.block == "terms" && path.field == "bias" {
            return None;
        }
        self.plan.number(group, path.field)
    }

    fn lamps(&self) -> usize {
        let most = self.last.integer("max_lights").unwrap_or(1);
        self.scene.lamps.len().min(usize::try_from(most).unwrap_or(1))
    }

    fn kind(&self, index: usize, lamp: &Lamp) -> LampKind {
        const KINDS: [(&str, LampKind); 3] = [("directional", LampKind::Directional), ("point", LampKind::Point), ("spot", LampKind::Spot)];
        // The first lamp casts the shadow.
        let axis = if index == 0 && !self.last.is("shadow", "none") && self.last.is("lights", "mixed") { "shadow_light" } else { "lights" };
        KINDS.iter().find(|(name, _)| self.last.is(axis, name)).map_or(lamp.kind, |(_, kind)| *kind)
    }

    fn lamp(&self, index: usize, field: &str) -> Vec<f64> {
        let Some(lamp) = self.scene.lamps.get(index) else { return Vec::new() };
        let kind = self.kind(index, lamp);
        match field {
            "kind" => vec![match kind {
                LampKind::Directional => 1.0,
                LampKind::Point => 2.0,
                LampKind::Spot => 3.0,
            }],
            "color" => vector(self.intensity(index, lamp, kind)),
            "ambient" => vector(lamp.color * 0.06),
            "range" => vec![RANGE * lamp.reach()],
            "position" => vector(lamp.position),
            "exponent" => vec![CONE],
            "axis" => vector(self.axis(index, lamp, kind)),
            "cutoff" | "outer" => vec![lamp.half_angle.cos()],
            "inner" => vec![(0.75 * lamp.half_angle).cos()],
            "attenuation" => POLYNOMIAL.to_vec(),
            "strength" | "shadow_strength" => vec![1.0],
            "shadow_layer" => vec![if index == 0 { 0.0 } else { -1.0 }],
            _ => Vec::new(),
        }
    }

    /// Several directional lights shine from where the lamps are, not all straight down.
    fn axis(&self, index: usize, lamp: &Lamp, kind: LampKind) -> DVec3 {
        let key = self.scene.lamps.first().map_or(DVec3::ZERO, |key| key.target);
        if kind == LampKind::Directional && index > 0 { (key - lamp.position).normalize_or(DVec3::NEG_Y) } else { lamp.axis() }
    }

    /// The colour that arrives at the target as the lamp has it, whatever the falloff.
    fn intensity(&self, index: usize, lamp: &Lamp, kind: LampKind) -> DVec3 {
        if kind == LampKind::Directional {
            // They reach everywhere, so that those beside the first add up.
            return lamp.color * if index == 0 { 1.0 } else { 0.25 };
        }
        let d = lamp.reach();
        let polynomial = self.plan.number("light", "attenuation").unwrap_or(POLYNOMIAL.to_vec());
        let range = self.plan.number("light", "range").and_then(|range| range.first().copied()).unwrap_or(RANGE * d);
        let falloff = if self.last.is("attenuation", "polynomial") {
            1.0 / polynomial.iter().rev().fold(0.0, |sum, coefficient| sum * d + coefficient)
        } else if self.last.is("attenuation", "linear_radius") {
            1.0 - d / range
        } else if self.last.is("attenuation", "inverse_square_window") {
            (1.0 - (d / range).powi(4)).powi(2) / (d * d)
        } else {
            1.0
        };
        lamp.color / if falloff > 1e-6 { falloff } else { 1.0 }
    }

    fn materials(&self, index: usize, field: &str) -> Vec<f64> {
        let (pair, side) = if self.last.is("two_sided", "true") { (index / 2, index % 2) } else { (index, 0) };
        self.scene.materials.get(pair).map_or(Vec::new(), |sides| material(&sides[side], field))
    }

    fn surroundings(&self, path: &Path<'_>) -> Vec<f64> {
        let lit = !self.last.is("lights", "none");
        let dimmed = if lit { 0.35 } else { 1.0 };
        match path.field {
            "color" => vector(if lit { self.scene.ambient } else { DVec3::new(0.44, 0.45, 0.48) }),
            // Published coefficients are taken as the book takes them.
            "scale" => vec![dimmed * if self.plan.probe.is_some() { 1.0 } else { 1.0 / PI }],
            "sky" => vector(self.scene.sky * dimmed),
            "ground" => vector(self.scene.ground * dimmed),
            "up" => vector(DVec3::Y),
            "diffuse_share" => vec![if lit { 0.35 } else { 1.0 }],
            "specular_share" => vec![if lit { 0.25 } else { 0.4 }],
            "sh" => self.probe().get(path.index).map_or(Vec::new(), |row| row.to_vec()),
            _ => Vec::new(),
        }
    }

    /// Nine coefficients: published, or of what is around the scene.
    pub fn probe(&self) -> [[f64; 3]; 9] {
        self.plan.probe.unwrap_or_else(|| projected(&self.shot.surroundings))
    }

    fn haze(&self, field: &str) -> Vec<f64> {
        let (start, end) = self.scene.haze_range;
        match field {
            "color" => vector(self.scene.haze),
            // Half of the colour is left in the middle.
            "density" => vec![2.0_f64.ln().sqrt() / (0.5 * (start + end))],
            "start" => vec![start],
            "end" => vec![end],
            _ => Vec::new(),
        }
    }

    fn caster(&self, field: &str) -> Vec<f64> {
        match field {
            "clip_from_world" => self.light.clip_from_world.first().map_or(Vec::new(), |matrix| columns(*matrix)),
            "near" => vec![self.light.near],
            "far" => vec![self.light.far],
            "texel" => vec![self.light.texel],
            "radius" => vec![if self.last.is("shadow", "pcss") { LIGHT_WIDTH } else { FILTER }],
            // Numbers of the depth pass are the source's way against acne: then nothing is added.
            "normal_offset" if !self.plan.numbers.contains_key("depth_pass") => vec![1.0 + 0.5 * self.filter_reach()],
            "bias" if self.last.is("shadow", "vsm") || self.last.is("shadow", "evsm") => vec![0.001],
            "exponents" => EXPONENTS.to_vec(),
            "min_variance" => vec![if self.last.is("shadow", "evsm") { 1e-4 } else { 2e-5 }],
            "bleed" => vec![0.15],
            // The light, the least w, the rest.
            _ => vec![0.0],
        }
    }

    /// Texels to each side that the last pass's filter reads.
    fn filter_reach(&self) -> f64 {
        const REACHES: &[(&str, f64)] =
            &[("pcf_3x3", 3.0), ("pcf_5x5", 5.0), ("pcf_castano_5", 3.0), ("pcf_random16", 3.5), ("pcf_vogel", 3.5), ("pcss", 8.0)];
        REACHES.iter().find(|(name, _)| self.last.is("shadow", name)).map_or(1.0, |(_, reach)| *reach)
    }

    /// Polygon offset of the depth pass: the source's, or as much as the filter needs.
    pub fn offset(&self) -> [f32; 2] {
        if !self.plan.numbers.contains_key("depth_pass") {
            return [1.0 + self.filter_reach() as f32, 4.0];
        }
        let published = self.plan.number("depth_pass", "polygon_offset").unwrap_or_default();
        [0, 1].map(|index| published.get(index).map_or(0.0, |value| *value as f32))
    }

    /// Whether the depth pass has back faces only.
    pub fn culls_front(&self) -> bool {
        self.plan.number("depth_pass", "cull_front").is_some_and(|value| value.first().is_some_and(|value| *value != 0.0))
    }

    /// What depth 1 is in the moments that the last pass reads.
    pub fn cleared_moments(&self) -> [f32; 4] {
        if !self.last.is("shadow", "evsm") {
            return [1.0, 1.0, 0.0, 0.0];
        }
        let exponents = self.plan.number("caster", "exponents").unwrap_or(EXPONENTS.to_vec());
        let exponent = |index: usize| exponents.get(index).copied().unwrap_or(0.0);
        let (positive, negative) = (exponent(0).exp(), -(-exponent(1)).exp());
        [positive, positive * positive, negative, negative * negative].map(|moment| moment as f32)
    }
}

fn projected(surroundings: &Surroundings) -> [[f64; 3]; 9] {
    let samples = directions(24).into_iter().map(|(direction, angle)| (direction, angle, surroundings.radiance(direction)));
    sh9_project(samples).map(|coefficient| coefficient.to_array())
}

fn material(material: &Material, field: &str) -> Vec<f64> {
    match field {
        "emission" => vector(material.emission),
        "shininess" => vec![material.shininess],
        "ambient" => vector(material.ambient),
        "roughness" => vec![material.roughness],
        "diffuse" => vector(material.diffuse),
        "wrap" => vec![material.wrap],
        "specular" => vector(material.specular),
        "sigma" => vec![material.sigma],
        _ => Vec::new(),
    }
}

fn vector(vector: DVec3) -> Vec<f64> {
    vector.to_array().to_vec()
}

fn columns(matrix: DMat4) -> Vec<f64> {
    matrix.to_cols_array().to_vec()
}
