//! Pictures: a scene drawn with permutations of the library's programs, in as many passes as the
//! last one needs.
//!
//! `preset or point -> plan -> passes (shadow map, blur, ...) -> prepared -> frames -> picture`
//!
//! Every pass is drawn by a [`Painter`]: a device, or the evaluator with a rasterizer of our own
//! ([`Rasterizer`]). What a pass drew comes back as numbers, exact to the bit, and goes into the
//! next as a texture, so that all painters share everything but the drawing itself.

pub mod gallery;
mod light;
mod mesh;
mod passes;
mod picture;
mod plan;
mod raster;
mod textures;
mod values;

pub use passes::{Prepared, prepare};
pub use picture::{Linear, Picture};
pub use plan::{PICTURES, Pass, Plan};
pub use raster::Rasterizer;

use std::sync::Arc;

use glam::DVec3;

use super::frame::{BACKENDS, Painter, Programs, Renderer};
use crate::compose::Language;
use crate::diagnostic::Diagnostics;
use crate::scene::{Equirect, Sky};

/// How a plan is photographed.
#[derive(Clone)]
pub struct Shot {
    /// Pixels from left to right, and from top to bottom.
    pub size: [u32; 2],
    /// Places in each pixel that are averaged, at least 1.
    pub samples: u32,
    /// Factor on all light, as a power of two.
    pub exposure: f64,
    /// Shadow maps of a directional light, one for each part of the viewer's depth; 1 for one map
    /// of the whole scene.
    pub cascades: u32,
    pub language: Language,
    /// What is around the scene.
    pub surroundings: Surroundings,
}

/// Radiance from every direction.
#[derive(Clone)]
pub enum Surroundings {
    Formula(fn(DVec3) -> DVec3),
    Image(Arc<Equirect>),
}

impl Surroundings {
    /// Radiance from a unit direction.
    pub fn radiance(&self, direction: DVec3) -> DVec3 {
        match self {
            Self::Formula(sky) => sky(direction),
            Self::Image(image) => image.radiance(direction),
        }
    }

    /// For functions that take a sky.
    pub fn with_sky<T>(&self, run: impl FnOnce(&Sky<'_>) -> T) -> T {
        run(&|direction| self.radiance(direction))
    }
}

/// What draws pictures: executors of this name, the CPU's own last.
pub fn painters() -> impl Iterator<Item = &'static str> {
    BACKENDS.iter().map(|(name, ..)| *name).chain([RASTERIZER])
}

/// Name of the evaluator as an executor.
pub const RASTERIZER: &str = "eval";

/// Opens a painter by name; the error says what to install. Open, use and drop it inside of
/// [`on_thread`](super::on_thread).
pub fn open(name: &str) -> Result<Box<dyn Painter>, String> {
    if name == RASTERIZER {
        return Ok(Box::new(Rasterizer));
    }
    Renderer::open(name).map(|renderer| Box::new(renderer) as Box<dyn Painter>)
}

/// Draws a plan.
///
/// # Errors
/// Those of compositions and of the painter.
pub fn render(painter: &dyn Painter, programs: &Programs, plan: &Plan, shot: &Shot) -> Result<Picture, Diagnostics> {
    let prepared = prepare(painter, programs, plan, shot)?;
    Ok(prepared.photograph(painter, shot)?.develop())
}
