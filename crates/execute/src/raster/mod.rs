//! Draws frames without a device: the stages run on the CPU, and this rasterizes the triangles.
//!
//! `corners (vertex stage) -> triangles (clipped) -> what each pixel shows -> quads (fragment stage)`
//!
//! The stages run on our own evaluator ([`evaluated`]) or as compiled MSL ([`metal`]). The fragment
//! stage runs in quads of 2 x 2 in lock-step, with other pixels as helper invocations. It runs only
//! for visible fragments, after the depth test of all triangles. If it discards fragments or writes
//! depth, it decides itself what is visible. Then it runs for all fragments, and each is tested
//! afterwards, in the order of the triangles.

mod corners;
mod evaluated;
mod metal;
mod shade;
mod triangles;
mod visibility;

use std::collections::BTreeMap;

use crate::fixture::{Fixture, FixtureTexture};
use crate::frame::{Buffers, DrawItem, Drawing, Frame, Mesh};
use crate::kernel::SENTINEL;
use corners::{Corner, ScalarSource};
pub use evaluated::Evaluated;
use lamplight_diagnostic::Diagnostic;
use lamplight_eval::{self as eval, Filter, MipLevel, Resources};
pub use metal::CompiledStages;
use triangles::{Triangle, VisibleTriangles};

/// What runs the two stages of a program.
pub trait Shading {
    /// Runs the vertex stage for every vertex of a mesh.
    fn corners(&self, mesh: &Mesh, resources: Resources) -> Result<Vec<Corner>, Diagnostic>;

    /// What each scalar in [`Corner::slots`] is, and whether it is flat: not interpolated.
    fn given(&self) -> Vec<(ScalarSource, bool)>;

    /// What each scalar is that the fragment stage takes; `None` if there is no fragment stage.
    fn taken(&self) -> Option<Vec<ScalarSource>>;

    /// Runs the fragment stage. `textures` has the textures and the samplers.
    fn shade(
        &self,
        buffers: Buffers,
        textures: &Resources,
        quads: &[Quad],
    ) -> Result<Vec<ShadedQuad>, Diagnostic>;
}

/// Four fragments of a triangle.
pub struct Quad {
    /// The scalars that the stage takes.
    pub arguments: [Vec<f32>; 4],
}

/// What the fragment stage returned for a quad; `None` where the fragment was discarded.
pub type ShadedQuad = [Option<FragmentOutput>; 4];

/// What the fragment stage returned for a fragment.
#[derive(Debug, Clone, PartialEq)]
pub struct FragmentOutput {
    /// Four words for each target.
    pub targets: Vec<[u32; 4]>,
    /// The depth, if the stage writes it.
    pub depth: Option<f32>,
}

/// Draws a frame for each view.
pub fn draw_frames(drawing: &Drawing<'_>, shading: &dyn Shading) -> Result<Vec<Frame>, Diagnostic> {
    let textures = bound_textures(drawing);
    drawing.views.iter().map(|view| draw_frame(drawing, view, shading, &textures)).collect()
}

/// What was drawn of a view, before shading.
struct DrawnView {
    /// The vertices of each item.
    corners: Vec<Vec<Corner>>,
    triangles: Vec<Triangle>,
    seen: VisibleTriangles,
}

fn draw_frame(
    drawing: &Drawing<'_>,
    view: &Buffers,
    shading: &dyn Shading,
    textures: &Resources,
) -> Result<Frame, Diagnostic> {
    let resources = |item: &DrawItem<'_>| Resources {
        buffers: item_buffers(drawing, view, item),
        ..textures.clone()
    };
    let mut drawn = DrawnView {
        corners: Vec::new(),
        triangles: Vec::new(),
        seen: VisibleTriangles::new(drawing.size),
    };
    for (index, item) in drawing.items.iter().enumerate() {
        let mut corners = shading.corners(item.mesh, resources(item))?;
        triangles::assemble_triangles(
            item.mesh,
            index,
            &mut corners,
            drawing.state,
            drawing.size,
            &mut drawn.triangles,
        );
        drawn.corners.push(corners);
    }
    let shader = shade::Shader { drawing, view, shading, textures };
    let (targets, depth) = match drawing.fragment {
        Some(stage) if visibility::is_decided_by(stage.module) => shader.shade_all(&drawn)?,
        _ => {
            drawn.seen.draw(&drawn.triangles, drawing.state);
            (shader.shade_visible(&drawn)?, drawn.seen.depth)
        }
    };
    let depth = if drawing.state.keep_depth { depth } else { Vec::new() };
    Ok(Frame { targets, depth, detour: None })
}

/// The uniform buffers of one item in one view.
fn item_buffers(
    drawing: &Drawing<'_>,
    view: &Buffers,
    item: &DrawItem<'_>,
) -> BTreeMap<(u32, u32), Vec<u8>> {
    let all = drawing.buffers.iter().chain(item.buffers).chain(view);
    all.map(|(place, bytes)| (*place, bytes.clone())).collect()
}

fn bound_textures(drawing: &Drawing<'_>) -> Resources {
    let mut resources = Resources::default();
    for (place, fixture) in drawing.fixtures {
        match &**fixture {
            Fixture::Texture(texture) => {
                let mut texture = eval::Texture::from(texture);
                let smaller = drawing.levels.get(place).map_or(&[][..], Vec::as_slice);
                texture.levels.extend(smaller.iter().flat_map(texture_levels));
                resources.textures.insert(*place, texture);
            }
            Fixture::Sampler(sampler) => {
                resources.samplers.insert(*place, with_levels(eval::Sampler::from(*sampler)));
            }
        }
    }
    resources
}

fn texture_levels(texture: &FixtureTexture) -> Vec<MipLevel> {
    eval::Texture::from(texture).levels
}

/// The sampler, with filtering between levels where a texture has levels.
fn with_levels(sampler: eval::Sampler) -> eval::Sampler {
    let linear = sampler.min == Filter::Linear && sampler.compare.is_none();
    eval::Sampler {
        mipmap: if linear { Filter::Linear } else { Filter::Nearest },
        levels: (0.0, 32.0),
        ..sampler
    }
}

/// A target with nothing drawn into it.
fn cleared_target([width, height]: [u32; 2]) -> Vec<u32> {
    vec![SENTINEL; 4 * width as usize * height as usize]
}
