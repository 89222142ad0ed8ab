//! Whole programs, drawn without a window: uniforms packed by reflection, meshes, frames, and
//! what each fragment was given.
//!
//! `reflection + values -> buffers`, `stages + mesh + buffers + fixtures -> frame`
//!
//! A frame's targets hold words ([`TARGET_WIDTH`](super::kernel::TARGET_WIDTH) pixels wide, four
//! words a pixel), so that results are exact to the bit on every backend: [`probe`] rewrites a
//! fragment entry point to give the bits of its colour and of its own inputs.

mod pack;
pub mod probe;

pub use super::gpu::draw::{Attribute, Drawing, Frame, Mesh, Stage};
pub use pack::pack;

use super::executors::{self, Unavailable, swiftshader};
use super::gpu::{self, Gpu, Named, Shaders, Wanted};
use crate::diagnostic::Diagnostic;

/// Executors that draw frames.
pub const BACKENDS: &[(&str, wgpu::Backends)] = &[("vulkan", wgpu::Backends::VULKAN), ("gl", wgpu::Backends::GL)];

/// An open device that draws frames. Open, use and drop it inside of [`super::on_thread`].
pub struct Renderer(Gpu);

impl Renderer {
    /// Opens one of [`BACKENDS`]; the error says what to install.
    pub fn open(name: &str) -> Result<Self, String> {
        let backend = BACKENDS.iter().find(|(known, _)| *known == name).map(|(_, backend)| *backend);
        let (backend, entry) = backend.zip(executors::find(name)).ok_or_else(|| format!("`{name}` draws no frames"))?;
        let wanted = Wanted { backend, named: Named::Without(swiftshader::NAME), shaders: Shaders::Translated };
        gpu::open(wanted).map(Self).map_err(|reason| entry.missing(&Unavailable { reason }))
    }

    /// Draws one frame.
    ///
    /// # Errors
    /// The device's, and those of shaders it refuses.
    pub fn draw(&self, drawing: &Drawing<'_>) -> Result<Frame, Diagnostic> {
        self.0.draw_mesh(drawing)
    }
}
