//! Whole programs, drawn without a window: uniforms packed by reflection, meshes, frames, and
//! what each fragment was given.
//!
//! `reflection + values -> buffers`, `module + mesh + buffers + fixtures -> frame`
//!
//! A frame's target holds words ([`TARGET_WIDTH`](super::kernel::TARGET_WIDTH) pixels wide, four
//! words a pixel), so that results are exact to the bit on every backend: [`probe`] rewrites a
//! fragment entry point to give the bits of its colour, or of its own inputs.

mod pack;
pub mod probe;

pub use super::gpu::draw::{Attribute, Drawing, Mesh};
pub use pack::pack;

use super::executors::Unavailable;
use super::gpu::{self, Gpu};
use crate::diagnostic::Diagnostic;

/// Executors that draw frames.
pub const BACKENDS: &[(&str, wgpu::Backends)] = &[("vulkan", wgpu::Backends::VULKAN), ("gl", wgpu::Backends::GL)];

/// An open device that draws frames. Open, use and drop it inside of [`super::on_thread`].
pub struct Renderer(Gpu);

impl Renderer {
    /// Opens one of [`BACKENDS`].
    pub fn open(name: &str) -> Result<Self, Unavailable> {
        let backend = BACKENDS.iter().find(|(known, _)| *known == name).map(|(_, backend)| *backend);
        let backend = backend.ok_or_else(|| Unavailable { reason: format!("`{name}` draws no frames") })?;
        gpu::open(backend).map(Self).map_err(|reason| Unavailable { reason })
    }

    /// The words of the target, four a pixel, row by row from the top; pixels that nothing
    /// covers hold [`SENTINEL`](super::kernel::SENTINEL).
    ///
    /// # Errors
    /// The device's, and those of shaders it refuses.
    pub fn draw(&self, drawing: &Drawing<'_>) -> Result<Vec<u32>, Diagnostic> {
        self.0.draw_mesh(drawing)
    }
}
