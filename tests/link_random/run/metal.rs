//! Compiles and draws the MSL of a batch of stages.

use std::collections::BTreeMap;

use lamplight::bundle::Target;
use lamplight::diagnostic::Diagnostic;
use lamplight::execute::frame::Drawing;
use lamplight::execute::raster::CompiledStages;

use super::{Ready, Stages, Targets};

/// All stages of a batch in MSL, compiled at once.
pub struct Metal {
    compiled: CompiledStages,
    /// For each stage that has MSL, the index of its vertex stage. The fragment stages that are
    /// drawn with it follow: the one that is tried, if it is one, and the one that writes its inputs.
    first: BTreeMap<usize, usize>,
}

impl Metal {
    pub fn new(ready: &[Ready<'_>]) -> Result<Self, String> {
        let (mut stages, mut first) = (Vec::new(), BTreeMap::new());
        for (index, ready) in ready.iter().enumerate() {
            if let Some(Ok(Stages { vertex, fragment, tells })) = ready.stages.get(&Target::MSL) {
                first.insert(index, stages.len());
                stages.extend([vertex].into_iter().chain(fragment).chain(tells).cloned());
            }
        }
        let compiled = CompiledStages::new(stages).map_err(|missing| missing.reason)?;
        Ok(Self { compiled, first })
    }

    pub fn draw(&self, index: usize, ready: &Ready<'_>) -> Result<(Targets, Targets), Diagnostic> {
        let first = self.first[&index];
        let outputs = &ready.runnable.unit.reflection.outputs;
        let count =
            outputs.iter().filter_map(|output| output.location).max().map_or(0, |last| last + 1);
        ready.drawing(|drawing| {
            let draw = |fragment, targets| {
                let drawing = Drawing { targets, ..*drawing };
                let frames = self.compiled.draw(first, Some(fragment), &drawing);
                frames.map(|mut frames| frames.remove(0).targets)
            };
            let tells = ready.partner.tells.as_ref();
            if !ready.runnable.is_fragment() {
                let told = tells.map(|tells| draw(first + 1, tells.targets)).transpose()?;
                return Ok((Targets::new(), told.unwrap_or_default()));
            }
            let told = tells.map(|tells| draw(first + 2, tells.targets)).transpose()?;
            Ok((draw(first + 1, count)?, told.unwrap_or_default()))
        })
    }
}
