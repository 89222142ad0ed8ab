//! Numeric proof: cases, executors, reports.

pub mod cases;
pub mod check;
pub mod executors;
pub mod fixture;
pub mod formula;
mod gpu;
pub mod kernel;
pub mod laws;
pub mod references;
pub mod tolerance;

use crate::diagnostic::Diagnostic;
use kernel::Kernel;

/// An open executor: runs kernels until it is dropped.
pub trait Session: Send {
    /// The device's name, driver and version: what a golden value carries.
    fn adapter(&self) -> String;

    /// The result words of every invocation whose argument words are given one after another.
    ///
    /// Errors are the executor's, never the function's: rejected shaders, lost devices, targets
    /// that were not written as laid out.
    fn run(&mut self, kernel: &Kernel, inputs: &[u32]) -> Result<Vec<u32>, Diagnostic>;
}
