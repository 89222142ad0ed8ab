//! The lamps of a scene as a permutation has them: their numbers, and what is seen of them.

use glam::DVec3;

use super::needs::Falloff;
use super::plan::{LAMPS, with_numbers};
use super::values::{UniformValues, eye_projection, matrix_columns, vector_of, vector_values};
use lamplight_diagnostic::Diagnostics;
use lamplight_scene::{Cells, Clusters, Reach};
use lamplight_scenes::between_middles;
use lamplight_scenes::sets::{Lamp, LampKind, LampNumbers, Scene};

/// The range of falloffs that have one, as a multiple of the target's distance.
const RANGE: f64 = 2.4;
/// How far away a directional light is, as a multiple of the reach of its lamp.
const FAR_AWAY: f64 = 100.0;

/// How a lamp fades with distance.
struct Fading {
    falloff: Falloff,
    coefficients: Vec<f64>,
    range: f64,
}

impl Fading {
    /// The factor that ends at the range. As in the programs, a range of zero is none.
    fn window(&self, d: f64) -> f64 {
        let share = if self.range > 0.0 { d / self.range } else { 0.0 };
        (1.0 - share.powi(4)).max(0.0)
    }

    /// Whether the falloff is that of light, as KHR_lights_punctual has it.
    fn is_physical(&self) -> bool {
        matches!(self.falloff, Falloff::InverseSquareWindow | Falloff::RangeGltf)
    }
}

/// A lamp with the numbers that the program has of it, to compute the light that probes get.
pub(super) struct Shining {
    kind: LampKind,
    color: DVec3,
    position: DVec3,
    axis: DVec3,
    reach: f64,
    /// Cosines of the angles where the edge of a cone begins and ends.
    inner: f64,
    outer: f64,
    fading: Fading,
}

impl Fading {
    /// How much of the light is left at a distance.
    fn at(&self, d: f64) -> f64 {
        match self.falloff {
            Falloff::None => 1.0,
            Falloff::Polynomial => {
                let coefficients = self.coefficients.iter().rev();
                1.0 / coefficients.fold(0.0, |sum, coefficient| sum * d + coefficient)
            }
            Falloff::LinearRadius => (1.0 - d / self.range).max(0.0),
            Falloff::InverseSquareWindow => self.window(d).powi(2) / (d * d).max(1e-4),
            Falloff::RangeGltf => self.window(d) / (d * d).max(1e-4),
        }
    }
}

impl Shining {
    /// The light that a surface at a point gets if it faces the lamp, and the place that the light
    /// comes from. A spot fades towards the edge of its cone as with `cone=smooth`.
    pub fn arriving(&self, at: DVec3) -> (DVec3, DVec3) {
        if self.kind == LampKind::Directional {
            return (self.color, at - self.axis * FAR_AWAY * self.reach);
        }
        let offset = at - self.position;
        let along = offset.normalize_or_zero().dot(self.axis) - self.outer;
        let along = along / (self.inner - self.outer).max(1e-6);
        let t = if self.kind == LampKind::Spot { along.clamp(0.0, 1.0) } else { 1.0 };
        let share = t * t * (3.0 - 2.0 * t) * self.fading.at(offset.length());
        (self.color * share, self.position)
    }
}

impl UniformValues<'_> {
    /// How many lamps shine: those of the scene, as far as the array has room. `None` if the
    /// program has no lamps.
    pub fn lamps(&self) -> Option<usize> {
        let axis = self.lit.integer(LAMPS).and_then(|most| usize::try_from(most).ok());
        let most = axis.or(self.lit.needs.room)?;
        Some(self.scene.lamps.len().min(most))
    }

    /// The kind of a lamp in this permutation.
    pub fn kind(&self, index: usize, lamp: &Lamp) -> LampKind {
        let needs = &self.lit.needs;
        // The first lamp casts the shadow.
        let caster = if index == 0 && needs.has_shadow() { needs.caster } else { None };
        needs.lamps.or(caster).unwrap_or(lamp.kind)
    }

    pub(super) fn lamp(&self, index: usize, field: &str) -> Option<Vec<f64>> {
        // An array that is longer than the scene has lamps ends with zeros.
        let Some(lamp) = self.scene.lamps.get(index) else { return Some(Vec::new()) };
        let (kind, given) = (self.kind(index, lamp), self.given(index));
        Some(match field {
            "kind" => vec![match kind {
                LampKind::Directional => 1.0,
                LampKind::Point => 2.0,
                LampKind::Spot => 3.0,
            }],
            // Unless a source has colours of their own for them, highlights have the lamp's.
            "specular" => match self.plan.number("light", "color") {
                Some(color) => color,
                None => vector_values(self.intensity(index, lamp, kind)),
            },
            "half_vector" => vector_values(self.half_vector(index, lamp, kind)),
            "color" => vector_values(self.intensity(index, lamp, kind)),
            // The lamps of a model have no ambient part.
            "ambient" if given.is_some() => vec![0.0; 3],
            "ambient" => vector_values(lamp.color * 0.06),
            "range" => vec![given.map_or(RANGE * lamp.reach(), |numbers| numbers.range)],
            "position" => vector_values(lamp.position),
            "axis" => vector_values(self.axis(index, lamp, kind)),
            "cutoff" | "outer" => vec![given.map_or(lamp.half_angle, |own| own.outer).cos()],
            "inner" => vec![given.map_or(0.75 * lamp.half_angle, |own| own.inner).cos()],
            "shadow_layer" => vec![if index == 0 { 0.0 } else { -1.0 }],
            _ => return None,
        })
    }

    /// What a model says of a lamp.
    fn given(&self, index: usize) -> Option<&LampNumbers> {
        self.scene.lamp_numbers.get(index)
    }

    /// The direction of a lamp. Several directional lights shine from where the lamps are, and not
    /// all straight down.
    fn axis(&self, index: usize, lamp: &Lamp, kind: LampKind) -> DVec3 {
        let key = self.scene.lamps.first().map_or(DVec3::ZERO, |key| key.target);
        if kind == LampKind::Directional && index > 0 && self.given(index).is_none() {
            (key - lamp.position).normalize_or(DVec3::NEG_Y)
        } else {
            lamp.axis()
        }
    }

    /// Where the light of one direction has its highlight, for a viewer infinitely far away.
    fn half_vector(&self, index: usize, lamp: &Lamp, kind: LampKind) -> DVec3 {
        let eye = &self.scene.eye;
        let viewer = (eye.position - eye.target).normalize_or(DVec3::Z);
        let published = self.plan.number("light", "axis").and_then(|axis| vector_of(&axis));
        let axis = published.unwrap_or_else(|| self.axis(index, lamp, kind));
        (viewer - axis).normalize_or(viewer)
    }

    /// The intensity with which the lamp's colour arrives at the target, whatever the falloff is.
    /// A lamp of a model is as bright as the model says, with the falloff of light.
    fn intensity(&self, index: usize, lamp: &Lamp, kind: LampKind) -> DVec3 {
        /// Beyond, the product with the falloff leaves the numbers of 32 bits.
        const LEAST: f64 = 1e-30;
        if kind == LampKind::Directional {
            // Directional lights reach everywhere, so all but the first of our own scenes are dimmer.
            let is_whole = index == 0 || self.given(index).is_some();
            return lamp.color * if is_whole { 1.0 } else { 0.25 };
        }
        let fading = self.fading(index, lamp);
        if self.given(index).is_some() && fading.is_physical() {
            return lamp.color * lamp.reach().powi(2);
        }
        let falloff = fading.at(lamp.reach());
        lamp.color / if falloff > LEAST { falloff } else { 1.0 }
    }

    fn fading(&self, index: usize, lamp: &Lamp) -> Fading {
        let published = self.plan.number("light", "attenuation");
        let coefficients = published.or_else(|| self.lit.needs.uniform("lamps", "attenuation"));
        Fading {
            falloff: self.lit.needs.falloff,
            coefficients: coefficients.unwrap_or_else(|| vec![1.0]),
            range: self.range(index, lamp),
        }
    }

    /// The lamps that shine, with the numbers that the program has of them.
    pub(super) fn shining(&self) -> Vec<Shining> {
        let lamps = self.scene.lamps.iter().enumerate().take(self.lamps().unwrap_or(0));
        let shining = |(index, lamp): (usize, &Lamp)| {
            let numbers = |field: &str| {
                self.number(&format!("lamps.lights[{index}].{field}")).unwrap_or_default()
            };
            let vector = |field: &str| vector_of(&numbers(field)).unwrap_or_default();
            let single = |field: &str| numbers(field).first().copied().unwrap_or_default();
            let fading = self.fading(index, lamp);
            let coefficients = Some(numbers("attenuation")).filter(|numbers| !numbers.is_empty());
            Shining {
                kind: self.kind(index, lamp),
                color: vector("color"),
                position: vector("position"),
                axis: vector("axis").normalize_or_zero(),
                reach: lamp.reach(),
                inner: single("inner"),
                outer: single("outer"),
                fading: Fading {
                    range: single("range"),
                    coefficients: coefficients.unwrap_or(fading.coefficients),
                    falloff: fading.falloff,
                },
            }
        };
        lamps.map(shining).collect()
    }

    /// The range of a lamp; 0 is none.
    fn range(&self, index: usize, lamp: &Lamp) -> f64 {
        let published = self.plan.number("light", "range");
        let given = || self.given(index).map(|numbers| numbers.range);
        let published = published.and_then(|range| range.first().copied());
        published.or_else(given).unwrap_or(RANGE * lamp.reach())
    }

    /// The numbers of a lamp in the block `areas`: its extent.
    pub(super) fn area(&self, index: usize, field: &str) -> Option<Vec<f64>> {
        let Some(lamp) = self.scene.lamps.get(index) else { return Some(Vec::new()) };
        let (right, up) = lamp.sides();
        let size = self.scene.lamp_size();
        Some(match field {
            "right" => vector_values(right * size.x),
            "up" => vector_values(up * size.y),
            "radius" => vec![self.lit.needs.shape?.radius(size)],
            _ => return None,
        })
    }

    /// The numbers of a lamp in the block `profiles`: how it reads its profile.
    pub(super) fn profile(&self, index: usize, field: &str) -> Option<Vec<f64>> {
        let Some(lamp) = self.scene.lamps.get(index) else { return Some(Vec::new()) };
        let [scale_x, scale_y, x, y] = between_middles(&self.lit.needs.profile?.map()).to_array();
        Some(match field {
            "uv_from_world" => matrix_columns(lamp.uv_from_world()),
            "right" => vector_values(lamp.sides().0),
            // Light of one direction has no place to project from.
            "share" if self.kind(index, lamp) == LampKind::Directional => vec![0.0],
            "share" => vec![1.0],
            "scale" => vec![scale_x, scale_y],
            "offset" => vec![x, y],
            _ => return None,
        })
    }

    /// The numbers of the block `clusters`: the lists of lamps for the cells of the view.
    pub(super) fn cluster(&self, index: usize, field: &str) -> Option<Vec<f64>> {
        let eye = &self.scene.eye;
        let cells = Cells { counts: [16, 8, 16], near: eye.near, far: eye.far };
        let made = || {
            let shining = self.scene.lamps.iter().enumerate().take(self.lamps()?);
            let reach = |(index, lamp)| self.lamp_reach(index, lamp);
            let lamps: Vec<Reach> = shining.map(reach).collect();
            Clusters::new(&cells, eye_projection(eye, self.shot), eye.view(), &lamps).ok()
        };
        let words = |words: &[u32]| {
            let word = |part: usize| words.get(4 * index + part).copied().unwrap_or_default();
            (0..4).map(|part| f64::from(word(part))).collect()
        };
        let lists = self.clusters.get_or_init(made).as_ref()?;
        Some(match field {
            "counts" => cells.counts.map(f64::from).to_vec(),
            "near" => vec![cells.near],
            "far" => vec![cells.far],
            "cells" => words(&lists.cells),
            "indices" => words(&lists.indices),
            _ => return None,
        })
    }

    /// The sphere that a lamp lights. It is infinite if the falloff has no end.
    fn lamp_reach(&self, index: usize, lamp: &Lamp) -> Reach {
        let range = self.range(index, lamp);
        let ends = match self.lit.needs.falloff {
            Falloff::None | Falloff::Polynomial => false,
            Falloff::LinearRadius => true,
            Falloff::InverseSquareWindow | Falloff::RangeGltf => range > 0.0,
        };
        let is_near = ends && self.kind(index, lamp) != LampKind::Directional;
        let range = if is_near { range } else { f64::INFINITY };
        Reach { position: lamp.position, range }
    }

    /// The scene with objects added for the lamps that have a position. `None` if the scene does
    /// not show its lamps.
    ///
    /// # Errors
    /// It has too many materials for one array.
    pub(super) fn with_bulbs(&self) -> Result<Option<Scene>, Diagnostics> {
        let Self { scene, lit, .. } = self;
        if !scene.shows_lamps || lit.needs.unlit {
            return Ok(None);
        }
        let shining = scene.lamps.iter().enumerate().take(self.lamps().unwrap_or(0));
        let kinds = shining.map(|(index, lamp)| (lamp, self.kind(index, lamp)));
        let bulbs = kinds.filter(|(_, kind)| *kind != LampKind::Directional);
        let bulbs = bulbs.flat_map(|(lamp, kind)| match lit.needs.shape {
            Some(shape) => scene.wide_lamp(lamp, shape),
            None => Scene::bulb(lamp, kind),
        });
        let objects = scene.objects.iter().cloned().chain(bulbs).collect();
        with_numbers(Scene { objects, ..(*scene).clone() }, &lit.needs).map(Some)
    }
}
