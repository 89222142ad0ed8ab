//! Finds a number for every uniform: what the source published, or else what the scene has.

use std::cell::OnceCell;
use std::f64::consts::PI;

use glam::{DMat3, DMat4, DVec3};

use super::light::LightView;
use super::needs::Cleared;
use super::plan::{Pass, Plan};
use super::textures::LEVELS;
use super::{Shot, Surroundings};
use lamplight_scene::{Clip, Clusters, Depth, directions, normal_matrix, perspective, sh9_project};
use lamplight_scenes::ProbeField;
use lamplight_scenes::sets::{Eye, Lamp, LampKind, Material, Object, Scene};

/// What the uniforms of one pass are filled from.
pub struct UniformValues<'a> {
    pub plan: &'a Plan,
    pub scene: &'a Scene,
    /// The pass that lights the scene, whichever pass these values are for.
    pub lit: &'a Pass,
    pub light: &'a LightView,
    pub shot: &'a Shot,
    /// The lists of lamps for the cells of the view, computed on first use.
    pub clusters: OnceCell<Option<Clusters>>,
    /// The light probes, computed on first use.
    pub probes: OnceCell<ProbeField>,
}

#[derive(Debug, Clone, Copy)]
pub struct PassCamera {
    pub clip_from_world: DMat4,
    pub world_from_view: DMat4,
}

/// The blocks of uniforms, with the group of a preset's numbers that fills each.
const GROUPS: &[(&str, &str)] = &[
    ("object", "object"),
    ("lamps", "light"),
    ("areas", "area"),
    ("profiles", "profile"),
    ("materials", "material"),
    ("layers", "layers"),
    ("surroundings", "surroundings"),
    ("haze", "haze"),
    ("caster", "caster"),
    ("terms", "moments"),
    ("display", "display"),
    ("lobe", "lobe"),
    ("march", "march"),
    ("horizon", "horizon"),
];

/// How much of its surroundings a scene with lamps is lit by: enough to see into shadows, and little
/// enough that they stay shadows. Without lamps, the surroundings are all the light there is.
const SURROUNDINGS_BESIDE_LAMPS: f64 = 0.35;

/// The constant ambient light where there is no lamp, a grey that is slightly blue. It lights the scene
/// alone, which the scene's own ambient light does not: that is chosen to fill the shadows of lamps.
const AMBIENT_ALONE: DVec3 = DVec3::new(0.44, 0.45, 0.48);

/// The share of the mirrored surroundings in a surface whose layers have no reflectance of their own:
/// beside lamps, and without them.
const MIRRORED: [f64; 2] = [0.25, 0.4];

/// Against acne, a point is moved by this many texels along its normal, and depths by this many of the
/// smallest steps of their format. A filter that reads farther texels needs more of the first, and a
/// steeper factor of the slope.
const TEXELS_ASIDE: f64 = 1.0;
const DEPTH_STEPS: f32 = 4.0;

/// The path of a uniform: `lamps.lights[2].color` is the field `color` of the third light in the
/// block `lamps`.
struct UniformPath<'p> {
    block: &'p str,
    index: usize,
    field: &'p str,
}

impl<'p> UniformPath<'p> {
    fn new(path: &'p str) -> Self {
        let (block, rest) = path.split_once('.').unwrap_or((path, ""));
        let last = rest.rsplit('.').next().unwrap_or(rest);
        let index = rest.split(['[', ']']).nth(1).and_then(|index| index.parse().ok()).unwrap_or(0);
        Self { block, index, field: last.split('[').next().unwrap_or(last) }
    }
}

/// The blocks whose numbers must agree with textures, matrices or lists that are made of the scene.
const FOLLOWING: [&str; 3] = ["cascades", "clusters", "probes"];

/// Whether a uniform follows from the scene, so that nobody can change it.
pub(super) fn follows(path: &str) -> bool {
    FOLLOWING.contains(&UniformPath::new(path).block)
}

impl PassCamera {
    /// The camera of the viewer.
    pub fn of_viewer(eye: &Eye, shot: &Shot) -> Self {
        let view = eye.view();
        Self { clip_from_world: eye_projection(eye, shot) * view, world_from_view: view.inverse() }
    }

    /// The numbers of a field of the block `camera`.
    pub fn number(&self, path: &str) -> Option<Vec<f64>> {
        match UniformPath::new(path).field {
            "clip_from_world" => Some(matrix_columns(self.clip_from_world)),
            "world_from_view" => Some(matrix_columns(self.world_from_view)),
            _ => None,
        }
    }
}

impl UniformValues<'_> {
    /// The numbers of a uniform in any block but those of the camera and of an object: what the
    /// source published, what the scene has, or what the axes choose. `None` if nothing knows it.
    pub fn number(&self, path: &str) -> Option<Vec<f64>> {
        if let Some(changed) = self.changed(path) {
            return Some(changed);
        }
        let path = UniformPath::new(path);
        let of_scene = || match path.block {
            "lamps" if path.field == "count" => self.lamps().map(|count| vec![count as f64]),
            "lamps" => self.lamp(path.index, path.field),
            "areas" => self.area(path.index, path.field),
            "cascades" => {
                let parts = &self.light.clip_from_world;
                self.light.parts.as_ref()?.number(parts, path.index, path.field)
            }
            "probes" => self.probe_number(path.field),
            "clusters" => self.cluster(path.index, path.field),
            "room" => self.room(path.field),
            "profiles" => self.profile(path.index, path.field),
            "materials" => self.materials(path.index, path.field),
            "surroundings" => self.surroundings(&path),
            "haze" => self.haze(path.field),
            "layers" if path.field == "sky_levels" => Some(vec![self.sky_levels() as f64]),
            "caster" | "planes" => self.caster(path.field),
            "lobe" if path.field == "world_from_clip" => Some(matrix_columns(self.sky_from_clip())),
            "eye" | "screen" => self.screen(path.field),
            "march" if path.field == "lamp" => Some(self.marched_light()),
            _ => None,
        };
        self.published(&path)
            .or_else(of_scene)
            .or_else(|| self.lit.needs.uniform(path.block, path.field))
    }

    /// The numbers of an object's own blocks.
    pub fn object(&self, object: &Object, path: &str) -> Option<Vec<f64>> {
        if let Some(changed) = self.changed(path) {
            return Some(changed);
        }
        let parsed = UniformPath::new(path);
        match (parsed.block, parsed.field) {
            ("object", "world_from_object") => Some(matrix_columns(object.world_from_object)),
            ("object", "normal_from_object") => {
                Some(matrix_columns(DMat4::from_mat3(normal_matrix(object.world_from_object))))
            }
            ("object", "color") => {
                let color = self.published(&parsed);
                let mut color = color.unwrap_or_else(|| vector_values(object.color));
                color.push(object.alpha);
                Some(color)
            }
            ("materials", field) if !self.lit.needs.material_array => {
                self.published(&parsed).or_else(|| material_value(&object.material, field))
            }
            ("layers", field) => self
                .published(&parsed)
                .or_else(|| object.material.layers?.number(field))
                .or_else(|| self.number(path)),
            _ => self.number(path),
        }
    }

    /// What somebody changed a uniform to. The exponents of moments must be the same in all passes.
    /// Those of the lookup (`caster`) come first, then those that the moments are made with
    /// (`terms`).
    fn changed(&self, path: &str) -> Option<Vec<f64>> {
        if follows(path) {
            return None;
        }
        let uniforms = &self.plan.changes.uniforms;
        let found = match path {
            "caster.exponents" | "terms.exponents" => {
                uniforms.get("caster.exponents").or_else(|| uniforms.get("terms.exponents"))
            }
            _ => uniforms.get(path),
        };
        found.cloned()
    }

    /// How many levels the specular map of the surroundings has: one for each roughness, or one.
    pub fn sky_levels(&self) -> usize {
        if self.lit.needs.levels { LEVELS } else { 1 }
    }

    fn published(&self, path: &UniformPath<'_>) -> Option<Vec<f64>> {
        let (_, group) = GROUPS.iter().find(|(block, _)| *block == path.block)?;
        let is_placed = matches!(path.field, "position" | "axis");
        if path.block == "lamps" && is_placed && self.plan.changes.lamps.contains_key(&path.index) {
            return None;
        }
        // The exponents must be the same where moments are made and where they are read.
        let group = if path.field == "exponents" { "caster" } else { group };
        self.plan.number(group, path.field)
    }

    fn materials(&self, index: usize, field: &str) -> Option<Vec<f64>> {
        let (pair, side) = if self.lit.needs.sides { (index / 2, index % 2) } else { (index, 0) };
        // An array that is longer than the scene has materials ends with zeros.
        let Some(sides) = self.scene.materials.get(pair) else { return Some(Vec::new()) };
        material_value(&sides[side], field)
    }

    fn surroundings(&self, path: &UniformPath<'_>) -> Option<Vec<f64>> {
        let lit = !self.lit.needs.unlit;
        let dimmed = if lit { SURROUNDINGS_BESIDE_LAMPS } else { 1.0 };
        Some(match path.field {
            "color" => vector_values(if lit { self.scene.ambient } else { AMBIENT_ALONE }),
            // Published coefficients are used as the book uses them.
            "scale" => vec![dimmed * if self.plan.probe.is_some() { 1.0 } else { 1.0 / PI }],
            "sky" => vector_values(self.scene.sky * dimmed),
            "ground" => vector_values(self.scene.ground * dimmed),
            "up" => vector_values(DVec3::Y),
            "diffuse_share" => vec![dimmed],
            // Layers have a reflectance of their own for the surroundings.
            "specular_share" if self.lit.needs.levels => vec![1.0],
            "specular_share" => vec![if lit { MIRRORED[0] } else { MIRRORED[1] }],
            "sh" => self.probe().get(path.index)?.to_vec(),
            _ => return None,
        })
    }

    /// The nine spherical harmonics coefficients of the ambient light: the published ones, or those
    /// of the surroundings.
    pub fn probe(&self) -> [[f64; 3]; 9] {
        self.plan.probe.unwrap_or_else(|| projected_light(&self.shot.surroundings))
    }

    /// The numbers of the block `room`: the box that the environment is projected onto.
    fn room(&self, field: &str) -> Option<Vec<f64>> {
        let [low, high, centre] = self.scene.room?;
        Some(vector_values(match field {
            "low" => low,
            "high" => high,
            "centre" => centre,
            _ => return None,
        }))
    }

    fn haze(&self, field: &str) -> Option<Vec<f64>> {
        let (start, end) = self.scene.haze_range;
        Some(match field {
            "color" => vector_values(self.scene.haze),
            // So that half of the colour is left in the middle of the haze.
            "density" => vec![2.0_f64.ln().sqrt() / (0.5 * (start + end))],
            "start" => vec![start],
            "end" => vec![end],
            "to_sun" => vector_values(-self.scene.lamps.first()?.axis()),
            _ => return None,
        })
    }

    /// The matrices between the viewer's clip space, view space and the world, and the planes of
    /// the view.
    fn screen(&self, field: &str) -> Option<Vec<f64>> {
        let eye = &self.scene.eye;
        let projection = eye_projection(eye, self.shot);
        Some(match field {
            "world_from_clip" => matrix_columns((projection * eye.view()).inverse()),
            "clip_from_view" => matrix_columns(projection),
            "view_from_clip" => matrix_columns(projection.inverse()),
            "view_from_world" => matrix_columns(eye.view()),
            "near" => vec![eye.near],
            "far" => vec![eye.far],
            _ => return None,
        })
    }

    /// From the screen to directions that the viewer sees.
    fn sky_from_clip(&self) -> DMat4 {
        let eye = &self.scene.eye;
        let turned = DMat4::from_mat3(DMat3::from_mat4(eye.view()));
        (eye_projection(eye, self.shot) * turned).inverse()
    }

    /// The first lamp in view space, in homogeneous coordinates: its position and 1, or the
    /// direction towards a directional light and 0.
    fn marched_light(&self) -> Vec<f64> {
        let Some(lamp) = self.scene.lamps.first() else { return vec![0.0; 4] };
        let view = self.scene.eye.view();
        let place = match self.lit.needs.caster.unwrap_or(lamp.kind) {
            LampKind::Directional => view.transform_vector3(-lamp.axis()).normalize().extend(0.0),
            _ => view.transform_point3(lamp.position).extend(1.0),
        };
        place.to_array().to_vec()
    }

    fn caster(&self, field: &str) -> Option<Vec<f64>> {
        // If the source avoids acne in its own way, no offset is added.
        let offset = if self.is_biased_by_source() {
            0.0
        } else {
            TEXELS_ASIDE + 0.5 * self.lit.needs.reach
        };
        Some(match field {
            // A point light has a matrix for each face, and its stage reads none.
            "clip_from_world" => matrix_columns(*self.light.clip_from_world.first()?),
            "near" => vec![self.light.near],
            "far" => vec![self.light.far],
            "texel" => vec![self.light.texel],
            "light_size" => vec![self.light_size()],
            "normal_offset" => vec![offset],
            _ => return None,
        })
    }

    /// The width of the light that casts the shadow: the height of the scene's lamps that have an
    /// area. For light of one direction, that is divided by the distance of the lamp.
    fn light_size(&self) -> f64 {
        let (lamp, width) = (self.scene.lamps.first(), 2.0 * self.scene.lamp_size().y);
        let distance = match self.lit.needs.caster {
            Some(LampKind::Directional) => lamp.map_or(1.0, Lamp::reach).max(1e-6),
            _ => 1.0,
        };
        width / distance
    }

    /// The polygon offset of the depth pass: the source's, or as much as the filter needs.
    pub fn offset(&self) -> [f32; 2] {
        if !self.is_biased_by_source() {
            return [1.0 + self.lit.needs.reach as f32, DEPTH_STEPS];
        }
        let published = self.plan.number("depth_pass", "polygon_offset").unwrap_or_default();
        [0, 1].map(|index| published.get(index).map_or(0.0, |value| *value as f32))
    }

    /// Whether the source says how its depth pass avoids acne.
    fn is_biased_by_source(&self) -> bool {
        let has = |field| self.plan.number("depth_pass", field).is_some();
        has("polygon_offset") || has("cull_front")
    }

    /// Whether the depth pass draws only back faces.
    pub fn culls_front(&self) -> bool {
        self.plan
            .number("depth_pass", "cull_front")
            .is_some_and(|value| value.first().is_some_and(|value| *value != 0.0))
    }

    /// The moments of depth 1, which the last pass reads where nothing was drawn.
    pub fn cleared_moments(&self) -> [f32; 4] {
        let exponents = self
            .changed("caster.exponents")
            .or_else(|| self.plan.number("caster", "exponents"))
            .or_else(|| self.lit.needs.uniform("terms", "exponents"))
            .unwrap_or_default();
        let exponent = |index: usize| exponents.get(index).copied().unwrap_or(0.0);
        let (positive, negative) = (exponent(0).exp(), -(-exponent(1)).exp());
        let moments = match self.lit.needs.cleared {
            Cleared::Vsm => [1.0, 1.0, 0.0, 0.0],
            Cleared::Evsm => [positive, positive * positive, negative, negative * negative],
            Cleared::Esm => [positive, 0.0, 0.0, 0.0],
            Cleared::Msm => [1.0; 4],
        };
        moments.map(|moment| moment as f32)
    }
}

/// The projection of the viewer.
pub(super) fn eye_projection(eye: &Eye, shot: &Shot) -> DMat4 {
    eye_projection_for(eye, shot.size, Clip::Wgpu)
}

/// The same for a picture of a size and a clip space.
pub(super) fn eye_projection_for(eye: &Eye, [width, height]: [u32; 2], clip: Clip) -> DMat4 {
    let aspect = f64::from(width) / f64::from(height.max(1));
    // A picture that is higher than wide still shows everything that a square one shows.
    let fov =
        if aspect < 1.0 { 2.0 * ((0.5 * eye.fov_y).tan() / aspect).atan() } else { eye.fov_y };
    perspective(fov, aspect, eye.near, eye.far, clip, Depth::Normal)
}

fn projected_light(surroundings: &Surroundings) -> [[f64; 3]; 9] {
    let samples = directions(24)
        .into_iter()
        .map(|(direction, angle)| (direction, angle, surroundings.radiance(direction)));
    sh9_project(samples).map(|coefficient| coefficient.to_array())
}

fn material_value(material: &Material, field: &str) -> Option<Vec<f64>> {
    Some(match field {
        "emission" => vector_values(material.emission),
        "shininess" => vec![material.shininess],
        "ambient" => vector_values(material.ambient),
        "roughness" => vec![material.roughness],
        "diffuse" => vector_values(material.diffuse),
        "wrap" => vec![material.wrap],
        "specular" => vector_values(material.specular),
        "sigma" => vec![material.sigma],
        _ => return None,
    })
}

/// The vector of three numbers, or of the first three of four.
pub(super) fn vector_of(numbers: &[f64]) -> Option<DVec3> {
    Some(DVec3::from_array(*numbers.first_chunk()?))
}

pub(super) fn vector_values(vector: DVec3) -> Vec<f64> {
    vector.to_array().to_vec()
}

pub(super) fn matrix_columns(matrix: DMat4) -> Vec<f64> {
    matrix.to_cols_array().to_vec()
}
