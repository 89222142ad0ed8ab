//! The vertex stage.

use naga::{Binding, BuiltIn};

use super::super::super::interpreter::failed;
use super::Lowered;
use crate::diagnostic::Diagnostic;
use crate::eval::{Kind, Machine, Number, Resources};
use crate::harness::frame::Mesh;

/// What the vertex stage made of a vertex, or clipping of an edge.
#[derive(Debug, Clone)]
pub struct Corner {
    pub clip: [f64; 4],
    /// Every scalar that the stage returns.
    pub slots: Vec<f32>,
}

/// Where a scalar that a stage takes comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Source {
    /// A component of what is at a location.
    Location(u32, usize),
    BuiltIn(BuiltIn, usize),
    None,
}

/// The source of each scalar, from the bindings of all.
pub fn sources(bindings: &[Option<Binding>]) -> Vec<Source> {
    let mut sources: Vec<Source> = Vec::with_capacity(bindings.len());
    for binding in bindings {
        let source = |component| match binding {
            Some(Binding::Location { location, .. }) => Source::Location(*location, component),
            Some(Binding::BuiltIn(built_in)) => Source::BuiltIn(*built_in, component),
            None => Source::None,
        };
        let first = source(0);
        // Scalars of one vector follow each other.
        let component = sources.iter().rev().take_while(|earlier| same(**earlier, first)).count();
        sources.push(source(component));
    }
    sources
}

fn same(a: Source, b: Source) -> bool {
    match (a, b) {
        (Source::Location(a, _), Source::Location(b, _)) => a == b,
        (Source::BuiltIn(a, _), Source::BuiltIn(b, _)) => a == b,
        _ => false,
    }
}

/// Runs the stage for every vertex of a mesh.
pub fn run(stage: &Lowered, mesh: &Mesh, resources: Resources) -> Result<Vec<Corner>, Diagnostic> {
    let Some(function) = stage.program.signature(stage.function) else { return Ok(Vec::new()) };
    let mut machine = Machine::<f32>::new(&stage.program).map_err(failed)?;
    machine.bind(resources).map_err(failed)?;
    let inputs = sources(&function.inputs);
    let outputs = sources(&function.outputs);
    let stride = mesh.attributes.iter().map(|attribute| attribute.format.size() as usize / 4).sum::<usize>();
    let mut corners = Vec::new();
    for index in 0..mesh.vertices() {
        let words = mesh.words.get(index as usize * stride..).unwrap_or(&[]);
        let argument = |(source, kind): (&Source, &Kind)| match source {
            Source::Location(location, component) => slot(*kind, attribute(mesh, words, *location, *component)),
            Source::BuiltIn(BuiltIn::VertexIndex, _) => f32::from_word(index),
            _ => f32::from_word(0),
        };
        let arguments: Vec<f32> = inputs.iter().zip(&function.arguments).map(argument).collect();
        let slots = machine.call(stage.function, &arguments).map_err(failed)?.to_vec();
        corners.push(Corner { clip: position(&outputs, &slots), slots });
    }
    Ok(corners)
}

/// A word as a scalar of the machine.
fn slot(kind: Kind, word: u32) -> f32 {
    if kind == Kind::Float { f32::from_bits(word) } else { f32::from_word(word) }
}

fn attribute(mesh: &Mesh, words: &[u32], location: u32, component: usize) -> u32 {
    let mut first = 0;
    for attribute in &mesh.attributes {
        let size = attribute.format.size() as usize / 4;
        if attribute.location == location && component < size {
            return words.get(first + component).copied().unwrap_or(0);
        }
        first += size;
    }
    0
}

fn position(outputs: &[Source], slots: &[f32]) -> [f64; 4] {
    let mut clip = [0.0; 4];
    for (source, slot) in outputs.iter().zip(slots) {
        if let Source::BuiltIn(BuiltIn::Position { .. }, component) = source
            && let Some(place) = clip.get_mut(*component)
        {
            *place = f64::from(*slot);
        }
    }
    clip
}
