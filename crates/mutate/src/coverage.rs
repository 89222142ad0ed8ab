//! Finds which statements and branches of the modules the cases reach.

use std::collections::BTreeMap;
use std::sync::Mutex;

use super::suite::{self, Subject, Suite};
use crate::site::author_span;
use lamplight_check::library::Library;
use lamplight_diagnostic::Diagnostics;
use lamplight_diagnostic::source::SourceSet;
use lamplight_eval::{Branch, CoveragePoint, FunctionId, Machine, Program};
use lamplight_execute::interpreter::Interpreter;
use lamplight_validate::on_large_stack;

/// What was reached of one module.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Coverage {
    pub module: String,
    /// How many blocks of statements there are: bodies, branches (written or not), and what follows
    /// a branch.
    pub blocks: usize,
    pub uncovered: Vec<UncoveredBlock>,
}

/// A block that no case reaches.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UncoveredBlock {
    pub function: String,
    /// The author's `file:line`.
    pub place: String,
    pub branch: Branch,
}

/// A block by its function, its place in the composed text, and how it is reached.
type BlockKey = (String, u32, u32, u8);

/// Runs every row of the cases of the modules, and finds the blocks that none reaches.
///
/// # Errors
/// Mistakes in modules and case files.
pub fn measure_coverage(
    library: &Library,
    sources: &Mutex<SourceSet>,
    modules: &[String],
) -> Result<Vec<Coverage>, Diagnostics> {
    on_large_stack(|| {
        let files = suite::case_files(library, sources, modules)?;
        let suites = suite::make_suites(library, sources, &files, false)?;
        let texts = sources.lock().map(|sources| sources.clone()).unwrap_or_default();
        Ok(suites.iter().map(|suite| suite_coverage(suite, &texts)).collect())
    })
}

fn suite_coverage(suite: &Suite<'_>, sources: &SourceSet) -> Coverage {
    let reached = reached_blocks(suite);
    let mut blocks = 0;
    let mut uncovered = Vec::new();
    let Ok(program) = Program::new(&suite.whole, &suite.info) else {
        return Coverage { module: suite.module.clone(), blocks, uncovered };
    };
    for subject in &suite.subjects {
        let own = |point: &&CoveragePoint| point.function == FunctionId::from(subject.function);
        for point in program.points().iter().filter(own) {
            blocks += 1;
            if !reached.contains_key(&coverage_key(&subject.name, point)) {
                uncovered.push(block_place(suite, sources, subject, point));
            }
        }
    }
    Coverage { module: suite.module.clone(), blocks, uncovered }
}

fn coverage_key(function: &str, point: &CoveragePoint) -> BlockKey {
    let range = point.span.to_range().unwrap_or_default();
    (function.to_owned(), range.start as u32, range.end as u32, point.branch as u8)
}

/// How often each block was reached.
fn reached_blocks(suite: &Suite<'_>) -> BTreeMap<BlockKey, u64> {
    let mut reached = BTreeMap::new();
    for case in &suite.cases {
        let Ok(interpreter) = Interpreter::new(case.job.kernel()) else { continue };
        let program = interpreter.program();
        let name = |point: &CoveragePoint| {
            program.signature(point.function).map_or("", |function| function.name.as_str())
        };
        if program
            .points()
            .iter()
            .all(|point| reached.contains_key(&coverage_key(name(point), point)))
        {
            continue;
        }
        let mut count = |machine: &Machine<'_, f32>| {
            for (point, hits) in
                program.points().iter().zip(machine.hits()).filter(|(_, hits)| **hits > 0)
            {
                *reached.entry(coverage_key(name(point), point)).or_insert(0) += hits;
            }
        };
        // A case that cannot be run reaches nothing. Checking it reports why.
        if case.record(&interpreter, &mut count).is_err() {
            continue;
        }
    }
    reached
}

fn block_place(
    suite: &Suite<'_>,
    sources: &SourceSet,
    subject: &Subject,
    point: &CoveragePoint,
) -> UncoveredBlock {
    let span = author_span(&suite.map, point.span);
    let place = span.map_or("?".to_owned(), |span| {
        format!(
            "{}:{}",
            sources.get(span.source).path,
            sources.position(span.source, span.start as usize).0
        )
    });
    UncoveredBlock { function: subject.name.clone(), place, branch: point.branch }
}

impl std::fmt::Display for Coverage {
    /// A line for the module and one for each block that is not reached.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let covered = self.blocks - self.uncovered.len();
        writeln!(f, "{:<24} {covered:>4} of {:>4} blocks", self.module, self.blocks)?;
        self.uncovered.iter().try_for_each(|place| {
            let what = match place.branch {
                Branch::Entry => "never called",
                Branch::Accept => "the condition never holds",
                Branch::Reject => "the condition always holds",
                Branch::Case => "this case is never taken",
                Branch::Body | Branch::Continuing => "the loop never runs so",
                Branch::After => "never reached after the branch",
            };
            writeln!(f, "  {}: {}: {what}", place.place, place.function)
        })
    }
}
