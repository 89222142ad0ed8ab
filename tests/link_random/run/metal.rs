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
            if let Some(Ok(Stages { vertex, fragment, input_stage })) =
                ready.stages.get(&Target::MSL)
            {
                first.insert(index, stages.len());
                stages.extend([vertex].into_iter().chain(fragment).chain(input_stage).cloned());
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
            let input_stage = ready.partner.input_stage.as_ref();
            if !ready.runnable.is_fragment() {
                let inputs = input_stage
                    .map(|input_stage| draw(first + 1, input_stage.targets))
                    .transpose()?;
                return Ok((Targets::new(), inputs.unwrap_or_default()));
            }
            let inputs =
                input_stage.map(|input_stage| draw(first + 2, input_stage.targets)).transpose()?;
            Ok((draw(first + 1, count)?, inputs.unwrap_or_default()))
        })
    }
}
