//! Frames as numbers: the inputs and the colour of each fragment.

use glam::DVec3;
use lamplight::bundle::Language;
use lamplight::catalogue::preset::PresetNumber;
use lamplight::execute::Session;
use lamplight::permute::{Quoted, key};
use lamplight::picture::{Linear, Plan, PreparedPass, Shot, prepare_passes};
use lamplight::source::SourceSet;

use super::{library, rendered, shot, watched};
use crate::fragments::{Watched, places};

/// An executor, and the language in which it draws.
pub struct Bench<'a> {
    pub painter: &'a dyn Session,
    pub language: Language,
}

/// A fragment of `forward`.
#[derive(Debug, Clone, Copy)]
pub struct Fragment {
    /// The position in the world.
    pub position: DVec3,
    /// The normal, of unit length. It is the vertex's if light is computed at vertices.
    pub normal: DVec3,
    /// The colour of the surface.
    pub base: DVec3,
    /// The drawn colour, neither clamped nor encoded.
    pub color: DVec3,
}

impl Fragment {
    /// The drawn green over the surface's green. For white light, this is the light.
    pub fn light(&self) -> f64 {
        self.color.y / self.base.y
    }
}

/// Numbers by group and field, which override those of the scene.
pub type Numbers<'a> = &'a [(&'a str, &'a str, &'a [f64])];

impl Bench<'_> {
    /// A plan for a permutation of `forward`.
    pub fn plan(&self, text: &str, scene: &str, numbers: Numbers<'_>) -> Result<Plan, String> {
        let programs = &library().programs;
        let forward = programs.manifest().program("forward").ok_or("no forward")?;
        let mut texts = SourceSet::default();
        let id = texts.add("key", text.to_owned());
        let point = key::parse(&forward.space, &Quoted::whole(&texts, id)).map_err(rendered)?;
        let mut plan = Plan::of_point(programs, forward, &point).map_err(rendered)?;
        plan.scene = scene.to_owned();
        for (group, field, values) in numbers {
            let fields = plan.numbers.entry((*group).to_owned()).or_default();
            fields.insert((*field).to_owned(), PresetNumber::Vector(values.to_vec()));
        }
        Ok(plan)
    }

    /// The fragments of a frame, `size` pixels wide and high.
    pub fn fragments(&self, plan: &Plan, size: u32) -> Result<Vec<Fragment>, String> {
        self.prepared(plan, size).and_then(|prepared| self.fragments_of(&prepared, size))
    }

    pub fn prepared(&self, plan: &Plan, size: u32) -> Result<PreparedPass, String> {
        prepare_passes(self.painter, &library().programs, plan, &shot([size; 2], 1, self.language))
            .map_err(rendered)
    }

    /// Prepares a frame with several shadow cascades.
    pub fn cascaded(&self, plan: &Plan, size: u32, cascades: u32) -> Result<PreparedPass, String> {
        let shot = Shot { cascades, ..shot([size; 2], 1, self.language) };
        prepare_passes(self.painter, &library().programs, plan, &shot).map_err(rendered)
    }

    pub fn photograph(&self, prepared: &PreparedPass, size: u32) -> Result<Linear, String> {
        prepared.photograph(self.painter, &shot([size; 2], 1, self.language)).map_err(rendered)
    }

    pub fn fragments_of(
        &self,
        prepared: &PreparedPass,
        size: u32,
    ) -> Result<Vec<Fragment>, String> {
        let targets = watched(self.painter, prepared, [size; 2])?;
        let watched = Watched { size: [size; 2], targets: &targets };
        let places = places(prepared.stages.fragment.as_ref().ok_or("no fragment stage")?)?;
        let fragment = |pixel: usize| {
            let words: Vec<f64> =
                watched.inputs(pixel).map(|word| f64::from(f32::from_bits(word))).collect();
            let part = |location, component| {
                places.get(&(location, component)).map_or(0.0, |index| words[*index])
            };
            let vector =
                |location| DVec3::new(part(location, 0), part(location, 1), part(location, 2));
            let [r, g, b, _] = watched.color(pixel);
            Fragment {
                position: vector(0),
                normal: vector(1).normalize_or_zero(),
                base: vector(2),
                color: DVec3::new(r, g, b),
            }
        };
        Ok((0..(size * size) as usize)
            .filter(|pixel| watched.is_drawn(*pixel))
            .map(fragment)
            .collect())
    }
}

/// A number of a uniform block that the fragment stage reads.
pub fn uniform(prepared: &PreparedPass, block: &str, field: &str) -> Option<f64> {
    let stage = prepared.stages.fragment.as_ref()?;
    let binding = stage.reflection.bindings.iter().find(|binding| binding.name == block)?;
    let member = binding.members.iter().find(|member| member.name == field)?;
    let bytes = prepared.buffers.get(&(binding.group, binding.binding))?;
    let word = bytes.get(member.offset as usize..member.offset as usize + 4)?;
    Some(f64::from(f32::from_le_bytes(word.try_into().ok()?)))
}

/// Fails if two numbers differ by more than a tolerance, which is relative for numbers above 1.
pub fn close(what: &str, found: f64, wanted: f64, tolerance: f64) -> Result<(), String> {
    if (found - wanted).abs() <= tolerance * wanted.abs().max(1.0) {
        Ok(())
    } else {
        Err(format!("{what}: found {found}, wanted {wanted} within {tolerance:e}"))
    }
}
