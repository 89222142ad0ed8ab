//! Whole programs, drawn without a window: uniforms packed by reflection, meshes, frames, and
//! what each fragment was given.
//!
//! `reflection + values -> buffers`, `stages + mesh + buffers + fixtures -> frame`
//!
//! A frame's targets hold words, four a pixel, so that results are exact to the bit on every
//! backend: [`probe`] rewrites a fragment entry point to give the bits of its colour and of its
//! own inputs.

mod pack;
pub mod probe;
mod programs;

pub use super::gpu::draw::{Attribute, Buffers, Drawing, Frame, Item, Mesh, Side, Stage, State};
pub use pack::pack;
pub use programs::{Composed, Programs, Stages};

use super::Session as _;
use super::executors::{self, Unavailable, swiftshader};
use super::gpu::{self, Gpu, Named, Shaders, Wanted};
use crate::diagnostic::Diagnostic;

/// Executors that draw frames on a device.
pub const BACKENDS: &[(&str, wgpu::Backends, Named)] = &[
    ("vulkan", wgpu::Backends::VULKAN, Named::Without(swiftshader::NAME)),
    ("gl", wgpu::Backends::GL, Named::Without(swiftshader::NAME)),
    ("swiftshader", wgpu::Backends::VULKAN, Named::With(swiftshader::NAME)),
];

/// Whatever draws frames.
pub trait Painter {
    /// Its name, driver and version: what a picture carries.
    fn adapter(&self) -> String;

    /// Draws a frame for each view.
    ///
    /// # Errors
    /// The device's, and those of shaders it refuses.
    fn draw(&self, drawing: &Drawing<'_>) -> Result<Vec<Frame>, Diagnostic>;
}

/// An open device that draws frames. Open, use and drop it inside of [`super::on_thread`].
pub struct Renderer(Gpu);

impl Renderer {
    /// Opens one of [`BACKENDS`]; the error says what to install.
    pub fn open(name: &str) -> Result<Self, String> {
        let backend = BACKENDS.iter().find(|(known, ..)| *known == name);
        let ((_, backend, named), entry) = backend.zip(executors::find(name)).ok_or_else(|| format!("`{name}` draws no frames"))?;
        if matches!(named, Named::With(_)) {
            swiftshader::announce();
        }
        let wanted = Wanted { backend: *backend, named: *named, shaders: Shaders::Translated };
        gpu::open(wanted).map(Self).map_err(|reason| entry.missing(&Unavailable { reason }))
    }
}

impl Painter for Renderer {
    fn adapter(&self) -> String {
        self.0.adapter()
    }

    fn draw(&self, drawing: &Drawing<'_>) -> Result<Vec<Frame>, Diagnostic> {
        self.0.draw_frames(drawing)
    }
}
