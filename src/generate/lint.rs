//! What only a whole run can tell: axes that nobody asks for, conditions that decide nothing.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::entry::Entry;
use super::weave::Woven;
use crate::compose::wesl::lint::Outcomes;
use crate::diagnostic::{Diagnostic, Diagnostics, codes};
use crate::permute::axis::Mode;
use crate::permute::{Assignment, Program};
use crate::resolve::Graph;
use crate::source::{SourceSet, Span};

/// A place by its file's name: programs that share a file read it once each.
type Place = (String, u32, u32);

/// What has been seen of the programs so far.
#[derive(Default)]
pub struct Lints {
    /// How many programs have a condition.
    conditions: BTreeMap<Place, usize>,
    /// How often a condition was found to decide nothing, by what is said of it.
    constant: BTreeMap<(Place, String), (usize, Diagnostic)>,
    found: Diagnostics,
}

impl Lints {
    /// Looks at a program with all its permutations.
    pub fn see(&mut self, sources: &SourceSet, program: &Program, entries: &[Entry], points: &[Assignment]) {
        let mut seen: Vec<*const Graph> = Vec::new();
        for entry in entries {
            if seen.contains(&Arc::as_ptr(&entry.graph)) {
                continue;
            }
            seen.push(Arc::as_ptr(&entry.graph));
            if let Some(point) = points.first() {
                self.found.extend(entry.graph.undeclared(&program.space.settings(point)));
            }
            if let Graph::Wesl(graph) = &*entry.graph {
                self.conditions(sources, program, Outcomes::new(graph), points);
            }
        }
    }

    fn conditions(&mut self, sources: &SourceSet, program: &Program, mut outcomes: Outcomes<'_>, points: &[Assignment]) {
        for point in points {
            if outcomes.is_settled() {
                break;
            }
            outcomes.see(&program.space.settings(point));
        }
        for span in outcomes.places() {
            *self.conditions.entry(place(sources, span)).or_default() += 1;
        }
        for warning in outcomes.warnings() {
            let Some(label) = warning.labels.first() else { continue };
            let key = (place(sources, label.span), warning.message.clone());
            self.constant.entry(key).or_insert((0, warning)).0 += 1;
        }
    }

    /// Looks at what the compositions of a program asked for.
    pub fn see_reads(&mut self, program: &Program, woven: &[Woven]) {
        let asked = |name: &String| woven.iter().any(|woven| woven.reads.contains(name));
        let unread = program.space.axes().iter().filter(|axis| axis.mode != Mode::Dynamic && !asked(&axis.name));
        self.found.extend(unread.map(|axis| {
            let message = format!("no entry point of program `{}` asks for the axis `{}`", program.name, axis.name);
            Diagnostic::warning(codes::UNREAD_AXIS, message).at(axis.span, "multiplies permutations and changes none")
        }));
    }

    /// Everything found: a condition only if it decides nothing wherever it is.
    pub fn finish(self) -> Diagnostics {
        let Self { conditions, constant, mut found } = self;
        let everywhere = constant.into_iter().filter(|((place, _), (count, _))| conditions.get(place) == Some(count));
        found.extend(everywhere.map(|(_, (_, warning))| warning));
        found
    }
}

/// Warnings without those that another program gave already, in the order of their places.
pub fn distinct(sources: &SourceSet, warnings: Diagnostics) -> Diagnostics {
    let mut known = BTreeSet::new();
    let key =
        |warning: &Diagnostic| (warning.labels.first().map(|label| place(sources, label.span)), warning.code.name, warning.message.clone());
    let mut kept: Diagnostics = warnings.into_iter().filter(|warning| known.insert(key(warning))).collect();
    kept.sort_by_cached_key(key);
    kept
}

fn place(sources: &SourceSet, span: Span) -> Place {
    (sources.get(span.source).path.clone(), span.start, span.end)
}
