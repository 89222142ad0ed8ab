//! Frames without a device: our own interpreter runs the stages, and this draws the triangles.
//!
//! `corners (vertex stage) -> triangles (clipped) -> what each pixel shows -> quads (fragment stage)`
//!
//! The fragment stage runs for what is visible alone, in quads of 2 x 2 in step, their hidden
//! fragments as helpers: programs that discard or write depth are not what it is for.

mod corners;
mod shade;
mod triangles;

use std::collections::BTreeMap;

use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};

use super::super::interpreter::failed;
use crate::diagnostic::{Diagnostic, codes};
use crate::eval::{self, Filter, FunctionId, Level, Program, Resources};
use crate::harness::fixture::{Fixture, Texture};
use crate::harness::frame::{Buffers, Drawing, Frame, Item, Painter, Stage};
use crate::harness::kernel::SENTINEL;
use corners::Corner;
use triangles::{Seen, Triangle};

/// Draws with the evaluator, in f32 rounded to nearest, on all cores.
pub struct Rasterizer;

impl Painter for Rasterizer {
    fn adapter(&self) -> String {
        "lamplight eval, f32".to_owned()
    }

    fn draw(&self, drawing: &Drawing<'_>) -> Result<Vec<Frame>, Diagnostic> {
        let vertex = Lowered::new(drawing.vertex)?;
        let fragment = drawing.fragment.map(Lowered::new).transpose()?;
        let textures = textures(drawing);
        drawing.views.iter().map(|view| frame(drawing, view, &vertex, fragment.as_ref(), &textures)).collect()
    }
}

/// A stage, ready to run.
struct Lowered {
    program: Program,
    function: FunctionId,
}

impl Lowered {
    fn new(stage: Stage<'_>) -> Result<Self, Diagnostic> {
        let info: ModuleInfo = Validator::new(ValidationFlags::all(), Capabilities::all())
            .validate(stage.module)
            .map_err(|error| Diagnostic::error(codes::EXECUTOR_FAILED, format!("the program is not valid: {error}")))?;
        let program = Program::new(stage.module, &info).map_err(failed)?;
        // GLSL has a plain function of that name too; entry points come after functions.
        let found = program.functions().filter(|(_, function)| function.name == stage.entry).last().map(|(id, _)| id);
        let missing = || Diagnostic::error(codes::EXECUTOR_FAILED, format!("the program has no entry point `{}`", stage.entry));
        Ok(Self { function: found.ok_or_else(missing)?, program })
    }
}

/// What was drawn of a view, before it is shaded.
struct Drawn {
    /// Of each item.
    corners: Vec<Vec<Corner>>,
    triangles: Vec<Triangle>,
    seen: Seen,
}

fn frame(
    drawing: &Drawing<'_>,
    view: &Buffers,
    vertex: &Lowered,
    fragment: Option<&Lowered>,
    textures: &Resources,
) -> Result<Frame, Diagnostic> {
    let resources = |item: &Item<'_>| Resources { buffers: buffers(drawing, view, item), ..textures.clone() };
    let mut drawn = Drawn { corners: Vec::new(), triangles: Vec::new(), seen: Seen::new(drawing.size) };
    for (index, item) in drawing.items.iter().enumerate() {
        let mut corners = corners::run(vertex, item.mesh, resources(item))?;
        triangles::assemble(item.mesh, index, &mut corners, drawing.state, drawing.size, &mut drawn.triangles);
        drawn.corners.push(corners);
    }
    drawn.seen.draw(&drawn.triangles, drawing.state);
    let targets = match fragment {
        Some(fragment) => shade::run(drawing, view, vertex, fragment, &drawn, textures)?,
        None => Vec::new(),
    };
    let depth = if drawing.state.keep_depth { drawn.seen.depth } else { Vec::new() };
    Ok(Frame { targets, depth, detour: None })
}

/// The uniform buffers of one item in one view.
fn buffers(drawing: &Drawing<'_>, view: &Buffers, item: &Item<'_>) -> BTreeMap<(u32, u32), Vec<u8>> {
    let all = drawing.buffers.iter().chain(item.buffers).chain(view);
    all.map(|(place, bytes)| (*place, bytes.clone())).collect()
}

fn textures(drawing: &Drawing<'_>) -> Resources {
    let mut resources = Resources::default();
    for (place, fixture) in drawing.fixtures {
        match &**fixture {
            Fixture::Texture(texture) => {
                let mut texture = eval::Texture::from(texture);
                let smaller = drawing.levels.get(place).map_or(&[][..], Vec::as_slice);
                texture.levels.extend(smaller.iter().flat_map(levels));
                resources.textures.insert(*place, texture);
            }
            Fixture::Sampler(sampler) => drop(resources.samplers.insert(*place, mipped(eval::Sampler::from(*sampler)))),
        }
    }
    resources
}

fn levels(texture: &Texture) -> Vec<Level> {
    eval::Texture::from(texture).levels
}

/// Between levels, where a texture has them.
fn mipped(sampler: eval::Sampler) -> eval::Sampler {
    let linear = sampler.min == Filter::Linear && sampler.compare.is_none();
    eval::Sampler { mipmap: if linear { Filter::Linear } else { Filter::Nearest }, levels: (0.0, 32.0), ..sampler }
}

/// A target that nothing has been drawn to.
fn cleared([width, height]: [u32; 2]) -> Vec<u32> {
    vec![SENTINEL; 4 * width as usize * height as usize]
}
