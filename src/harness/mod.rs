//! Numeric proof: cases, executors, reports.
//!
//! `cases + modules -> jobs (kernels, rows, expected values) -> results -> verdicts -> report`
//!
//! [`cases`] reads what to try, [`library`] composes the modules, [`kernel`] wraps each function
//! into a fragment shader, an executor of [`executors`] runs it, [`references`] says what should
//! come out, [`tolerance`] how far off it may be, and [`check`] compares. [`expression`] runs one
//! expression instead of cases, [`plots`] draws functions for the [`catalogue`], [`mutate`] asks
//! how much the cases notice, [`frame`] draws whole
//! programs, and [`render`] whole pictures.

pub mod cases;
pub mod catalogue;
pub mod check;
pub mod executors;
pub mod expression;
pub mod fixture;
pub mod formula;
pub mod frame;
mod gpu;
mod interpreter;
pub mod kernel;
pub mod laws;
pub mod library;
pub mod mutate;
pub mod plots;
pub mod ratchet;
pub mod references;
pub mod render;
mod sampling;
pub mod tolerance;

use crate::diagnostic::Diagnostic;
use kernel::Kernel;

/// Stack of a thread that compiles shaders: naga recurses along expressions.
const STACK: usize = 64 << 20;

/// Runs a closure on a thread of its own and waits until that thread is gone.
///
/// Open, use and drop sessions inside: the stack is large enough for naga, and the drivers'
/// thread-local state is torn down before the process ends, which Mesa crashes without.
/// `None` if the closure panicked or no thread could be started.
pub fn on_thread<T: Send>(run: impl FnOnce() -> T + Send) -> Option<T> {
    std::thread::scope(|scope| std::thread::Builder::new().stack_size(STACK).spawn_scoped(scope, run).ok()?.join().ok())
}

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
