//! The gallery: every preset as a picture, beside what made it.

mod html;
mod markdown;

pub use html::page as html;
pub use markdown::page as markdown;

use std::sync::Arc;

use super::picture::Picture;
use super::plan::Plan;
use super::{Shot, prepare};
use crate::catalogue::preset::Preset;
use crate::diagnostic::Diagnostics;
use crate::harness::frame::{Painter, Programs};

/// One preset with its picture.
pub struct Exhibit {
    pub preset: Preset,
    pub picture: Picture,
    /// What drew it.
    pub adapter: String,
    /// The composed texts of the last pass: one, or one for each stage.
    pub texts: Vec<Arc<str>>,
}

impl Exhibit {
    /// Draws a preset.
    ///
    /// # Errors
    /// Those of compositions and of the painter.
    pub fn new(painter: &dyn Painter, programs: &Programs, preset: &Preset, plan: &Plan, shot: &Shot) -> Result<Self, Diagnostics> {
        let prepared = prepare(painter, programs, plan, shot)?;
        let picture = prepared.photograph(painter, shot)?.develop();
        let mut texts = vec![prepared.stages.vertex.text.clone()];
        texts.extend(prepared.stages.fragment.map(|stage| stage.text).filter(|text| *text != texts[0]));
        Ok(Self { preset: preset.clone(), picture, adapter: painter.adapter(), texts })
    }

    /// Programs and keys of all passes, in order.
    fn passes(&self) -> Vec<String> {
        let earlier = self.preset.passes.iter().map(|pass| (&pass.program, &pass.key));
        let all = earlier.chain([(&self.preset.program, &self.preset.key)]);
        all.map(|(program, key)| format!("{program}: {}", key.replace(',', ", "))).collect()
    }

    /// Paths of the composed texts beside the page.
    fn files(&self) -> impl Iterator<Item = String> {
        let extensions: &[&str] = if self.texts.len() == 1 { &["wgsl"] } else { &["vert.glsl", "frag.glsl"] };
        extensions.iter().map(|extension| format!("composed/{}.{extension}", self.preset.name))
    }

    /// The command that draws it.
    fn command(&self) -> String {
        format!("lamplight render {}", self.preset.name)
    }
}

/// The composed texts by path beside the page, those of the first exhibit that has them.
pub fn composed(exhibits: &[Exhibit]) -> Vec<(String, String)> {
    let mut files = Vec::new();
    for (index, exhibit) in exhibits.iter().enumerate() {
        if first_alike(exhibits)[index] == index {
            files.extend(exhibit.files().zip(exhibit.texts.iter().map(|text| text.to_string())));
        }
    }
    files
}

/// For each exhibit the first that has the same composed texts.
fn first_alike(exhibits: &[Exhibit]) -> Vec<usize> {
    let first = |exhibit: &Exhibit| exhibits.iter().position(|other| other.texts == exhibit.texts).unwrap_or(0);
    exhibits.iter().map(first).collect()
}

/// Which driver drew which picture: a line each, for the eye and for tests.
pub fn adapters(exhibits: &[Exhibit], shot: &Shot) -> String {
    let [width, height] = shot.size;
    let line =
        |exhibit: &Exhibit| format!("{}.png  {width}x{height}, {} samples, {}\n", exhibit.preset.name, shot.samples, exhibit.adapter);
    exhibits.iter().map(line).collect()
}
