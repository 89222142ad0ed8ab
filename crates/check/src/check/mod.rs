//! Runs cases of modules in each language on each executor. Prints nothing: results are data.

mod facts;
mod failures;
pub mod job;
pub mod law;
pub mod partner;
mod profile;
mod proof;
mod report;
mod shrink;
pub mod values;
pub mod verdict;

pub use failures::{failures_as_text, of_outcome, of_proof, report_failures};
pub use law::LawVerdict;
pub use profile::{BINS, Bin, CELLS, ErrorMap, Profile, ProfileAxis, ProfileScale, ProfiledInput};
pub use proof::{Parity, Proof, Spec, ValueProof};
pub use report::{headroom_text, lacking_text, report_table, short_number, stricter_cases};
pub use verdict::{CaseVerdict, Worst};

use std::collections::BTreeMap;
use std::sync::Arc;

use rayon::prelude::*;

use super::cases::CaseFile;
use super::ratchet::{self, Ratchet};
use job::CaseJob;
use lamplight_bundle::Language;
use lamplight_diagnostic::source::Span;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes, stopped_message};
use lamplight_execute::fixture::Fixture;
use lamplight_execute::kernel::{self, Kernel};
use lamplight_execute::{STACK, Session};
use lamplight_validate::on_large_stack;

/// Composes the module of a path in a language, with only the named functions and what they need.
/// The result is parsed and valid, and the functions keep their names.
pub type Subjects<'a> =
    dyn Fn(&str, Language, &[String]) -> Result<CheckedModule, Diagnostics> + Sync + 'a;

/// A composed module.
#[derive(Debug, Clone)]
pub struct CheckedModule {
    /// As naga reads it.
    pub module: Arc<naga::Module>,
    /// For GLSL, the text itself, for drivers that compile it.
    pub source: Option<Arc<str>>,
}

impl CheckedModule {
    /// A module that has no text of its own.
    pub fn without_text(module: Arc<naga::Module>) -> Self {
        Self { module, source: None }
    }

    /// A function of it, ready to be run.
    pub fn kernel(
        &self,
        function: &str,
        fixtures: &BTreeMap<String, Arc<Fixture>>,
    ) -> Result<Kernel, Diagnostic> {
        let mut kernel = kernel::build_kernel(&self.module, function, fixtures)?;
        kernel.source.clone_from(&self.source);
        Ok(kernel)
    }
}

pub struct OpenExecutor {
    /// Name on the command line.
    pub executor: &'static str,
    pub session: Box<dyn Session>,
}

/// What a check found, in the order of files, cases, languages and executors.
#[derive(Debug, Default)]
pub struct CheckReport {
    pub outcomes: Vec<Outcome>,
    /// The proof of each case, if proofs were asked for.
    pub proofs: Vec<Proof>,
    /// Paths of functions that no case calls.
    pub untested: Vec<String>,
}

/// One function in one language on one executor.
#[derive(Debug)]
pub struct Outcome {
    /// Path of the module, `lighting::spot`.
    pub module: String,
    pub function: String,
    pub language: Language,
    pub executor: &'static str,
    /// Name, driver and version of the device.
    pub adapter: String,
    /// Index of the case in its file.
    pub case: usize,
    /// Where the case names the function.
    pub span: Span,
    /// The name under which its measurements are recorded: the function's path and, from its second
    /// case on, the number of the case, as in `math::safe::saturate#2`.
    pub record: String,
    /// The result, or why the executor did not run the function.
    pub verdict: Result<CaseVerdict, Diagnostic>,
    /// The share of the stated tolerance that is recorded for this adapter.
    pub recorded: Option<f64>,
    /// The share that a waiver allows the executor, with its reason.
    pub waiver: Option<(f64, String)>,
}

impl Outcome {
    pub fn path(&self) -> String {
        format!("{}::{}", self.module, self.function)
    }

    /// Whether every row and law holds, and the error is not larger than recorded.
    pub fn passed(&self) -> bool {
        self.is_within() && !self.exceeds_driver()
    }

    /// Why the executor cannot run the function, if it cannot. Such an outcome neither passes nor
    /// fails.
    pub fn lacks(&self) -> Option<&Diagnostic> {
        let is_lack = |error: &&Diagnostic| error.code.name == codes::EXECUTOR_LACKS.name;
        self.verdict.as_ref().err().filter(is_lack)
    }

    /// Whether the function ran and does not pass.
    pub fn failed(&self) -> bool {
        !self.passed() && self.lacks().is_none()
    }

    /// Whether the error is larger than the driver tier allows.
    pub fn exceeds_driver(&self) -> bool {
        self.of_driver().is_some_and(|share| share > 1.0)
    }

    /// The worst error divided by what the driver tier allows, if that is recorded for this
    /// adapter.
    pub fn of_driver(&self) -> Option<f64> {
        let share = self.verdict.as_ref().ok()?.worst.map_or(0.0, |worst| worst.share());
        Some(share / (ratchet::SLACK * self.recorded?))
    }

    /// Whether every row and law holds, or the only failures are errors of values that a waiver
    /// allows.
    pub fn is_within(&self) -> bool {
        self.verdict.as_ref().is_ok_and(|verdict| verdict.passed() || self.is_waived(verdict))
    }

    fn is_waived(&self, verdict: &CaseVerdict) -> bool {
        let share = verdict.worst.map_or(0.0, |worst| worst.share());
        verdict.passed_but_for_values()
            && self.waiver.as_ref().is_some_and(|(waived, _)| share <= *waived)
    }
}

impl CheckReport {
    /// Whether everything that could be run holds.
    pub fn passed(&self) -> bool {
        !self.outcomes.iter().any(Outcome::failed) && self.proofs.iter().all(Proof::passed)
    }

    /// Appends another report.
    pub fn append(&mut self, other: Self) {
        self.outcomes.extend(other.outcomes);
        self.proofs.extend(other.proofs);
        self.untested.extend(other.untested);
    }
}

#[derive(Debug, Clone, Copy)]
pub struct CheckOptions<'a> {
    /// Whether the references of `crates/check/src/references/` apply to modules of these paths.
    pub references: bool,
    /// Whether to record how the error depends on the inputs.
    pub profile: bool,
    /// Whether to compare tolerances with what WGSL allows, and the languages with each other in
    /// f64.
    pub prove: bool,
    /// Whether to check laws about several functions.
    pub partners: bool,
    /// What drivers were measured to need, if results are compared with that.
    pub ratchet: Option<&'a Ratchet>,
}

impl Default for CheckOptions<'_> {
    fn default() -> Self {
        Self { references: true, profile: false, prove: false, partners: true, ratchet: None }
    }
}

/// [`check_with`] the default options.
pub fn check(
    files: &[(String, CaseFile)],
    languages: &[Language],
    subjects: &Subjects<'_>,
    open: &mut [OpenExecutor],
) -> Result<CheckReport, Diagnostics> {
    check_with(files, languages, subjects, open, &CheckOptions::default())
}

/// Checks the cases of each module (`lighting::spot` and its file).
///
/// Errors are mistakes in the cases or in the modules. Wrong results are in the report.
pub fn check_with(
    files: &[(String, CaseFile)],
    languages: &[Language],
    subjects: &Subjects<'_>,
    open: &mut [OpenExecutor],
    options: &CheckOptions<'_>,
) -> Result<CheckReport, Diagnostics> {
    // All in one batch on the large stacks. A thread that waits for a part of its job takes up
    // another job on the same stack meanwhile.
    let prepared: Vec<_> = on_large_stack(|| {
        files
            .par_iter()
            .map(|(module, file)| job::prepare_jobs(module, file, languages, subjects, options))
            .collect()
    });
    let (mut jobs, mut errors) = (Vec::new(), Vec::new());
    for result in prepared {
        match result {
            Ok(found) => jobs.extend(found),
            Err(found) => errors.extend(found),
        }
    }
    if !errors.is_empty() {
        return Err(errors);
    }
    let columns: Vec<Vec<Outcome>> = std::thread::scope(|scope| {
        let jobs = &jobs;
        let names: Vec<_> = open.iter().map(|open| open.executor).collect();
        let threads: Vec<_> = open
            .iter_mut()
            .map(|open| {
                std::thread::Builder::new()
                    .stack_size(STACK)
                    .spawn_scoped(scope, move || run_all(jobs, open, options))
            })
            .collect();
        let columns = threads.into_iter().map(|thread| thread.ok()?.join().ok());
        columns
            .zip(names)
            .map(|(column, name)| column.ok_or_else(|| vec![executor_stopped(name)]))
            .collect::<Result<_, Diagnostics>>()
    })?;
    Ok(CheckReport {
        outcomes: interleave_outcomes(columns),
        proofs: if options.prove { proof::prove_jobs(&jobs) } else { Vec::new() },
        untested: Vec::new(),
    })
}

fn executor_stopped(executor: &str) -> Diagnostic {
    Diagnostic::error(
        codes::EXECUTOR_FAILED,
        stopped_message(&format!("the executor `{executor}`")),
    )
}

fn run_all(
    jobs: &[CaseJob<'_>],
    open: &mut OpenExecutor,
    options: &CheckOptions<'_>,
) -> Vec<Outcome> {
    let adapter = open.session.adapter();
    let kernels = jobs.iter().flat_map(|job| &job.kernels).map(|(_, kernel)| kernel);
    open.session.prepare(&kernels.collect::<Vec<_>>());
    let mut outcomes = Vec::new();
    for job in jobs {
        let mut first = None;
        let path = format!("{}::{}", job.module, job.case.function);
        let waiver = options.ratchet.and_then(|ratchet| ratchet.waiver(&path, open.executor));
        for (language, kernel) in &job.kernels {
            outcomes.push(Outcome {
                module: job.module.clone(),
                function: job.case.function.clone(),
                language: *language,
                executor: open.executor,
                adapter: adapter.clone(),
                case: job.index,
                span: job.case.span,
                record: job.record.clone(),
                verdict: run_case(
                    job,
                    (*language, kernel),
                    open.session.as_mut(),
                    &mut first,
                    options,
                ),
                recorded: options
                    .ratchet
                    .and_then(|ratchet| ratchet.share(&job.record, open.executor, &adapter)),
                waiver: waiver.map(|waiver| (waiver.share, waiver.reason.clone())),
            });
        }
    }
    outcomes
}

/// Runs one case in one language. `first` keeps the results of the first language, with which the
/// others are compared.
fn run_case(
    job: &CaseJob<'_>,
    (language, kernel): (Language, &Kernel),
    session: &mut dyn Session,
    first: &mut Option<Vec<u32>>,
    options: &CheckOptions<'_>,
) -> Result<CaseVerdict, Diagnostic> {
    let results = session.run(kernel, &job.rows.words)?;
    let mut verdict = verdict::check_rows(job, &job.rows, &job.expected, &results);
    for law in &job.laws {
        if let Some(found) = partner::check_partners(job, law, language, &results, session)? {
            verdict.laws.push(found);
            continue;
        }
        let transformed =
            law.rows.as_ref().map(|rows| session.run(kernel, &rows.words)).transpose()?;
        let transformed = law.rows.as_ref().zip(transformed.as_deref());
        let mut found = law::check_law(
            job,
            law.law,
            &law::RowResults {
                rows: &job.rows,
                expected: &job.expected,
                results: &results,
                transformed,
            },
        );
        if let Some(row) = found.row {
            found.smallest = Some(shrink::shrink_law(job, kernel, session, law.law, row)?);
        }
        verdict.laws.push(found);
    }
    if let Some(row) = verdict.failing.first() {
        verdict.smallest = Some(shrink::shrink_row(job, kernel, session, *row)?);
    }
    verdict.profile = options.profile.then(|| Box::new(profile::make_profile(job, &results)));
    verdict.parity = first.as_ref().map(|first| verdict::language_parity(job, first, &results));
    first.get_or_insert(results);
    Ok(verdict)
}

/// Merges the outcomes of the executors: for each case and language in turn, those of all
/// executors.
fn interleave_outcomes(columns: Vec<Vec<Outcome>>) -> Vec<Outcome> {
    let mut columns: Vec<_> = columns.into_iter().map(Vec::into_iter).collect();
    let mut outcomes = Vec::new();
    loop {
        let before = outcomes.len();
        outcomes.extend(columns.iter_mut().filter_map(Iterator::next));
        if outcomes.len() == before {
            return outcomes;
        }
    }
}
