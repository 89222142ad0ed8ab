//! Lints that need a whole run: axes that no entry point asks for, and conditions that never decide
//! anything.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use rayon::prelude::*;

use super::EntryResult;
use super::entry::ShaderEntry;
use lamplight_compose::Decision;
use lamplight_compose::resolve::Graph;
use lamplight_compose::wesl::lint::{self, Outcomes};
use lamplight_diagnostic::source::{SourceSet, Span};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_permute::axis::{Axis, Mode};
use lamplight_permute::{Assignment, Program, cover};

/// How many permutations conditions are evaluated for before the others are, in parallel.
const FIRST_POINTS: usize = 64;

/// A place, by the name of its file, since programs that share a file each read it.
type LintPlace = (String, u32, u32);

/// What has been seen of the programs so far.
#[derive(Default)]
pub struct Lints {
    /// For each condition, how many programs have it.
    conditions: BTreeMap<LintPlace, usize>,
    /// For each condition and message, in how many programs the condition was found to decide
    /// nothing, with the warning.
    constant: BTreeMap<(LintPlace, String), (usize, Diagnostic)>,
    found: Diagnostics,
}

impl Lints {
    /// Looks at a program with all its permutations.
    pub fn see(
        &mut self,
        sources: &SourceSet,
        program: &Program,
        entries: &[ShaderEntry],
        points: &[Assignment],
    ) {
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

    fn conditions(
        &mut self,
        sources: &SourceSet,
        program: &Program,
        mut outcomes: Outcomes<'_>,
        points: &[Assignment],
    ) {
        outcomes = see_points(outcomes, program, points);
        // A condition that is constant only because of the lists decides something as soon as they
        // have more entries.
        if program.space.count() < program.space.valid_count() {
            outcomes = see_points(outcomes, program, &cover::pairwise(&program.space).points);
        }
        for span in outcomes.places() {
            *self.conditions.entry(place_of(sources, span)).or_default() += 1;
        }
        outcomes.warnings().for_each(|warning| self.constant(sources, warning));
    }

    /// Looks at what the compositions of a program asked for, and at how their conditions came out.
    pub fn see_results(
        &mut self,
        sources: &SourceSet,
        program: &Program,
        entries: &[ShaderEntry],
        results: &[EntryResult],
    ) {
        for (entry, result) in entries.iter().zip(results) {
            for span in result.decided.places() {
                *self.conditions.entry(place_of(sources, span)).or_default() += 1;
            }
            // GLSL's conditions are known only from what was composed, which is too little where
            // lists left permutations out.
            let is_part = program.space.count() < program.space.valid_count();
            let decided = if is_part { Vec::new() } else { result.decided.warnings() };
            entry
                .graph
                .own(decided)
                .into_iter()
                .for_each(|warning| self.constant(sources, warning));
        }
        self.see_reads(program, entries, results);
    }

    fn constant(&mut self, sources: &SourceSet, warning: Diagnostic) {
        if let Some(label) = warning.labels.first() {
            let key = (place_of(sources, label.span), warning.message.clone());
            self.constant.entry(key).or_insert((0, warning)).0 += 1;
        }
    }

    fn see_reads(&mut self, program: &Program, entries: &[ShaderEntry], results: &[EntryResult]) {
        let read = |name: &String| results.iter().any(|result| result.reads.contains(name));
        // The pipeline may choose the value of a spec axis. Then no composition asks for it.
        let is_open = |axis: &Axis| {
            axis.mode == Mode::Spec && entries.iter().any(|entry| entry.graph.may_ask(&axis.name))
        };
        let is_read = |axis: &Axis| read(&axis.name) || is_open(axis);
        let unread =
            program.space.axes().iter().filter(|axis| axis.mode != Mode::Dynamic && !is_read(axis));
        self.found.extend(unread.map(|axis| {
            let message = format!(
                "no entry point of program `{}` asks for the axis `{}`",
                program.name, axis.name
            );
            Diagnostic::warning(codes::UNREAD_AXIS, message)
                .at(axis.span, "multiplies permutations and changes none")
        }));
    }

    /// All warnings. A condition is among them only if it decides nothing in every program that has
    /// it.
    pub fn finish(self) -> Diagnostics {
        let Self { conditions, constant, mut found } = self;
        let everywhere = constant
            .into_iter()
            .filter(|((place, _), (count, _))| conditions.get(place) == Some(count));
        found.extend(everywhere.map(|(_, (_, warning))| warning));
        found
    }
}

/// Evaluates the conditions that are not settled yet for permutations: for some first, since they
/// settle most conditions, and for the others in parallel.
fn see_points<'g>(
    outcomes: Outcomes<'g>,
    program: &Program,
    points: &[Assignment],
) -> Outcomes<'g> {
    let see = |mut outcomes: Outcomes<'g>, points: &[Assignment]| {
        for point in points {
            if outcomes.is_settled() {
                break;
            }
            outcomes.see(&program.space.settings(point));
        }
        outcomes
    };
    let (first, others) = points.split_at(points.len().min(FIRST_POINTS));
    let outcomes = see(outcomes, first);
    let parts = others.par_chunks(FIRST_POINTS).map(|part| see(outcomes.clone(), part));
    let parts: Vec<Outcomes<'g>> = parts.collect();
    parts.iter().fold(outcomes, Outcomes::join)
}

/// How the conditions of one entry point's GLSL came out in all its compositions.
#[derive(Debug, Default)]
pub struct Decided {
    outcomes: BTreeMap<Span, Ways>,
}

#[derive(Debug, Default)]
struct Ways {
    held: bool,
    failed: bool,
    /// Whether it may be the last branch of a chain, which covers all that is left: such a branch
    /// only has to hold once.
    later: bool,
}

impl Decided {
    /// Looks at one composition.
    pub fn see(&mut self, decisions: &[Decision]) {
        for decision in decisions {
            let ways = self.outcomes.entry(decision.span).or_default();
            ways.held |= decision.holds;
            ways.failed |= !decision.holds;
            ways.later |= decision.later;
        }
    }

    fn places(&self) -> impl Iterator<Item = Span> {
        self.outcomes.keys().copied()
    }

    fn warnings(&self) -> Diagnostics {
        let constant =
            self.outcomes.iter().filter(|(_, ways)| !(ways.held && (ways.failed || ways.later)));
        constant.map(|(span, ways)| lint::constant_condition(*span, ways.held)).collect()
    }
}

/// The warnings that no other program gave already, in the order of their places.
pub fn distinct(sources: &SourceSet, warnings: Diagnostics) -> Diagnostics {
    let mut known = BTreeSet::new();
    let key = |warning: &Diagnostic| {
        (
            warning.labels.first().map(|label| place_of(sources, label.span)),
            warning.code.name,
            warning.message.clone(),
        )
    };
    let mut kept: Diagnostics =
        warnings.into_iter().filter(|warning| known.insert(key(warning))).collect();
    kept.sort_by_cached_key(key);
    kept
}

fn place_of(sources: &SourceSet, span: Span) -> LintPlace {
    (sources.get(span.source).path.clone(), span.start, span.end)
}
