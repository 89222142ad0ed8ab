//! The gallery: every preset as a picture, with everything that it was made from.

mod html;
mod markdown;

pub use html::html_page;
pub use markdown::markdown_page;

use std::sync::Arc;

use super::pixels::Picture;
use super::plan::{Pass, Plan, known_program};
use super::strip::{self, Comparison};
use super::{Shot, prepare_passes};
use crate::frame::{Programs, Stages};
use lamplight_bundle::Language;
use lamplight_catalogue::preset::Preset;
use lamplight_diagnostic::Diagnostics;
use lamplight_execute::Session;
use lamplight_scenes::sets::{self, Scene};

/// The size of the gallery's pictures in pixels, and the samples for each pixel.
pub const SIZE: [u32; 2] = [960, 720];
pub const SAMPLES: u32 = 16;
/// The pictures on the pages are smaller by this factor.
pub const THUMB: u32 = 2;

/// One preset with its picture.
pub struct Exhibit {
    pub card: Card,
    pub picture: Picture,
    /// What drew it.
    pub adapter: String,
}

/// What the pages say about a preset.
pub struct Card {
    pub preset: Preset,
    /// The composed texts of the last pass: one, or one for each stage.
    texts: Vec<Arc<str>>,
    /// The library's functions in them, by path.
    functions: Vec<String>,
    /// A hash of everything that the picture is made from: settings, numbers, and the texts of all
    /// passes.
    fingerprint: String,
}

impl Exhibit {
    /// Draws a preset.
    ///
    /// # Errors
    /// Those of compositions and of the painter.
    pub fn new(
        painter: &dyn Session,
        programs: &Programs,
        preset: &Preset,
        plan: &Plan,
        shot: &Shot,
    ) -> Result<Self, Diagnostics> {
        let card = Card::new(programs, preset, shot.language)?;
        let picture =
            prepare_passes(painter, programs, plan, shot)?.photograph(painter, shot)?.develop();
        Ok(Self { card, picture, adapter: painter.adapter() })
    }
}

impl Card {
    /// What the pages say about a preset, without its picture.
    ///
    /// # Errors
    /// Those of the composition.
    pub fn new(
        programs: &Programs,
        preset: &Preset,
        language: Language,
    ) -> Result<Self, Diagnostics> {
        let plan = Plan::of_preset(programs, preset, &[])?;
        let mut hasher = blake3::Hasher::new();
        hasher.update(settings_text(preset).as_bytes());
        hasher.update(geometry_text(&preset.scene).as_bytes());
        let all = composed_texts(programs, &plan, language)?;
        for text in all.concat() {
            hasher.update(text.as_bytes());
        }
        let own = all.into_iter().next_back().unwrap_or_default();
        let last = plan.last().map(|pass| compiled_stages(programs, pass, language)).transpose()?;
        let functions = last.map_or_else(Vec::new, |stages| named_functions(&stages));
        let fingerprint = hasher.finalize().to_hex()[..16].to_owned();
        Ok(Self { preset: preset.clone(), texts: own, functions, fingerprint })
    }

    /// Programs and keys of all passes, in order.
    fn passes(&self) -> Vec<(&str, String)> {
        let earlier = self.preset.passes.iter().map(|pass| (&pass.program, &pass.key));
        let all = earlier.chain([(&self.preset.program, &self.preset.key)]);
        all.map(|(program, key)| (program.as_str(), key.replace(',', ", "))).collect()
    }

    /// Paths of the composed texts beside the page. They end in `.txt`, since they are for reading
    /// and not for compiling.
    fn files(&self) -> impl Iterator<Item = String> {
        let extensions: &[&str] =
            if self.texts.len() == 1 { &["wgsl"] } else { &["vert.glsl", "frag.glsl"] };
        extensions.iter().map(|extension| format!("composed/{}.{extension}.txt", self.preset.name))
    }

    /// The command that draws it.
    fn command(&self) -> String {
        render_command(&self.preset.name)
    }

    /// Each function of the library that its text has: the path, and its page of the catalogue.
    fn functions(&self) -> impl Iterator<Item = (&str, String)> {
        self.functions.iter().filter_map(|path| {
            let (module, name) = path.rsplit_once("::")?;
            Some((name, format!("../catalogue/{}.md#{name}", module.replace("::", "/"))))
        })
    }

    /// How the line of [`adapter_lines`] begins if the picture is up to date.
    pub fn current(&self, shot: &Shot) -> String {
        current_line(&format!("{}.png", self.preset.name), shot, &self.fingerprint)
    }
}

/// What the pages say about a comparison.
pub struct StripCard {
    pub comparison: Comparison,
    fingerprint: String,
}

impl StripCard {
    /// What the pages say about a comparison, without its picture.
    ///
    /// # Errors
    /// Those of the compositions.
    pub fn new(
        programs: &Programs,
        comparison: Comparison,
        language: Language,
    ) -> Result<Self, Diagnostics> {
        let mut hasher = blake3::Hasher::new();
        let Comparison { scene, code, inset, panels, .. } = &comparison;
        hasher.update(serde_json::json!([scene, code, inset, panels]).to_string().as_bytes());
        hasher.update(geometry_text(scene).as_bytes());
        for panel in panels.iter().filter(|panel| panel.value.is_none()) {
            let plan = strip::panel_plan(programs, &comparison, panel)?;
            for text in composed_texts(programs, &plan, language)?.concat() {
                hasher.update(text.as_bytes());
            }
        }
        let fingerprint = hasher.finalize().to_hex()[..16].to_owned();
        Ok(Self { comparison, fingerprint })
    }

    /// How the line of `adapters.txt` begins if the picture is up to date.
    pub fn current(&self, shot: &Shot) -> String {
        current_line(&strip_file(&self.comparison.name), shot, &self.fingerprint)
    }

    /// The command that draws it.
    fn command(&self) -> String {
        render_command(&self.comparison.name)
    }
}

/// The path of a comparison's picture beside the page.
pub fn strip_file(name: &str) -> String {
    format!("compared/{name}.png")
}

fn current_line(file: &str, shot: &Shot, fingerprint: &str) -> String {
    let ([width, height], samples) = (shot.size, shot.samples);
    format!("{file}  {width}x{height}, {samples} samples, of {fingerprint}")
}

fn render_command(name: &str) -> String {
    let [width, height] = SIZE;
    format!("lamplight render {name} --size {width}x{height} --samples {SAMPLES}")
}

/// The texts of every pass.
fn composed_texts(
    programs: &Programs,
    plan: &Plan,
    language: Language,
) -> Result<Vec<Vec<Arc<str>>>, Diagnostics> {
    let stages = |pass| Ok(stage_texts(&compiled_stages(programs, pass, language)?));
    plan.passes.iter().map(stages).collect()
}

fn compiled_stages(
    programs: &Programs,
    pass: &Pass,
    language: Language,
) -> Result<Stages, Diagnostics> {
    programs.stages(known_program(programs, &pass.program)?, &pass.settings, language)
}

/// Everything of a preset that its picture depends on, as one text.
fn settings_text(preset: &Preset) -> String {
    let Preset { program, key, scene, probe, passes, numbers, .. } = preset;
    serde_json::json!([program, key, scene, probe, passes, numbers]).to_string()
}

/// Shapes, lamps and viewer of a scene as text, to the thousandth: the last digits of a sine differ
/// from machine to machine.
fn geometry_text(scene: &str) -> String {
    let Some(set) = sets::ALL.iter().find(|set| set.name == scene) else { return String::new() };
    let Scene {
        objects,
        eye,
        lamps,
        materials,
        ambient,
        sky,
        ground,
        haze,
        haze_range,
        map_size,
        shows_lamps,
        lamp_size,
        probes,
        around,
        room,
        maps: _,
        own_maps: _,
    } = (set.make)();
    let seen = (objects, eye, lamps, materials);
    let size = lamp_size.map(|size| format!(" {size}")).unwrap_or_default();
    let probes = probes.map(|probes| format!(" {probes:?}")).unwrap_or_default();
    let around = around.map(|around| format!(" {around}")).unwrap_or_default();
    let room = room.map(|room| format!(" {room:?}")).unwrap_or_default();
    format!(
        "{seen:.3?} {ambient} {sky} {ground} {haze} {haze_range:?} {map_size:?} {shows_lamps}{size}{probes}{around}{room}"
    )
}

fn stage_texts(stages: &Stages) -> Vec<Arc<str>> {
    let vertex = stages.vertex.text.clone();
    let fragment = stages.fragment.iter().map(|stage| stage.text.clone());
    let other: Vec<_> = fragment.filter(|text| *text != vertex).collect();
    std::iter::once(vertex).chain(other).collect()
}

fn named_functions(stages: &Stages) -> Vec<String> {
    let all = [Some(&stages.vertex), stages.fragment.as_ref()];
    let all = all.into_iter().flatten().flat_map(|stage| stage.functions.iter().cloned());
    all.collect::<std::collections::BTreeSet<_>>().into_iter().collect()
}

/// The path of a picture beside the page, and that of its small form, which the page shows.
pub fn picture_files(name: &str) -> [String; 2] {
    [format!("{name}.png"), format!("thumbs/{name}.png")]
}

/// The composed texts, by path beside the page. Cards with the same texts share those of the first.
pub fn composed(cards: &[&Card]) -> Vec<(String, String)> {
    let first = first_alike(cards);
    let own = cards.iter().enumerate().filter(|(index, _)| first[*index] == *index);
    own.flat_map(|(_, card)| card.files().zip(card.texts.iter().map(ToString::to_string))).collect()
}

/// For each card, the first card with the same composed texts.
fn first_alike(cards: &[&Card]) -> Vec<usize> {
    let first =
        |card: &&Card| cards.iter().position(|other| other.texts == card.texts).unwrap_or(0);
    cards.iter().map(first).collect()
}

/// Which driver drew which picture from what: a line for each picture, for people and for tests.
pub fn adapter_lines(exhibits: &[Exhibit], shot: &Shot) -> String {
    let line = |exhibit: &Exhibit| format!("{}, {}\n", exhibit.card.current(shot), exhibit.adapter);
    exhibits.iter().map(line).collect()
}
