//! The scenes of the pictures: shapes, lamps, materials and a viewer, all made by formulas; the light
//! probes that a scene asks for; and the numbers of its materials in the array of the programs.

use crate::layers::Layers;
pub use crate::maps::{Maps, TextureMap};
use crate::maps::{luminaire, window};
use crate::shape::Shape;
use crate::{maps, palette};
use glam::{DMat4, DVec2, DVec3};
use lamplight_scene::{Clip, Depth, look_at, perspective};
use std::sync::Arc;

/// Everything that is drawn, and the viewer.
#[derive(Debug, Clone)]
pub struct Scene {
    pub objects: Vec<Object>,
    /// Where it is seen from.
    pub eye: Eye,
    /// Lamps, the most important one first. The first one casts the shadow.
    pub lamps: Vec<Lamp>,
    /// What a model says of each of its lamps. Empty if nothing does: pictures then choose it.
    pub lamp_numbers: Vec<LampNumbers>,
    /// The materials for `material=array`: fourteen fronts with their backs.
    pub materials: Vec<[Material; 2]>,
    /// Ambient light of one colour.
    pub ambient: DVec3,
    /// Ambient light from above.
    pub sky: DVec3,
    /// Ambient light from below.
    pub ground: DVec3,
    /// The colour into which distance fades.
    pub haze: DVec3,
    /// Distances at which the haze begins and is full.
    pub haze_range: (f64, f64),
    /// Makes the textures. They are made only when they are asked for.
    pub maps: fn() -> Maps,
    /// Textures of a model that was read, which replace those of `maps`.
    pub own_maps: Option<Arc<Maps>>,
    /// Texels along an edge of the shadow map, if that does not depend on the picture's size.
    pub map_size: Option<u32>,
    /// Whether lamps with a position are drawn as objects.
    pub shows_lamps: bool,
    /// Its light probes, if they are not the usual ones.
    pub probes: Option<Probes>,
    /// Half of the width and height of lamps with an area, if they are not of the usual size.
    pub lamp_size: Option<DVec2>,
    /// The name of the environment, if that is not the usual one.
    pub around: Option<&'static str>,
    /// The box whose walls the environment shows: two opposite corners, and the point from which
    /// the environment is seen.
    pub room: Option<[DVec3; 3]>,
}

/// A shape with its place in the scene.
#[derive(Debug, Clone)]
pub struct Object {
    /// Corners and triangles.
    pub shape: Shape,
    /// Places the shape in the world.
    pub world_from_object: DMat4,
    /// Multiplied with the colours of the corners.
    pub color: DVec3,
    /// Multiplied with the alpha of its texture: less than one half is not drawn with `alpha_test`.
    pub alpha: f64,
    /// Whether it is blended by that alpha over what is behind it.
    pub is_blended: bool,
    /// The material for `material=single`.
    pub material: Material,
    /// The index for `material=array`.
    pub material_index: u32,
    /// Whether the backs of its triangles are not drawn. They still cast shadows.
    pub single_sided: bool,
    /// Whether it casts a shadow. A drawn lamp must not, since it would shade everything.
    pub casts: bool,
}

#[derive(Debug, Clone, Copy)]
pub struct Eye {
    /// In world space.
    pub position: DVec3,
    /// A point that is looked at, in world space.
    pub target: DVec3,
    /// The whole vertical angle, radians.
    pub fov_y: f64,
    /// Distance of the near plane.
    pub near: f64,
    /// Distance of the far plane.
    pub far: f64,
}

/// A light that can be of any kind: a directional light shines along its axis, a point light to all
/// sides, a spot light into its cone.
#[derive(Debug, Clone, Copy)]
pub struct Lamp {
    /// The light that arrives at the target, whatever the falloff is.
    pub color: DVec3,
    /// In world space.
    pub position: DVec3,
    /// A point that it shines at, in world space.
    pub target: DVec3,
    /// Half the angle of the cone, radians.
    pub half_angle: f64,
    /// The kind for `lights=mixed`.
    pub kind: LampKind,
}

/// The numbers of a lamp of a model, as KHR_lights_punctual has them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LampNumbers {
    /// Half of the angle of the cone within which it is fully lit, radians.
    pub inner: f64,
    /// Half of the angle of the cone beyond which it is dark, radians.
    pub outer: f64,
    /// How far it shines, in units of the scene; 0 is without an end.
    pub range: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LampKind {
    /// Shines in one direction everywhere.
    Directional,
    /// Shines to all sides.
    Point,
    /// Shines into a cone.
    Spot,
}

/// The shape of an area light.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LampShape {
    /// A rectangle that shines along the axis of the lamp.
    Rectangle,
    /// A sphere as high as the rectangle.
    Sphere,
    /// A tube as wide as the rectangle.
    Tube,
}

impl LampShape {
    /// The radius of a sphere or tube, from half of the width and height of area lights; 0 for a
    /// rectangle.
    pub fn radius(self, size: DVec2) -> f64 {
        match self {
            Self::Rectangle => 0.0,
            Self::Sphere => size.y,
            Self::Tube => 0.12 * size.y,
        }
    }
}

/// The texture that varies the light of a lamp with the direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LampProfile {
    /// Intensities by angle, as an IES file has them for a luminaire.
    Ies,
    /// A picture that the lamp projects.
    Cookie,
}

impl LampProfile {
    pub fn map(self) -> TextureMap {
        match self {
            Self::Ies => luminaire(),
            Self::Cookie => window(),
        }
    }
}

/// What a surface does with light.
#[derive(Debug, Clone, Copy)]
pub struct Material {
    /// Linear colour that it gives off by itself.
    pub emission: DVec3,
    /// Exponent of the classic highlights.
    pub shininess: f64,
    /// Share of the ambient light that it reflects.
    pub ambient: DVec3,
    /// Roughness of the microfacet highlight, [0, 1].
    pub roughness: f64,
    /// Share of the light that it reflects to all sides.
    pub diffuse: DVec3,
    /// How far light wraps around the terminator, [0, 1].
    pub wrap: f64,
    /// Share of the light in its highlight.
    pub specular: DVec3,
    /// Roughness of Oren and Nayar, radians.
    pub sigma: f64,
    /// Its factors as a glTF surface. Without them, pictures choose them.
    pub layers: Option<Layers>,
}

impl Default for Material {
    /// White and a little glossy.
    fn default() -> Self {
        Self {
            emission: DVec3::ZERO,
            shininess: 40.0,
            ambient: DVec3::ONE,
            roughness: 0.45,
            diffuse: DVec3::ONE,
            wrap: 0.4,
            specular: DVec3::splat(0.25),
            sigma: 0.6,
            layers: None,
        }
    }
}

impl Material {
    /// The material with a highlight of another sharpness, and the roughness that fits.
    pub(super) fn shiny(self, shininess: f64) -> Self {
        Self { shininess, roughness: (2.0 / (shininess + 2.0)).powf(0.25), ..self }
    }

    pub(super) fn glossy(self, share: f64) -> Self {
        Self { specular: DVec3::splat(share), ..self }
    }
}

impl Object {
    pub(super) fn new(shape: Shape, place: DMat4, color: DVec3) -> Self {
        Self {
            shape,
            world_from_object: place,
            color,
            material: Material::default(),
            material_index: 0,
            alpha: 1.0,
            is_blended: false,
            single_sided: false,
            casts: true,
        }
    }

    /// An object with a material of its own. Its index in the array is 0.
    pub fn made(shape: Shape, place: DMat4, color: DVec3, material: Material) -> Self {
        Self::new(shape, place, color).of(material, 0)
    }

    /// The object as two: the triangles that turn their backs to a viewer, and those that turn their fronts.
    pub fn sides_from(&self, eye: DVec3) -> [Self; 2] {
        let fronts = Self { single_sided: true, ..self.clone() };
        let front = fronts.seen_from(eye);
        let all = fronts.shape.indices.chunks_exact(3);
        let mut rest = front.chunks_exact(3).peekable();
        // The fronts are in the order of all.
        let backs = all.filter(|own| rest.next_if(|next| next == own).is_none());
        let back: Vec<u32> = match self.single_sided {
            true => Vec::new(),
            false => backs.flatten().copied().collect(),
        };
        [back, front].map(|indices| {
            let shape = Shape { indices, ..self.shape.clone() };
            Self { shape, single_sided: false, ..self.clone() }
        })
    }

    /// The indices of the triangles that are drawn for a viewer at a point: all of them, or those
    /// that turn their fronts to it.
    pub fn seen_from(&self, eye: DVec3) -> Vec<u32> {
        let Shape { vertices, indices } = &self.shape;
        if !self.single_sided {
            return indices.clone();
        }
        let place = |index: u32| {
            let vertex = vertices.get(index as usize);
            vertex.map(|vertex| self.world_from_object.transform_point3(vertex.position))
        };
        let is_front = |corners: &&[u32]| {
            let [Some(a), Some(b), Some(c)] = [0, 1, 2].map(|at| place(corners[at])) else {
                return true;
            };
            (b - a).cross(c - a).dot(eye - a) > 0.0
        };
        indices.chunks_exact(3).filter(is_front).flatten().copied().collect()
    }

    pub(super) fn of(self, material: Material, material_index: u32) -> Self {
        Self { material, material_index, ..self }
    }
}

impl Lamp {
    /// Direction in which the light shines, of unit length.
    pub fn axis(&self) -> DVec3 {
        (self.target - self.position).normalize_or(DVec3::NEG_Y)
    }

    /// Unit vectors to the right and up, whose cross product is the axis.
    pub fn sides(&self) -> (DVec3, DVec3) {
        let axis = self.axis();
        let right = DVec3::Y.cross(axis).normalize_or(DVec3::X);
        (right, axis.cross(right))
    }

    /// From the world to the coordinates of a picture that the lamp projects into its cone.
    pub fn uv_from_world(&self) -> DMat4 {
        let fov = (2.0 * self.half_angle).clamp(0.1, 3.0);
        let projection = perspective(fov, 1.0, 0.05, 100.0, Clip::Wgpu, Depth::Normal);
        let half = DVec3::new(0.5, -0.5, 1.0);
        let uv_from_clip =
            DMat4::from_translation(DVec3::new(0.5, 0.5, 0.0)) * DMat4::from_scale(half);
        uv_from_clip * projection * look_at(self.position, self.target, DVec3::Y)
    }

    /// Distance of the target.
    pub fn reach(&self) -> f64 {
        self.position.distance(self.target)
    }
}

impl Eye {
    /// World to view space.
    pub fn view(&self) -> DMat4 {
        look_at(self.position, self.target, DVec3::Y)
    }

    /// The viewer after a walk around the point that is looked at, and up, by angles in radians. The
    /// distance stays, and the viewer never stands above or below that point.
    #[must_use]
    pub fn turned(self, [around, up]: [f64; 2]) -> Self {
        const STEEPEST: f64 = 1.5;
        let way = self.position - self.target;
        let flat = way.x.hypot(way.z);
        let (angle, height) = (way.x.atan2(way.z) + around, way.y.atan2(flat));
        let height = (height + up).clamp(-STEEPEST, STEEPEST);
        let (sin, cos) = height.sin_cos();
        let direction = DVec3::new(angle.sin() * cos, sin, angle.cos() * cos);
        Self { position: self.target + direction * way.length(), ..self }
    }
}

impl Scene {
    /// The scene of a model that was read.
    pub fn of_model(objects: Vec<Object>, eye: Eye, lamps: Vec<Lamp>) -> Self {
        base_scene(objects, eye, lamps)
    }

    /// Half of the width and height of lamps with an area.
    pub fn lamp_size(&self) -> DVec2 {
        self.lamp_size.unwrap_or(DVec2::new(0.6, 0.4))
    }

    /// Every vertex of every object that casts a shadow, in world space.
    pub fn points(&self) -> Vec<DVec3> {
        let of = |object: &Object| {
            let matrix = object.world_from_object;
            object
                .shape
                .vertices
                .iter()
                .map(move |vertex| matrix.transform_point3(vertex.position))
                .collect::<Vec<_>>()
        };
        self.objects.iter().filter(|object| object.casts).flat_map(of).collect()
    }
}

/// A scene with its name. Each has a file of `sets/`.
#[derive(Debug)]
pub struct Set {
    /// As presets and the command line name it.
    pub name: &'static str,
    /// One line.
    pub about: &'static str,
    pub make: fn() -> Scene,
}

include!(concat!(env!("OUT_DIR"), "/sets.rs"));

pub fn scene(name: &str) -> Option<Scene> {
    ALL.iter().find(|set| set.name == name).map(|set| (set.make)())
}

/// A transformation that rotates about y and then moves.
fn placed_at(x: f64, y: f64, z: f64, turn: f64) -> DMat4 {
    DMat4::from_translation(DVec3::new(x, y, z)) * DMat4::from_rotation_y(turn)
}

/// A scene with what most scenes share: the materials, ambient light, haze and textures.
fn base_scene(objects: Vec<Object>, eye: Eye, lamps: Vec<Lamp>) -> Scene {
    Scene {
        objects,
        eye,
        lamps,
        lamp_numbers: Vec::new(),
        materials: palette::materials(),
        ambient: DVec3::new(0.05, 0.055, 0.07),
        sky: DVec3::new(0.55, 0.68, 0.9),
        ground: DVec3::new(0.2, 0.15, 0.1),
        haze: DVec3::new(0.42, 0.48, 0.56),
        haze_range: (5.0, 26.0),
        maps: maps::bricks,
        own_maps: None,
        map_size: None,
        shows_lamps: false,
        probes: None,
        lamp_size: None,
        around: None,
        room: None,
    }
}

/// How many entries the array of materials has in the library's programs.
const MATERIALS: usize = 14;

impl Scene {
    /// Puts the materials of the objects into the array, each as front and back, and gives the
    /// objects their indices. Materials from which a glTF surface reads the same share one entry.
    ///
    /// # Errors
    /// The objects have more materials than the array.
    pub fn number_materials(&mut self) -> Result<(), String> {
        let mut found: Vec<Material> = Vec::new();
        for object in &mut self.objects {
            let known = found.iter().position(|one| is_same(one, &object.material));
            object.material_index = known.unwrap_or(found.len()) as u32;
            if known.is_none() {
                found.push(object.material);
            }
        }
        if found.len() > MATERIALS {
            let count = found.len();
            return Err(format!("the scene has {count} materials, and one array has {MATERIALS}"));
        }
        self.materials = found.into_iter().map(|material| [material; 2]).collect();
        Ok(())
    }
}

/// Whether a glTF surface reads the same from both materials. It reads everything else from the
/// block `layers`.
fn is_same(one: &Material, other: &Material) -> bool {
    let read = |material: &Material| (material.emission, material.ambient, material.roughness);
    read(one) == read(other)
}

/// The light probes of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Probes {
    /// How many there are along each axis of the world.
    pub counts: [u32; 3],
    /// What they see where the scene ends.
    pub beyond: DVec3,
}

impl Default for Probes {
    fn default() -> Self {
        Self { counts: [8, 5, 8], beyond: DVec3::new(0.12, 0.14, 0.18) }
    }
}
