//! Draws frames without a device: the stages run on the CPU, and this rasterizes the triangles.
//!
//! `corners (vertex stage) -> triangles (clipped) -> what each pixel shows -> quads (fragment stage)`
//!
//! The stages run on our own evaluator ([`evaluated`]) or as compiled MSL ([`metal`]). The fragment
//! stage runs in quads of 2 x 2 in lock-step, with other pixels as helper invocations. It runs only
//! for visible fragments, after the depth test of all triangles. If it discards fragments or writes
//! depth, it decides itself what is visible. Then it runs for all fragments, and each is tested
//! afterwards, in the order of the triangles.

mod evaluated;
mod measured;
mod metal;
mod pixel;
mod triangles;

use crate::fixture::{Fixture, FixtureTexture};
use crate::frame::{Buffers, DrawItem, Drawing, Frame, Mesh};
use crate::kernel::SENTINEL;
pub use evaluated::Evaluated;
use lamplight_diagnostic::Diagnostic;
use lamplight_eval as eval;
use lamplight_eval::{Filter, MipLevel, Number, Resources};
use lamplight_validate::inner_blocks;
pub use measured::{Measure, Measured, Measuring};
pub use metal::CompiledStages;
use naga::{Binding, Block, BuiltIn, FunctionResult, Module, ShaderStage, Statement, TypeInner};
pub use pixel::{PixelFragment, VisibleFragments, VisibleQuad, fragments_at, visible_fragments};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::ops::Range;
use triangles::{NONE, Triangle, VisibleTriangles};

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
    let mut drawn = assembled(drawing, view, shading, textures)?;
    let shader = Shader { drawing, view, shading, textures };
    let (targets, depth) = match drawing.fragment {
        Some(stage) if is_decided_by(stage.module) => shader.shade_all(&drawn)?,
        _ => {
            drawn.seen.draw(&drawn.triangles, drawing.state);
            (shader.shade_visible(&drawn)?, drawn.seen.depth)
        }
    };
    let depth = if drawing.state.keep_depth { depth } else { Vec::new() };
    Ok(Frame { targets, depth, detour: None })
}

/// Runs the vertex stage and places all triangles. Nothing is visible yet.
fn assembled(
    drawing: &Drawing<'_>,
    view: &Buffers,
    shading: &dyn Shading,
    textures: &Resources,
) -> Result<DrawnView, Diagnostic> {
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
    Ok(drawn)
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

/// A vertex after the vertex stage, or one that clipping made on an edge.
#[derive(Debug, Clone)]
pub struct Corner {
    pub clip: [f64; 4],
    /// Every scalar that the stage returns.
    pub slots: Vec<f32>,
}

/// What the binding of a stage's input or output says about one of its scalars.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ScalarSource {
    /// A component of what is at a location.
    Location(u32, usize),
    BuiltIn(BuiltIn, usize),
    None,
}

/// The source of each scalar, from the bindings of all scalars.
pub fn scalar_sources(bindings: &[Option<Binding>]) -> Vec<ScalarSource> {
    let mut sources: Vec<ScalarSource> = Vec::with_capacity(bindings.len());
    for binding in bindings {
        let source = |component| match binding {
            Some(Binding::Location { location, .. }) => {
                ScalarSource::Location(*location, component)
            }
            Some(Binding::BuiltIn(built_in)) => ScalarSource::BuiltIn(*built_in, component),
            None => ScalarSource::None,
        };
        let first = source(0);
        // The scalars of one vector follow each other.
        let component =
            sources.iter().rev().take_while(|earlier| same_source(**earlier, first)).count();
        sources.push(source(component));
    }
    sources
}

fn same_source(a: ScalarSource, b: ScalarSource) -> bool {
    match (a, b) {
        (ScalarSource::Location(a, _), ScalarSource::Location(b, _)) => a == b,
        (ScalarSource::BuiltIn(a, _), ScalarSource::BuiltIn(b, _)) => a == b,
        _ => false,
    }
}

/// A component of a vertex attribute; 0 where the mesh has no such attribute.
pub fn vertex_attribute(mesh: &Mesh, vertex: u32, location: u32, component: usize) -> u32 {
    let sizes = mesh.attributes.iter().map(|attribute| attribute.format.words() as usize);
    let mut first = vertex as usize * sizes.clone().sum::<usize>();
    for (attribute, size) in mesh.attributes.iter().zip(sizes) {
        if attribute.location == location && component < size {
            return mesh.words.get(first + component).copied().unwrap_or(0);
        }
        first += size;
    }
    0
}

/// How many quads are shaded at a time. This bounds the memory for the arguments of large frames.
const AT_ONCE: usize = 1 << 16;

/// Shades the fragments of a frame.
struct Shader<'a> {
    pub drawing: &'a Drawing<'a>,
    pub view: &'a Buffers,
    pub shading: &'a dyn Shading,
    /// The textures and the samplers.
    pub textures: &'a Resources,
}

/// The words of each target of a frame.
type Targets = Vec<Vec<u32>>;

impl Shader<'_> {
    /// The targets of a frame of which is known what each pixel shows.
    pub fn shade_visible(&self, drawn: &DrawnView) -> Result<Targets, Diagnostic> {
        let Some(screen) = self.screen(drawn) else { return Ok(Vec::new()) };
        let mut targets = self.cleared();
        for (item, places) in screen.visible(self.drawing.items.len()).into_iter().enumerate() {
            self.shade(&screen, item, places.into_iter(), |_, pixel, output| {
                store_output(&mut targets, self.index(pixel), output);
            })?;
        }
        Ok(targets)
    }

    /// The targets of a frame whose fragments are tested after they are shaded, and the depth of
    /// each pixel.
    pub fn shade_all(&self, drawn: &DrawnView) -> Result<(Targets, Vec<f32>), Diagnostic> {
        let mut depths = drawn.seen.depth.clone();
        let Some(screen) = self.screen(drawn) else { return Ok((Vec::new(), depths)) };
        let (mut targets, state) = (self.cleared(), self.drawing.state);
        for of_item in drawn.triangles.chunk_by(|one, next| one.item == next.item) {
            let places = of_item.iter().flat_map(|triangle| screen.covered(triangle));
            self.shade(&screen, of_item[0].item, places, |triangle, (x, y), output| {
                let own = || triangle.depth(middle(x), middle(y), triangle.offset(state.offset));
                let depth = output.depth.map_or_else(own, |depth| depth.clamp(0.0, 1.0));
                let index = self.index((x, y));
                if !state.depth_test || depth < depths[index] {
                    depths[index] = depth;
                    store_output(&mut targets, index, output);
                }
            })?;
        }
        Ok((targets, depths))
    }

    /// `None` if there is no fragment stage.
    fn screen<'d>(&self, drawn: &'d DrawnView) -> Option<Screen<'d>> {
        let wiring = wire_stages(&self.shading.given(), &self.shading.taken()?);
        Some(Screen { drawn, size: self.drawing.size, wiring })
    }

    fn cleared(&self) -> Targets {
        vec![cleared_target(self.drawing.size); self.drawing.targets as usize]
    }

    /// Shades quads of one item in order. Calls `store` for each covered pixel whose fragment was
    /// not discarded.
    fn shade<'d>(
        &self,
        screen: &Screen<'_>,
        item: usize,
        mut places: impl Iterator<Item = CoveredQuad<'d>>,
        mut store: impl FnMut(&Triangle, (u32, u32), &FragmentOutput),
    ) -> Result<(), Diagnostic> {
        loop {
            let some: Vec<CoveredQuad<'_>> = places.by_ref().take(AT_ONCE).collect();
            if some.is_empty() {
                return Ok(());
            }
            let quads: Vec<Quad> = some.par_iter().map(|place| screen.quad(place)).collect();
            let buffers = item_buffers(self.drawing, self.view, &self.drawing.items[item]);
            let shaded = self.shading.shade(buffers, self.textures, &quads)?;
            for (place, shaded) in some.iter().zip(&shaded) {
                for lane in (0..4).filter(|lane| place.covered[*lane]) {
                    if let Some(output) = &shaded[lane] {
                        store(place.triangle, place.pixels[lane], output);
                    }
                }
            }
        }
    }

    fn index(&self, (x, y): (u32, u32)) -> usize {
        (y * self.drawing.size[0] + x) as usize
    }
}

/// The source of a scalar of the fragment stage.
#[derive(Debug, Clone, Copy)]
enum ScalarInput {
    /// A slot of the vertices, interpolated with correct perspective.
    Smooth(usize),
    /// A slot of the first vertex.
    Flat(usize),
    Position(usize),
    Front,
    Nothing,
}

fn wire_stages(given: &[(ScalarSource, bool)], taken: &[ScalarSource]) -> Vec<ScalarInput> {
    let wire = |source: &ScalarSource| match source {
        ScalarSource::Location(..) => match given.iter().position(|(other, _)| other == source) {
            Some(slot) if given[slot].1 => ScalarInput::Flat(slot),
            Some(slot) => ScalarInput::Smooth(slot),
            None => ScalarInput::Nothing,
        },
        ScalarSource::BuiltIn(BuiltIn::Position { .. }, component) => {
            ScalarInput::Position(*component)
        }
        ScalarSource::BuiltIn(BuiltIn::FrontFacing, _) => ScalarInput::Front,
        _ => ScalarInput::Nothing,
    };
    taken.iter().map(wire).collect()
}

/// What is visible, and how to look it up.
struct Screen<'a> {
    drawn: &'a DrawnView,
    size: [u32; 2],
    wiring: Vec<ScalarInput>,
}

/// A quad in which at least one pixel is drawn with the triangle.
struct CoveredQuad<'a> {
    triangle: &'a Triangle,
    pixels: [(u32, u32); 4],
    /// Which of them are. The others are helper invocations.
    covered: [bool; 4],
}

impl<'a> Screen<'a> {
    /// The quads of each item. Four pixels that show several triangles are one quad for each of
    /// these.
    fn visible(&self, items: usize) -> Vec<Vec<CoveredQuad<'a>>> {
        let mut places: Vec<Vec<CoveredQuad<'a>>> = Vec::new();
        places.resize_with(items, Vec::new);
        let [columns, rows] = self.size.map(|size| (0..size).step_by(2));
        for (x, y) in rows.flat_map(|y| columns.clone().map(move |x| (x, y))) {
            let pixels = quad_pixels(x, y);
            let shown = pixels.map(|(x, y)| self.shown(x, y));
            for lane in 0..4 {
                let id = shown[lane];
                let Some(triangle) = self.drawn.triangles.get(id as usize) else { continue };
                if shown[..lane].contains(&id) {
                    continue;
                }
                let covered = shown.map(|other| other == id);
                places[triangle.item].push(CoveredQuad { triangle, pixels, covered });
            }
        }
        places
    }

    /// All quads of a triangle, visible or not.
    fn covered(&self, triangle: &'a Triangle) -> impl Iterator<Item = CoveredQuad<'a>> {
        let [width, height] = self.size;
        let [columns, rows] = triangle.bounds(self.size);
        let even = |range: Range<u32>| (range.start & !1..range.end).step_by(2);
        let corners = even(rows).flat_map(move |y| even(columns.clone()).map(move |x| (x, y)));
        corners.filter_map(move |(x, y)| {
            let pixels = quad_pixels(x, y);
            let covered = pixels
                .map(|(x, y)| x < width && y < height && triangle.covers(middle(x), middle(y)));
            covered.contains(&true).then_some(CoveredQuad { triangle, pixels, covered })
        })
    }

    fn quad(&self, place: &CoveredQuad<'_>) -> Quad {
        let arguments =
            place.pixels.map(|(x, y)| self.arguments(place.triangle, middle(x), middle(y)));
        Quad { arguments }
    }

    fn shown(&self, x: u32, y: u32) -> u32 {
        let inside = x < self.size[0] && y < self.size[1];
        if inside { self.drawn.seen.triangle[(y * self.size[0] + x) as usize] } else { NONE }
    }

    fn arguments(&self, triangle: &Triangle, x: f64, y: f64) -> Vec<f32> {
        let (shares, depth, inverse_w) = triangle.at(x, y);
        let corners = &self.drawn.corners[triangle.item];
        let slot = |corner: u32, slot: usize| corners[corner as usize].slots[slot];
        let argument = |wire: &ScalarInput| match wire {
            ScalarInput::Smooth(index) => (0..3)
                .map(|corner| shares[corner] * f64::from(slot(triangle.corners[corner], *index)))
                .sum::<f64>() as f32,
            ScalarInput::Flat(index) => slot(triangle.first, *index),
            ScalarInput::Position(component) => [x, y, depth, inverse_w][*component & 3] as f32,
            ScalarInput::Front => f32::from_word(u32::from(triangle.front)),
            ScalarInput::Nothing => f32::from_word(0),
        };
        self.wiring.iter().map(argument).collect()
    }
}

fn quad_pixels(x: u32, y: u32) -> [(u32, u32); 4] {
    [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)]
}

/// The middle of a pixel, along one axis.
fn middle(x: u32) -> f64 {
    f64::from(x) + 0.5
}

fn store_output(targets: &mut Targets, pixel: usize, output: &FragmentOutput) {
    for (target, words) in targets.iter_mut().zip(&output.targets) {
        target[4 * pixel..4 * pixel + 4].copy_from_slice(words);
    }
}

/// Whether the fragment stage of a module may discard a fragment, or writes its depth.
fn is_decided_by(module: &Module) -> bool {
    let stages = || module.entry_points.iter().filter(|one| one.stage == ShaderStage::Fragment);
    let bodies = module.functions.iter().map(|(_, function)| &function.body);
    bodies.chain(stages().map(|one| &one.function.body)).any(discards)
        || stages().any(|one| {
            one.function.result.as_ref().is_some_and(|result| writes_depth(module, result))
        })
}

fn discards(block: &Block) -> bool {
    block.iter().any(|statement| {
        matches!(statement, Statement::Kill) || inner_blocks(statement).into_iter().any(discards)
    })
}

fn writes_depth(module: &Module, result: &FunctionResult) -> bool {
    let is_depth =
        |binding: &Option<Binding>| matches!(binding, Some(Binding::BuiltIn(BuiltIn::FragDepth)));
    let members = match &module.types[result.ty].inner {
        TypeInner::Struct { members, .. } => members.as_slice(),
        _ => &[],
    };
    is_depth(&result.binding) || members.iter().any(|member| is_depth(&member.binding))
}
