//! Where shaders run: kernels and fixtures, and the executors that take them.
//!
//! `function -> kernel + fixtures -> session of an executor -> result words`
//!
//! [`kernel`] wraps a function into a fragment shader, an executor of [`executors`] runs it over
//! rows of arguments; [`fixture`] is what textures and samplers hold. Devices of wgpu are in
//! `gpu`; the evaluator runs kernels in `interpreter`, compiled MSL in `metal`, and both draw
//! [`frame`]s in [`raster`]. Pages of a browser are in [`web`]. Frames are drawn from the
//! bytes of a bundle too: [`shipped`]. Compute entry points run over the bytes of buffers:
//! [`dispatch`]. MSL runs as a program of this machine: [`compiled`].

pub mod compiled;
pub mod dispatch;
pub mod emitted;
pub mod executors;
pub mod fixture;
pub mod frame;
#[cfg(not(target_family = "wasm"))]
pub mod gpu;
pub mod interpreter;
pub mod kernel;
#[cfg(not(target_family = "wasm"))]
mod metal;
pub mod raster;
pub mod sampling;
pub mod shipped;
#[cfg(not(target_family = "wasm"))]
mod source;
#[cfg(not(target_family = "wasm"))]
pub mod web;
#[cfg(not(target_family = "wasm"))]
pub mod written;

use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};

use dispatch::{Dispatch, DispatchResult};
use frame::{Drawing, Frame};
use kernel::Kernel;
use lamplight_diagnostic::{Diagnostic, codes};
use shipped::Shipped;

/// Stack of a thread that compiles shaders: naga recurses along expressions.
pub const STACK: usize = 64 << 20;

/// Runs a closure on a thread of its own and waits until that thread is gone.
///
/// Open, use and drop sessions inside: the stack is large enough for naga, and the drivers'
/// thread-local state is torn down before the process ends, which Mesa crashes without.
/// `None` if the closure panicked or no thread could be started.
pub fn on_thread<T: Send>(run: impl FnOnce() -> T + Send) -> Option<T> {
    std::thread::scope(|scope| {
        std::thread::Builder::new().stack_size(STACK).spawn_scoped(scope, run).ok()?.join().ok()
    })
}

/// An open executor. It runs kernels and draws frames until it is dropped.
pub trait Session: Send {
    /// The device's name, driver and version, which are recorded with golden values.
    fn adapter(&self) -> String;

    /// Called with all kernels before the first one runs. An executor that compiles many at once
    /// does it here.
    fn prepare(&mut self, _: &[&Kernel]) {}

    /// Runs the kernel once for each row of argument words in `inputs`; returns the result words.
    ///
    /// Errors are about the executor and never about the function: a rejected shader, a lost
    /// device, a target that was not written as intended.
    fn run(&mut self, kernel: &Kernel, inputs: &[u32]) -> Result<Vec<u32>, Diagnostic>;

    /// Draws a frame for each view. Only executors whose entry has `samples` draw; the others
    /// refuse.
    ///
    /// # Errors
    /// The device's, and those of shaders it refuses.
    fn draw_frames(&self, _: &Drawing<'_>) -> Result<Vec<Frame>, Diagnostic> {
        Err(draws_none())
    }

    /// Draws with shipped stages instead of those that the drawing names. Targets hold the bits of
    /// what the fragment stage returns at each of its locations. Only executors from
    /// [`executors::shipping`] can do so; the others refuse.
    ///
    /// # Errors
    /// Those of [`Self::draw_frames`]; `executor-lacks` for a stage that cannot be drawn on this
    /// executor.
    fn draw_shipped(&self, _: ShippedPair<'_>, _: &Drawing<'_>) -> Result<Vec<Frame>, Diagnostic> {
        Err(draws_none())
    }

    /// Runs compute entry points, each of them by itself. Executors whose entry has `compute` do
    /// so, and compile all of them together where that takes less time; the others refuse.
    fn dispatch(&mut self, dispatches: &[Dispatch<'_>]) -> Vec<DispatchResult> {
        dispatches.iter().map(|_| Err(computes_none())).collect()
    }
}

/// A vertex and a fragment stage.
#[derive(Debug, Clone, Copy)]
pub struct ShippedPair<'a> {
    pub vertex: &'a Shipped,
    pub fragment: &'a Shipped,
}

/// What went wrong with an executor, which is no mistake of a function.
fn executor_failed(message: impl Into<String>) -> Diagnostic {
    Diagnostic::error(codes::EXECUTOR_FAILED, message)
}

/// Validates a module for an executor; returns naga's analysis. `what` names the module in errors.
pub fn module_info(what: &str, module: &naga::Module) -> Result<ModuleInfo, Diagnostic> {
    let validated = Validator::new(ValidationFlags::all(), Capabilities::all()).validate(module);
    validated.map_err(|error| executor_failed(format!("the {what} is not valid: {error}")))
}

fn computes_none() -> Diagnostic {
    Diagnostic::error(codes::EXECUTOR_LACKS, "this executor has no compute stage")
}

fn draws_none() -> Diagnostic {
    executor_failed("this executor draws no frames")
}
