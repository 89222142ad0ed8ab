//! Pictures: a scene drawn with permutations of the library's programs, in as many passes as the
//! last one needs.
//!
//! `preset or point -> plan -> passes (shadow map, blur, ...) -> prepared -> frames -> picture`
//!
//! Every pass is drawn by an executor, which may be a device or the evaluator. The result of a pass
//! comes back as numbers, exact to the bit, and is a texture for the next pass. So all executors
//! share everything but the drawing itself. An executor draws on a device through wgpu, or with our
//! own rasterizer, which runs the evaluator.
//!
//! # How pictures are drawn
//!
//! - Colour attachments hold the bits of floats as integers, since no float format is renderable on
//!   every device.
//! - Integers cannot be resolved by multisampling. So each sample of a pixel is a separate frame,
//!   moved by a part of a pixel. A pass that reads what the viewer saw in an earlier pass must read
//!   it at the same point of the scene, so its samples are not moved. Such pictures are drawn up to
//!   three times finer instead, and their pixels are averaged.
//! - The pipeline does polygon offset, culling and the mirroring of cube faces.
//! - Uniforms are packed by reflection. Their values come from the preset, or else from the scene.
//! - The mips of moment maps are computed after the blur.
//! - With the axis `cascades`, the parts of a shadow map are drawn one by one and put together
//!   (`crates/picture/src/cascades.rs`). With the option `--cascades`, each cascade is a separate
//!   frame with its own shadow map, clipped to its part of the depth. Where several of these cover
//!   a pixel, the nearest one counts.
//! - With `ambient=ddgi`, the host fills the probes before the pass that reads them: the lamps of
//!   the scene, and three bounces between its objects.
//!
//! The small pictures in `tests/render/reviewed/` were reviewed by eye. `tests/render.rs` draws and
//! compares them, and leaves a picture of each difference in `target/tmp/render/`. The repository's
//! page of the gallery shows them too. The large pictures are drawn by the site's build. The
//! comparisons in `docs/gallery/compared/` are kept as they are drawn. `adapters.txt` has a hash of the
//! settings and composed texts of each, and a test compares it with that of now.
//!
//! A comparison (`shaderlib/comparisons.toml`) has several panels side by side. A panel shows a
//! permutation, or an expression over the library's functions that is computed for every pixel
//! (`crates/picture/src/strip/`).

pub mod beside;
mod blend;
mod controls;
pub mod figure;
pub mod frame;
pub mod gallery;
mod heat;
mod lamps;
mod light;
mod mesh;
pub mod needs;
pub mod own;
mod passes;
mod pixels;
mod plan;
mod prepared;
mod probes;
pub mod sketch;
pub mod strip;
pub mod terminal;
mod textures;
mod values;

pub use controls::{Controls, LampControl, Uniform, picture_controls};
pub use heat::{HeatMap, Scale, short as short_number};
pub use needs::Needs;
pub use passes::prepare_passes;
pub use pixels::{Linear, Picture, is_own_png};
pub use plan::{Changes, Pass, Plan};
pub use prepared::{PictureFragment, PreparedPass};

use std::sync::Arc;

use glam::DVec3;

use frame::Programs;
use lamplight_bundle::Language;
use lamplight_diagnostic::Diagnostics;
use lamplight_execute::Session;
use lamplight_scene::{Equirect, Sky};
use lamplight_scenes::environment;
use lamplight_scenes::sets::Scene;

/// The name of the environment that most scenes have around them.
const STUDIO: &str = "studio";

/// How a picture of a plan is taken.
#[derive(Clone)]
pub struct Shot {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples per pixel, at least 1.
    pub samples: u32,
    /// In stops: all light is multiplied by 2 to this power.
    pub exposure: f64,
    /// How many shadow maps a directional light has, one for each part of the viewer's depth; 1 for
    /// one map of the whole scene.
    pub cascades: u32,
    pub language: Language,
    /// What is around the scene.
    pub surroundings: Surroundings,
}

/// The radiance from every direction.
#[derive(Clone)]
pub enum Surroundings {
    /// Those that the scene has, or else the studio.
    Usual,
    Formula(fn(DVec3) -> DVec3),
    Image(Arc<Equirect>),
}

impl Surroundings {
    /// Those of that name; `None` if there are none.
    pub fn named(name: &str) -> Option<Self> {
        environment(name).map(Self::Formula)
    }

    /// What is around a scene: for [`Self::Usual`] what the scene itself chooses, or else these.
    fn around_scene(&self, scene: &Scene) -> Self {
        match self {
            Self::Usual => {
                environment(scene.around.unwrap_or(STUDIO)).map_or(Self::Usual, Self::Formula)
            }
            chosen => chosen.clone(),
        }
    }

    /// Radiance from a unit direction.
    pub fn radiance(&self, direction: DVec3) -> DVec3 {
        match self {
            Self::Usual => environment(STUDIO).map_or(DVec3::ZERO, |sky| sky(direction)),
            Self::Formula(sky) => sky(direction),
            Self::Image(image) => image.radiance(direction),
        }
    }

    /// Calls a function with these surroundings as a sky.
    pub fn with_sky<T>(&self, run: impl FnOnce(&Sky<'_>) -> T) -> T {
        run(&|direction| self.radiance(direction))
    }
}

/// Draws a plan.
///
/// # Errors
/// Those of compositions and of the painter.
pub fn render_plan(
    painter: &dyn Session,
    programs: &Programs,
    plan: &Plan,
    shot: &Shot,
) -> Result<Picture, Diagnostics> {
    let prepared = prepare_passes(painter, programs, plan, shot)?;
    Ok(prepared.photograph(painter, shot)?.develop())
}
