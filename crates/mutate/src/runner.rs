//! Runs rows of a kernel on the evaluator, in f32.

use naga::ScalarKind;

use lamplight_diagnostic::Diagnostic;
use lamplight_execute::interpreter::{Interpreter, KernelCalls, word_of};
use lamplight_execute::kernel::Kernel;

/// Runs rows of a kernel in f32.
pub struct RowRunner<'p> {
    pub calls: KernelCalls<'p, f32>,
    kinds: Vec<ScalarKind>,
    stride: usize,
}

impl<'p> RowRunner<'p> {
    pub fn new(kernel: &Kernel, interpreter: &'p Interpreter) -> Result<Self, Diagnostic> {
        let mut calls = interpreter.calls::<f32>()?;
        calls.machine.loop_limit = super::suite::TRIPS;
        Ok(Self { calls, kinds: kernel.result_kinds(), stride: kernel.input_words() as usize })
    }

    /// Runs the rows. A function without parameters has one row.
    pub fn run(&mut self, inputs: &[u32]) -> Result<Vec<u32>, Diagnostic> {
        let mut results = Vec::new();
        let count = inputs.len().checked_div(self.stride).unwrap_or(1);
        for row in 0..count {
            let found = self.calls.call(&inputs[row * self.stride..(row + 1) * self.stride])?;
            results.extend(found.iter().zip(&self.kinds).map(|(slot, kind)| word_of(*slot, *kind)));
        }
        Ok(results)
    }
}
