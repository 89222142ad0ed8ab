//! Runs stages as compiled MSL, from the bytes that are shipped.

use std::sync::{Mutex, MutexGuard, PoisonError};

use naga::BuiltIn;

use super::{FragmentOutput, Quad, ShadedQuad, Shading};
use crate::compiled::CompiledProgram;
use crate::compiled::interface::{Interface, InterfaceMember, InterfaceRole};
use crate::compiled::request::{FragmentInput, MetalResources, Transformed, VertexInput};
use crate::executor_failed;
use crate::frame::{Buffers, Drawing, Frame, Mesh};
use crate::raster::{Corner, ScalarSource, vertex_attribute};
use crate::shipped::Shipped;
use lamplight_diagnostic::Diagnostic;
use lamplight_eval::{Number, Resources};
use lamplight_tools::metal::ClangMissing;

/// Stages of any number of programs, compiled together.
pub struct CompiledStages {
    stages: Vec<Shipped>,
    program: Mutex<CompiledProgram>,
}

impl CompiledStages {
    /// Compiles stages. One that clang refuses fails when it is drawn.
    ///
    /// # Errors
    /// clang is missing or cannot be run.
    pub fn new(stages: Vec<Shipped>) -> Result<Self, ClangMissing> {
        let texts: Vec<_> = stages.iter().map(Shipped::text).collect();
        let texts: Vec<&str> = texts.iter().map(AsRef::as_ref).collect();
        let program = Mutex::new(CompiledProgram::build(&texts)?);
        Ok(Self { stages, program })
    }

    /// Draws with two of the stages, by their index, instead of those that the drawing names.
    ///
    /// # Errors
    /// What is wrong with the texts, or how they failed.
    pub fn draw(
        &self,
        vertex: usize,
        fragment: Option<usize>,
        drawing: &Drawing<'_>,
    ) -> Result<Vec<Frame>, Diagnostic> {
        self.draw_pair(vertex, fragment, drawing, false)
    }

    /// As [`Self::draw`], with more targets after those of the drawing, which hold what each
    /// fragment was given: one for each location that the stage takes, one for its position, and
    /// one whose first word says whether it belongs to a front face.
    ///
    /// # Errors
    /// Those of [`Self::draw`].
    pub fn draw_watched(
        &self,
        vertex: usize,
        fragment: usize,
        drawing: &Drawing<'_>,
    ) -> Result<Vec<Frame>, Diagnostic> {
        self.draw_pair(vertex, Some(fragment), drawing, true)
    }

    fn draw_pair(
        &self,
        vertex: usize,
        fragment: Option<usize>,
        drawing: &Drawing<'_>,
        is_watched: bool,
    ) -> Result<Vec<Frame>, Diagnostic> {
        let stage = |index: usize| {
            let interface = self.program().interface(index).cloned().map_err(executor_failed)?;
            Ok::<_, Diagnostic>(MetalStage { index, interface })
        };
        let (vertex, fragment) = (stage(vertex)?, fragment.map(stage).transpose()?);
        let mut targets = drawing.targets;
        if let Some(fragment) = fragment.as_ref().filter(|_| is_watched) {
            targets += fragment.interface.locations().0 + 2;
        }
        let drawn = drawing.targets as usize;
        let pair =
            StagePair { compiled: self, vertex, fragment, watched: is_watched.then_some(drawn) };
        super::draw_frames(&Drawing { targets, ..*drawing }, &pair)
    }

    fn program(&self) -> MutexGuard<'_, CompiledProgram> {
        self.program.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn bound(&self, stage: &MetalStage, resources: &Resources) -> MetalResources {
        let shipped = &self.stages[stage.index];
        MetalResources::new(resources, &shipped.native, &shipped.reflection)
    }
}

/// A stage of a program, by its index.
struct MetalStage {
    index: usize,
    interface: Interface,
}

/// Two stages that are drawn with.
struct StagePair<'c> {
    compiled: &'c CompiledStages,
    vertex: MetalStage,
    fragment: Option<MetalStage>,
    /// How many targets the drawing itself has, if further targets hold what fragments were given.
    watched: Option<usize>,
}

/// The sources of the scalars of `locations` locations.
fn located_sources(locations: u32) -> impl Iterator<Item = ScalarSource> {
    (0..locations).flat_map(|location| (0..4).map(move |i| ScalarSource::Location(location, i)))
}

impl Shading for StagePair<'_> {
    fn corners(&self, mesh: &Mesh, resources: Resources) -> Result<Vec<Corner>, Diagnostic> {
        let taken = self.vertex.interface.locations().0;
        let vertex = |index: u32| {
            let location = |location: u32| {
                std::array::from_fn(|component| vertex_attribute(mesh, index, location, component))
            };
            VertexInput { index, instance: 0, locations: (0..taken).map(location).collect() }
        };
        let vertices: Vec<VertexInput> = (0..mesh.vertices()).map(vertex).collect();
        let bound = self.compiled.bound(&self.vertex, &resources);
        let transformed = self.compiled.program().vertices(self.vertex.index, &bound, &vertices);
        let corner = |vertex: Transformed| Corner {
            clip: vertex.position.map(f64::from),
            slots: vertex.locations.into_iter().flatten().map(f32::from_bits).collect(),
        };
        Ok(transformed.map_err(executor_failed)?.into_iter().map(corner).collect())
    }

    fn given(&self) -> Vec<(ScalarSource, bool)> {
        let Interface { output, .. } = &self.vertex.interface;
        let is_flat = |location: u32| {
            let is_it = |part: &&InterfaceMember| part.role == InterfaceRole::Location(location);
            output.iter().find(is_it).is_some_and(|part| part.is_flat)
        };
        located_sources(self.vertex.interface.locations().1)
            .map(|source| match source {
                ScalarSource::Location(location, _) => (source, is_flat(location)),
                other => (other, false),
            })
            .collect()
    }

    fn taken(&self) -> Option<Vec<ScalarSource>> {
        let locations = self.fragment.as_ref()?.interface.locations().0;
        let position = BuiltIn::Position { invariant: false };
        let built_in = (0..4).map(|i| ScalarSource::BuiltIn(position, i));
        let front = ScalarSource::BuiltIn(BuiltIn::FrontFacing, 0);
        Some(located_sources(locations).chain(built_in).chain([front]).collect())
    }

    fn shade(
        &self,
        buffers: Buffers,
        textures: &Resources,
        quads: &[Quad],
    ) -> Result<Vec<ShadedQuad>, Diagnostic> {
        let Some(stage) = &self.fragment else { return Ok(Vec::new()) };
        let resources = Resources { buffers, ..textures.clone() };
        let bound = self.compiled.bound(stage, &resources);
        let fragments: Vec<[FragmentInput; 4]> = quads
            .iter()
            .map(|quad| quad.arguments.each_ref().map(|slots| make_fragment(slots)))
            .collect();
        let shaded = self.compiled.program().quads(stage.index, &bound, &fragments);
        let is_depth = |part: &InterfaceMember| part.role == InterfaceRole::Depth;
        let writes_depth = stage.interface.output.iter().any(is_depth);
        let mut results: Vec<ShadedQuad> = Vec::new();
        for (given, shaded) in fragments.iter().zip(shaded.map_err(executor_failed)?) {
            results.push(std::array::from_fn(|lane| {
                let mut targets = shaded[lane].targets.clone();
                if let Some(drawn) = self.watched {
                    targets.resize(drawn, [0; 4]);
                    targets.extend(fragment_words(&given[lane]));
                }
                let depth = writes_depth.then_some(shaded[lane].depth);
                (!shaded[lane].is_discarded).then_some(FragmentOutput { targets, depth })
            }));
        }
        Ok(results)
    }
}

/// A fragment from the scalars of [`Shading::taken`]: four for each location, four for the
/// position, and one that says whether it belongs to a front face.
fn make_fragment(slots: &[f32]) -> FragmentInput {
    let (four, rest) = slots.as_chunks::<4>();
    let (position, locations) =
        four.split_last().map_or(([0.0; 4], &[][..]), |(last, all)| (*last, all));
    FragmentInput {
        position,
        front: rest.first().is_some_and(|front| front.word() != 0),
        locations: locations.iter().map(|slots| slots.map(f32::to_bits)).collect(),
    }
}

/// What a fragment was given, as words of targets.
fn fragment_words(fragment: &FragmentInput) -> impl Iterator<Item = [u32; 4]> + '_ {
    let position = fragment.position.map(f32::to_bits);
    let front = [u32::from(fragment.front), 0, 0, 0];
    fragment.locations.iter().copied().chain([position, front])
}
