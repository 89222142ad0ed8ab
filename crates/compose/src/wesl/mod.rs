//! WESL: one permutation of a graph as WGSL text.
//!
//! It finds what is kept, chooses names, and copies slices of the authors' text. Nothing is parsed
//! here.

mod cycle;
mod evaluate;
pub mod lint;
mod naming;
mod reach;
mod reached;
mod write;

use std::collections::BTreeSet;

use super::{Composed, Options};
use crate::resolve::wesl::Graph;
use lamplight_bundle::Language;
use lamplight_diagnostic::{Diagnostic, Diagnostics};
use lamplight_permute::Settings;
use lamplight_syntax::wesl::ConditionId;

/// Composes the graph's root module for the settings. The same input always gives the same bytes.
///
/// Errors carry the chain of imports that led to the module they are in.
pub fn compose(
    graph: &Graph,
    settings: &Settings,
    options: &Options,
) -> Result<Composed, Diagnostics> {
    let mut evaluator = evaluate::Evaluator::new(graph, settings);
    let reached = reach::find_reached(graph, &mut evaluator, options);
    cycle::check_cycles(graph, &reached, &mut evaluator.errors);
    let names = naming::choose_names(graph, &reached, options, &mut evaluator.errors);
    let output = write::write_reached(graph, &reached, &names, &mut evaluator);
    if !evaluator.errors.is_empty() {
        return Err(trace_imports(graph, evaluator.errors));
    }
    let warnings =
        reached.nodes().flat_map(|node| graph.nodes[node as usize].lints.iter().cloned()).collect();
    let (text, map, parts) = output;
    Ok(Composed {
        language: Language::Wesl,
        stage: None,
        text,
        map,
        parts,
        reads: evaluator.reads,
        warnings,
        decisions: Vec::new(),
        library: graph.library,
    })
}

/// Evaluates the conditions of a graph's modules for some settings.
pub struct Conditions<'a>(evaluate::Evaluator<'a>);

impl<'a> Conditions<'a> {
    /// No condition was evaluated yet.
    pub fn new(graph: &'a Graph, settings: &'a Settings) -> Self {
        Self(evaluate::Evaluator::new(graph, settings))
    }

    /// Whether a condition of a node's module holds.
    pub fn holds(&mut self, node: u32, condition: ConditionId) -> bool {
        self.0.holds(node, condition)
    }
}

fn trace_imports(graph: &Graph, errors: Diagnostics) -> Diagnostics {
    // An error that occurs at several uses is reported once.
    let mut known = BTreeSet::new();
    let is_new = |error: &Diagnostic| {
        error.labels.first().is_none_or(|label| known.insert((error.code.name, label.span)))
    };
    let new = errors.into_iter().filter(is_new).collect::<Diagnostics>();
    new.into_iter().map(|error| graph.traced(error)).collect()
}
