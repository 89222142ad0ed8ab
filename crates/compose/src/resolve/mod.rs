//! From parsed modules to a graph of items and what each refers to.

pub mod glsl;
mod packages;
pub mod wesl;

pub use packages::{Packages, ROOT, Scope};

use std::collections::BTreeSet;

use lamplight_bundle::Language;
use lamplight_diagnostic::Diagnostics;
use lamplight_diagnostic::source::{Embedded, SourceId, SourceSet, Span};
use lamplight_permute::Settings;

/// All that a root file may reach, ready to be composed any number of times.
#[derive(Debug)]
pub enum Graph {
    /// Modules and imports.
    Wesl(wesl::Graph),
    /// Files and includes.
    Glsl(glsl::Graph),
}

impl Graph {
    /// The diagnostics of what was composed from the graph, each with the chain of imports or
    /// includes that led to the file it stands in.
    pub fn traced(&self, diagnostics: Diagnostics) -> Diagnostics {
        let one = |diagnostic| match self {
            Self::Wesl(graph) => graph.traced(diagnostic),
            Self::Glsl(graph) => graph.traced(diagnostic),
        };
        diagnostics.into_iter().map(one).collect()
    }

    /// For each text, the import or include that led to it first. The root has none.
    pub fn imports(&self) -> Vec<(SourceId, Span)> {
        match self {
            Self::Wesl(graph) => graph.imports().collect(),
            Self::Glsl(graph) => graph.includes().collect(),
        }
    }

    /// The warnings that the author can mend: those that stand in files of the root package.
    pub fn own(&self, warnings: Diagnostics) -> Diagnostics {
        let own = |warning: &lamplight_diagnostic::Diagnostic| match (self, warning.labels.first())
        {
            (Self::Wesl(graph), Some(label)) => graph.is_own(label.span.source),
            (Self::Glsl(graph), Some(label)) => graph.is_own(label.span.source),
            (_, None) => true,
        };
        warnings.into_iter().filter(own).collect()
    }

    /// Warnings about flags of conditions that no setting declares. A composition that evaluates
    /// such a flag fails, so these are in conditions that no composition evaluated.
    pub fn undeclared(&self, settings: &Settings) -> Diagnostics {
        match self {
            Self::Wesl(graph) => wesl::undeclared_flags(graph, settings),
            Self::Glsl(_) => Vec::new(),
        }
    }

    /// Names of what the root module declares, each once; none for GLSL, which has them only
    /// under some settings.
    pub fn root_items(&self) -> BTreeSet<String> {
        let Self::Wesl(graph) = self else { return BTreeSet::new() };
        let items = graph.nodes.first().into_iter().flat_map(|node| &node.module.items);
        let named = items.filter(|item| item.name != lamplight_syntax::wesl::Name::UNDERSCORE);
        named.map(|item| graph.names.text(item.name).to_owned()).collect()
    }

    /// Whether anything names `constants::NAME`, or is an override of that name; never in GLSL, which
    /// has macros.
    pub fn has_constant(&self, name: &str) -> bool {
        match self {
            Self::Wesl(graph) => {
                let mut items = graph.nodes.iter().flat_map(|node| &node.module.items);
                graph.constants.iter().any(|constant| graph.names.text(constant.name) == name)
                    || items.any(|item| {
                        item.kind == lamplight_syntax::wesl::ItemKind::Override
                            && graph.names.text(item.name) == name
                    })
            }
            Self::Glsl(_) => false,
        }
    }

    /// The library that its modules may import, if it is the one that the program carries.
    pub fn library(&self) -> Option<Embedded> {
        match self {
            Self::Wesl(graph) => graph.library,
            Self::Glsl(graph) => graph.library,
        }
    }

    /// Whether any condition, macro or constant of the graph may ask for the axis or feature.
    pub fn may_ask(&self, name: &str) -> bool {
        match self {
            Self::Wesl(graph) => graph.may_ask(name),
            Self::Glsl(graph) => graph.may_ask(name),
        }
    }
}

/// Reads and resolves `root`, a path relative to the root package, and what it may reach.
pub fn load(
    sources: &mut SourceSet,
    packages: &Packages,
    root: &str,
    language: Language,
) -> Result<Graph, Diagnostics> {
    match language {
        Language::Wesl => wesl::load(sources, packages, root).map(Graph::Wesl),
        Language::Glsl => glsl::load(sources, packages, root).map(Graph::Glsl),
    }
}
