//! The evaluator of this crate in f32, with every operation rounded to nearest. It needs no device
//! and no driver.
//!
//! Runs on: every system

use super::{ExecutorEntry, Unavailable};
use crate::dispatch::{ComputeForm, Dispatch, DispatchResult, evaluate};
use crate::frame::{Drawing, Frame};
use crate::interpreter::{Interpreter, word_of};
use crate::kernel::Kernel;
use crate::{Session, raster};
use lamplight_diagnostic::{Diagnostic, codes};

pub const EXECUTOR: ExecutorEntry = ExecutorEntry {
    name: "eval",
    about: "interpreter on the CPU, f32 rounded to nearest",
    needs: &[],
    before_threads: None,
    samples: Some(1),
    open: || Ok::<_, Unavailable>(Box::new(Cpu::default())),
    shipping: None,
    reads_glsl: false,
    compute: Some(ComputeForm::Module),
};

/// Keeps the program of the last kernel, since all rows of one kernel are run one after another.
#[derive(Default)]
struct Cpu {
    last: Option<(u64, Interpreter)>,
}

impl Session for Cpu {
    fn adapter(&self) -> String {
        "lamplight eval, f32".to_owned()
    }

    fn run(&mut self, kernel: &Kernel, inputs: &[u32]) -> Result<Vec<u32>, Diagnostic> {
        let kinds = kernel.result_kinds();
        let mut calls = self.interpreter(kernel)?.calls::<f32>()?;
        let stride = kernel.input_words() as usize;
        let count = inputs.len().checked_div(stride).unwrap_or(1);
        let mut results = Vec::with_capacity(count * kinds.len());
        for row in 0..count {
            let found = calls.call(&inputs[row * stride..(row + 1) * stride])?;
            results.extend(found.iter().zip(&kinds).map(|(slot, kind)| word_of(*slot, *kind)));
        }
        Ok(results)
    }

    fn dispatch(&mut self, dispatches: &[Dispatch<'_>]) -> Vec<DispatchResult> {
        dispatches.iter().map(evaluate).collect()
    }

    fn draw_frames(&self, drawing: &Drawing<'_>) -> Result<Vec<Frame>, Diagnostic> {
        raster::draw_frames(drawing, &raster::Evaluated::new(drawing)?)
    }
}

impl Cpu {
    fn interpreter(&mut self, kernel: &Kernel) -> Result<&Interpreter, Diagnostic> {
        if self.last.as_ref().is_none_or(|(id, _)| *id != kernel.id) {
            self.last = Some((kernel.id, Interpreter::new(kernel)?));
        }
        self.last
            .as_ref()
            .map(|(_, program)| program)
            .ok_or_else(|| Diagnostic::error(codes::EVAL_INTERNAL, "no program"))
    }
}
