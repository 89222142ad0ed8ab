//! Runs cases of modules in each language on each executor. Prints nothing: results are data.

pub(super) mod job;
pub(super) mod judge;
mod report;
mod shrink;

pub use judge::{Verdict, Worst};
pub use report::{failures, table};

use std::sync::Arc;

use rayon::prelude::*;

use super::cases::File;
use super::{Session, kernel::Kernel};
use crate::compose::Language;
use crate::diagnostic::{Diagnostic, Diagnostics, codes};
use job::Job;

/// Gives the module that holds functions of a library module, in a language: composed, parsed
/// and valid. Names of the functions are kept.
pub type Subjects<'a> = dyn Fn(&str, Language, &[String]) -> Result<Arc<naga::Module>, Diagnostics> + Sync + 'a;

/// An executor that is open.
pub struct Open {
    /// Name on the command line.
    pub executor: &'static str,
    pub session: Box<dyn Session>,
}

/// What a check found, in the order of files, cases, languages, executors.
#[derive(Debug, Default)]
pub struct Report {
    pub outcomes: Vec<Outcome>,
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
    /// What was found; or why the executor did not run it.
    pub verdict: Result<Verdict, Diagnostic>,
}

impl Outcome {
    /// Whether every row and law holds.
    pub fn passed(&self) -> bool {
        self.verdict.as_ref().is_ok_and(Verdict::passed)
    }
}

impl Report {
    /// Whether everything holds.
    pub fn passed(&self) -> bool {
        self.outcomes.iter().all(Outcome::passed)
    }
}

/// Checks the cases of each module (`lighting::spot` and its file).
///
/// Errors are mistakes in the cases or in the modules; failing numbers are in the report.
pub fn check(files: &[(String, File)], languages: &[Language], subjects: &Subjects<'_>, open: &mut [Open]) -> Result<Report, Diagnostics> {
    let prepared: Vec<_> = files.par_iter().map(|(module, file)| job::prepare(module, file, languages, subjects)).collect();
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
            .map(|open| std::thread::Builder::new().stack_size(super::STACK).spawn_scoped(scope, move || run_all(jobs, open)))
            .collect();
        let columns = threads.into_iter().map(|thread| thread.ok()?.join().ok());
        columns.zip(names).map(|(column, name)| column.ok_or_else(|| vec![stopped(name)])).collect::<Result<_, Diagnostics>>()
    })?;
    Ok(Report { outcomes: interleaved(columns) })
}

fn stopped(executor: &str) -> Diagnostic {
    Diagnostic::error(codes::EXECUTOR_FAILED, format!("the executor `{executor}` stopped with an internal error"))
}

fn run_all(jobs: &[Job<'_>], open: &mut Open) -> Vec<Outcome> {
    let adapter = open.session.adapter();
    let mut outcomes = Vec::new();
    for job in jobs {
        let mut first = None;
        for (language, kernel) in &job.kernels {
            outcomes.push(Outcome {
                module: job.module.clone(),
                function: job.case.function.clone(),
                language: *language,
                executor: open.executor,
                adapter: adapter.clone(),
                verdict: run(job, kernel, open.session.as_mut(), &mut first),
            });
        }
    }
    outcomes
}

/// One case in one language; `first` keeps the first language's results, which others are compared with.
fn run(job: &Job<'_>, kernel: &Kernel, session: &mut dyn Session, first: &mut Option<Vec<u32>>) -> Result<Verdict, Diagnostic> {
    let results = session.run(kernel, &job.rows.words)?;
    let mut verdict = judge::judge(job, &job.rows, &job.expected, &results);
    for law in &job.laws {
        let transformed = law.rows.as_ref().map(|rows| session.run(kernel, &rows.words)).transpose()?;
        verdict.laws.push(judge::law(job, law, &results, transformed.as_deref()));
    }
    if let Some(row) = verdict.failing.first() {
        verdict.smallest = Some(shrink::shrink(job, kernel, session, *row)?);
    }
    verdict.parity = first.as_ref().map(|first| judge::parity(job, first, &results));
    first.get_or_insert(results);
    Ok(verdict)
}

/// Outcomes of all executors, side by side for each job.
fn interleaved(columns: Vec<Vec<Outcome>>) -> Vec<Outcome> {
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
