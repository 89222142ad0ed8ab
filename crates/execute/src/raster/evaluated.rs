//! Runs stages on our own evaluator, in f32 rounded to nearest, on all cores.

use naga::{Binding, BuiltIn};
use rayon::prelude::*;

use super::{FragmentOutput, Quad, ShadedQuad, Shading};
use crate::frame::{Buffers, Drawing, EntryPoint, Mesh};
use crate::interpreter::eval_failed;
use crate::raster::{Corner, ScalarSource, scalar_sources, vertex_attribute};
use crate::{executor_failed, module_info};
use lamplight_diagnostic::Diagnostic;
use lamplight_eval::{Batch, Function, FunctionId, Machine, Number, Program, Resources, SlotKind};

/// The fewest fragments or vertices of a task.
const CHUNK: usize = 256;
/// Tasks for each thread. They are several, since some parts of a frame take longer than others.
const TASKS: usize = 8;

/// The stages of a program, lowered.
pub struct Evaluated {
    vertex: Lowered,
    fragment: Option<Lowered>,
}

impl Evaluated {
    /// Lowers the stages of a drawing.
    pub fn new(drawing: &Drawing<'_>) -> Result<Self, Diagnostic> {
        Ok(Self {
            vertex: Lowered::new(drawing.vertex)?,
            fragment: drawing.fragment.map(Lowered::new).transpose()?,
        })
    }
}

/// A stage, ready to run.
struct Lowered {
    program: Program,
    function: FunctionId,
    signature: Function,
}

impl Lowered {
    fn new(stage: EntryPoint<'_>) -> Result<Self, Diagnostic> {
        let info = module_info("program", stage.module)?;
        let program = Program::new(stage.module, &info).map_err(eval_failed)?;
        // GLSL also has a plain function of that name. Entry points come after functions, so the
        // last one is meant.
        let found = program.functions().filter(|(_, function)| function.name == stage.entry).last();
        let missing =
            || executor_failed(format!("the program has no entry point `{}`", stage.entry));
        let (function, signature) =
            found.map(|(id, function)| (id, function.clone())).ok_or_else(missing)?;
        Ok(Self { program, function, signature })
    }

    /// A batch of lanes with these resources bound.
    fn batch(&self, resources: &Resources) -> Result<Batch<'_>, Diagnostic> {
        let mut machine = Machine::<f32>::new(&self.program).map_err(eval_failed)?;
        machine.bind(resources.clone()).map_err(eval_failed)?;
        Ok(Batch::new(machine))
    }
}

/// How many of `count` fragments or vertices a task has. They fill whole batches of lanes.
fn task_size(count: usize) -> usize {
    let threads = rayon::current_num_threads().max(1);
    count.div_ceil(threads * TASKS).max(CHUNK).next_multiple_of(Batch::LANES)
}

impl Shading for Evaluated {
    fn corners(&self, mesh: &Mesh, resources: Resources) -> Result<Vec<Corner>, Diagnostic> {
        let Lowered { function, signature, .. } = &self.vertex;
        let inputs = scalar_sources(&signature.inputs);
        let outputs = scalar_sources(&signature.outputs);
        let arguments = |index: u32| -> Vec<f32> {
            let argument = |(source, kind): (&ScalarSource, &SlotKind)| match source {
                ScalarSource::Location(location, component) => {
                    slot_of_word(*kind, vertex_attribute(mesh, index, *location, *component))
                }
                ScalarSource::BuiltIn(BuiltIn::VertexIndex, _) => f32::from_word(index),
                _ => f32::from_word(0),
            };
            inputs.iter().zip(&signature.arguments).map(argument).collect()
        };
        let indices: Vec<u32> = (0..mesh.vertices()).collect();
        let corners = indices
            .par_chunks(task_size(indices.len()))
            .map(|indices| {
                let mut batch = self.vertex.batch(&resources)?;
                let arguments: Vec<Vec<f32>> = indices.iter().map(|i| arguments(*i)).collect();
                let arguments: Vec<&[f32]> = arguments.iter().map(Vec::as_slice).collect();
                let mut corners = Vec::with_capacity(indices.len());
                let called = batch.calls(*function, &arguments, &mut |_, slots, _| {
                    let clip = clip_position(&outputs, slots);
                    corners.push(Corner { clip, slots: slots.to_vec() });
                });
                called.map_err(eval_failed)?;
                Ok(corners)
            })
            .collect::<Result<Vec<Vec<Corner>>, Diagnostic>>()?;
        Ok(corners.into_iter().flatten().collect())
    }

    fn given(&self) -> Vec<(ScalarSource, bool)> {
        let Function { outputs, result, .. } = &self.vertex.signature;
        let is_flat = |slot: usize| {
            let flat = Some(naga::Interpolation::Flat);
            let says_so = matches!(
                &outputs[slot],
                Some(Binding::Location { interpolation, .. }) if *interpolation == flat
            );
            says_so || result.get(slot) != Some(&SlotKind::Float)
        };
        let sources = scalar_sources(outputs).into_iter().enumerate();
        sources.map(|(slot, source)| (source, is_flat(slot))).collect()
    }

    fn taken(&self) -> Option<Vec<ScalarSource>> {
        Some(scalar_sources(&self.fragment.as_ref()?.signature.inputs))
    }

    fn shade(
        &self,
        buffers: Buffers,
        textures: &Resources,
        quads: &[Quad],
    ) -> Result<Vec<ShadedQuad>, Diagnostic> {
        let Some(stage) = &self.fragment else { return Ok(Vec::new()) };
        let Lowered { function, signature, .. } = stage;
        let outputs = scalar_sources(&signature.outputs);
        let resources = Resources { buffers, ..textures.clone() };
        let shaded: Vec<Vec<ShadedQuad>> = quads
            .par_chunks(task_size(4 * quads.len()) / 4)
            .map_init(
                || stage.batch(&resources),
                |batch, quads| {
                    let batch = batch.as_mut().map_err(|problem| problem.clone())?;
                    let arguments: Vec<[&[f32]; 4]> = quads
                        .iter()
                        .map(|quad| quad.arguments.each_ref().map(Vec::as_slice))
                        .collect();
                    let mut shaded = vec![ShadedQuad::default(); quads.len()];
                    let called =
                        batch.quads(*function, &arguments, &mut |lane, slots, is_discarded| {
                            let output = || fragment_output(&outputs, &signature.result, slots);
                            shaded[lane / 4][lane % 4] = (!is_discarded).then(output);
                        });
                    called.map_err(eval_failed)?;
                    Ok(shaded)
                },
            )
            .collect::<Result<_, Diagnostic>>()?;
        Ok(shaded.into_iter().flatten().collect())
    }
}

/// A word as a scalar of the machine.
fn slot_of_word(kind: SlotKind, word: u32) -> f32 {
    if kind == SlotKind::Float { f32::from_bits(word) } else { f32::from_word(word) }
}

fn clip_position(outputs: &[ScalarSource], slots: &[f32]) -> [f64; 4] {
    let mut clip = [0.0; 4];
    for (source, slot) in outputs.iter().zip(slots) {
        if let ScalarSource::BuiltIn(BuiltIn::Position { .. }, component) = source
            && let Some(place) = clip.get_mut(*component)
        {
            *place = f64::from(*slot);
        }
    }
    clip
}

fn fragment_output(outputs: &[ScalarSource], kinds: &[SlotKind], slots: &[f32]) -> FragmentOutput {
    let mut output = FragmentOutput { targets: Vec::new(), depth: None };
    for ((source, kind), slot) in outputs.iter().zip(kinds).zip(slots) {
        match *source {
            ScalarSource::Location(location, component) => {
                let location = location as usize;
                if output.targets.len() <= location {
                    output.targets.resize(location + 1, [0; 4]);
                }
                output.targets[location][component & 3] =
                    if *kind == SlotKind::Float { slot.bits() } else { slot.word() };
            }
            ScalarSource::BuiltIn(BuiltIn::FragDepth, _) => output.depth = Some(*slot),
            _ => {}
        }
    }
    output
}
