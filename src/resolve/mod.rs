//! From parsed modules to a graph of items and what each refers to.

pub mod glsl;
pub mod wesl;

use crate::compose::Language;
use crate::diagnostic::Diagnostics;
use crate::source::{Package, SourceSet};

/// The packages a composition may read.
pub struct Packages {
    /// The author's own; `package::` in WESL.
    pub root: Package,
    /// Those it may import by name.
    pub dependencies: Vec<Package>,
}

impl Packages {
    /// The dependency of that name.
    pub fn dependency(&self, name: &str) -> Option<&Package> {
        self.dependencies.iter().find(|package| package.name == name)
    }
}

/// All that a root file may reach, ready to be composed any number of times.
#[derive(Debug)]
pub enum Graph {
    Wesl(wesl::Graph),
    Glsl(glsl::Graph),
}

/// Reads and resolves `root`, a path relative to the root package, and what it may reach.
pub fn load(sources: &mut SourceSet, packages: &Packages, root: &str, language: Language) -> Result<Graph, Diagnostics> {
    match language {
        Language::Wesl => wesl::load(sources, packages, root).map(Graph::Wesl),
        Language::Glsl => glsl::load(sources, packages, root).map(Graph::Glsl),
    }
}
