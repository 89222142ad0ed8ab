//! Vertices before and after the vertex stage.

use naga::{Binding, BuiltIn};

use crate::frame::Mesh;

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
