//! The gallery: every preset as a picture, beside what made it.

mod html;
mod markdown;

pub use html::page as html;
pub use markdown::page as markdown;

use std::sync::Arc;

use super::pixels::Picture;
use super::plan::Plan;
use super::{Shot, prepare};
use crate::bundle::Language;
use crate::catalogue::preset::Preset;
use crate::diagnostic::{Diagnostic, Diagnostics, codes};
use crate::execute::Session;
use crate::picture::frame::{Programs, Stages};

/// One preset with its picture.
pub struct Exhibit {
    pub card: Card,
    pub picture: Picture,
    /// What drew it.
    pub adapter: String,
}

/// What is said of a preset.
pub struct Card {
    pub preset: Preset,
    /// The composed texts of the last pass: one, or one for each stage.
    texts: Vec<Arc<str>>,
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
        let prepared = prepare(painter, programs, plan, shot)?;
        let picture = prepared.photograph(painter, shot)?.develop();
        Ok(Self { card: Card::of(preset, &prepared.stages), picture, adapter: painter.adapter() })
    }
}

impl Card {
    /// What is said of a preset without its picture.
    ///
    /// # Errors
    /// Those of the composition.
    pub fn new(
        programs: &Programs,
        preset: &Preset,
        language: Language,
    ) -> Result<Self, Diagnostics> {
        let plan = Plan::of_preset(programs, preset, &[])?;
        let settings = plan.last().map(|pass| pass.settings.clone()).unwrap_or_default();
        let unknown = || {
            vec![Diagnostic::error(
                codes::UNKNOWN_PROGRAM,
                format!("there is no program `{}`", preset.program),
            )]
        };
        let program = programs.manifest().program(&preset.program).ok_or_else(unknown)?;
        Ok(Self::of(preset, &programs.stages(program, &settings, language)?))
    }

    fn of(preset: &Preset, stages: &Stages) -> Self {
        let mut texts = vec![stages.vertex.text.clone()];
        texts.extend(
            stages
                .fragment
                .iter()
                .map(|stage| stage.text.clone())
                .filter(|text| *text != stages.vertex.text),
        );
        Self { preset: preset.clone(), texts }
    }

    /// Programs and keys of all passes, in order.
    fn passes(&self) -> Vec<String> {
        let earlier = self.preset.passes.iter().map(|pass| (&pass.program, &pass.key));
        let all = earlier.chain([(&self.preset.program, &self.preset.key)]);
        all.map(|(program, key)| format!("{program}: {}", key.replace(',', ", "))).collect()
    }

    /// Paths of the composed texts beside the page: to read, not to compile, so `.txt`.
    fn files(&self) -> impl Iterator<Item = String> {
        let extensions: &[&str] =
            if self.texts.len() == 1 { &["wgsl"] } else { &["vert.glsl", "frag.glsl"] };
        extensions.iter().map(|extension| format!("composed/{}.{extension}.txt", self.preset.name))
    }

    /// The command that draws it.
    fn command(&self) -> String {
        format!("lamplight render {}", self.preset.name)
    }
}

/// The composed texts by path beside the page, those of the first card that has them.
pub fn composed(cards: &[&Card]) -> Vec<(String, String)> {
    let first = first_alike(cards);
    let own = cards.iter().enumerate().filter(|(index, _)| first[*index] == *index);
    own.flat_map(|(_, card)| card.files().zip(card.texts.iter().map(ToString::to_string))).collect()
}

/// For each card the first that has the same composed texts.
fn first_alike(cards: &[&Card]) -> Vec<usize> {
    let first =
        |card: &&Card| cards.iter().position(|other| other.texts == card.texts).unwrap_or(0);
    cards.iter().map(first).collect()
}

/// Which driver drew which picture: a line each, for the eye and for tests.
pub fn adapters(exhibits: &[Exhibit], shot: &Shot) -> String {
    let [width, height] = shot.size;
    let line = |exhibit: &Exhibit| {
        format!(
            "{}.png  {width}x{height}, {} samples, {}\n",
            exhibit.card.preset.name, shot.samples, exhibit.adapter
        )
    };
    exhibits.iter().map(line).collect()
}
