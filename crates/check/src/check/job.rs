//! Prepares a case: kernels, rows, expected values. No executor is needed for this. The rows and
//! the work of the cases of a file have limits, and the kernels of one function share their code.

use crate::cases::{Case, CaseFile, FormulaText, Oracle, Rows};
use crate::check::partner::Partner;
use crate::check::{CheckOptions, CheckedModule, Subjects, partner};
use crate::formula::{Formula, Scope};
use crate::laws::Law;
use crate::references::{CallArguments, Expected, Reference};
use crate::tolerance::BoundTerm;
use crate::{cases, laws, references, tolerance};
use lamplight_bundle::Language;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_eval::{Bounded, FindingKind, Number};
use lamplight_execute::fixture::Fixture;
use lamplight_execute::interpreter::{Interpreter, KernelCalls, slot_value};
use lamplight_execute::kernel::{Kernel, TypeShape};
use lamplight_files::limits::{CASE_ROWS, CASE_WORDS, CASE_WORK, Steps};
use naga::ScalarKind;
use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

pub struct CaseJob<'a> {
    pub module: String,
    pub case: &'a Case,
    /// Index of the case in its file.
    pub index: usize,
    /// The name under which its measurements are recorded.
    pub record: String,
    pub kernels: Vec<(Language, Kernel)>,
    pub rows: Rows,
    /// The expected values of each row; empty where the case has only laws.
    pub expected: Vec<Goal>,
    pub terms: Vec<BoundTerm>,
    pub near: Option<(Formula, f64)>,
    pub filter: Option<Formula>,
    pub laws: Vec<BoundLaw<'a>>,
    pub oracle: BoundOracle,
    pub fixtures: Vec<Arc<Fixture>>,
}

/// A law, the rows that it compares with, and the other functions that it is about.
pub struct BoundLaw<'a> {
    pub law: &'a Law,
    pub rows: Option<Rows>,
    pub partners: Vec<Partner>,
}

/// Gives the expected value of a row. Except for `Fixed`, it also answers for rows that the case
/// does not list, since shrinking a failure tries such rows.
pub enum BoundOracle {
    Reference(Reference),
    Formula(Formula),
    /// The code of the first language, evaluated in f64 with error bounds.
    Eval(Box<Interpreter>),
    /// A table, or no oracle. Only the rows of the case are known.
    Fixed,
}

/// What a row should give.
#[derive(Clone)]
pub struct Goal {
    pub expected: Expected,
    /// An error that is allowed for each word in addition to the terms of the case; may be empty.
    pub errors: Vec<f64>,
    /// Whether rounding may decide a comparison on the way to the value.
    pub doubtful: bool,
}

impl From<Expected> for Goal {
    fn from(expected: Expected) -> Self {
        Self { expected, errors: Vec::new(), doubtful: false }
    }
}

impl CaseJob<'_> {
    /// The expected values of rows; `None` if the oracle knows only the rows of the case.
    pub fn goals(&self, rows: &Rows) -> Result<Option<Vec<Goal>>, Diagnostic> {
        let each = |expect: &(dyn Fn(&[f64]) -> Expected + Sync)| -> Vec<Goal> {
            (0..rows.len()).into_par_iter().map(|index| expect(rows.row(index)).into()).collect()
        };
        match &self.oracle {
            BoundOracle::Reference(reference) => {
                Ok(Some(each(&|row| reference(&mut CallArguments::new(row, &self.fixtures)))))
            }
            BoundOracle::Formula(formula) => {
                Ok(Some(each(&|row| Expected::words(formula.eval(row)))))
            }
            BoundOracle::Eval(interpreter) => {
                bounded_goals(interpreter, rows, &self.kernel().result_kinds()).map(Some)
            }
            BoundOracle::Fixed => Ok(None),
        }
    }

    /// The kernel of the first language, whose parameters name the columns.
    pub fn kernel(&self) -> &Kernel {
        &self.kernels[0].1
    }
}

/// The jobs of a module's case file.
pub fn prepare_jobs<'a>(
    module: &str,
    file: &'a CaseFile,
    languages: &[Language],
    subjects: &Subjects<'_>,
    options: &CheckOptions<'_>,
) -> Result<Vec<CaseJob<'a>>, Diagnostics> {
    let mut functions: Vec<String> = file.cases.iter().map(|case| case.function.clone()).collect();
    functions.sort();
    functions.dedup();
    let modules: Vec<_> = languages
        .iter()
        .map(|language| Ok((*language, subjects(module, *language, &functions)?)))
        .collect::<Result<_, Diagnostics>>()
        .map_err(|errors| {
            let mut first: HashMap<&str, &Case> = HashMap::new();
            for case in &file.cases {
                first.entry(&case.function).or_insert(case);
            }
            errors.into_iter().map(|error| place_at_case(error, &first)).collect::<Vec<_>>()
        })?;
    let (records, total) = (record_names(module, file), Total::default());
    let jobs: Vec<_> = records
        .par_iter()
        .enumerate()
        .map(|(index, record)| {
            let place = CasePlace { file, index, record, total: &total };
            make_job(module, place, &modules, (subjects, options))
        })
        .collect();
    total.check(file).map_err(|error| vec![error])?;
    let (mut done, mut errors) = (Vec::new(), Vec::new());
    for result in jobs {
        match result {
            Ok(job) => done.push(job),
            Err(error) => errors.push(error),
        }
    }
    share_code(&mut done);
    if errors.is_empty() { Ok(done) } else { Err(errors) }
}

/// Puts an error about a function at the first case that names the function.
fn place_at_case(error: Diagnostic, first: &HashMap<&str, &Case>) -> Diagnostic {
    match error.item.as_deref().and_then(|item| first.get(item)) {
        Some(case) if error.labels.is_empty() => error.at(case.span, "named here"),
        _ => error,
    }
}

/// Puts an error without a place at the case.
fn placed_at(error: Diagnostic, case: &Case) -> Diagnostic {
    if error.labels.is_empty() { error.at(case.span, "in this case") } else { error }
}

/// The function in each language, at least one. Its interface must be the same in all.
fn build_kernels(
    case: &Case,
    modules: &[(Language, CheckedModule)],
) -> Result<Vec<(Language, Kernel)>, Diagnostic> {
    let build = |(language, subject): &(Language, CheckedModule)| {
        Ok((*language, subject.kernel(&case.function, &case.fixtures)?))
    };
    let kernels: Vec<_> = modules.iter().map(build).collect::<Result<_, Diagnostic>>()?;
    if kernels.is_empty() {
        return Err(Diagnostic::error(codes::CASE_INVALID, "no language was chosen"));
    }
    check_agreement(&kernels)?;
    Ok(kernels)
}

fn make_job<'a>(
    module: &str,
    CasePlace { file, index, record, total }: CasePlace<'a, '_>,
    modules: &[(Language, CheckedModule)],
    (subjects, options): (&Subjects<'_>, &CheckOptions<'_>),
) -> Result<CaseJob<'a>, Diagnostic> {
    let case = &file.cases[index];
    let placed = |error: Diagnostic| placed_at(error, case);
    let mut steps = steps_of_case(file);
    let mut kernels = build_kernels(case, modules).map_err(placed)?;
    kernels.iter_mut().for_each(|(_, kernel)| kernel.steps = steps.most());
    let first = &kernels[0].1;
    let scope = Scope(first.words().collect());
    let rows = counted_rows(file, case, &scope, total, &mut steps)?;
    let terms = tolerance::bind_terms(&case.tolerance, &scope, &first.results).map_err(placed)?;
    let languages: Vec<Language> = modules.iter().map(|(language, _)| *language).collect();
    let near = bind_margin(case, &scope)?;
    let filter = case.filter().map(|text| text.bind(&scope)).transpose()?;
    let oracle = bound_oracle(module, case, &scope, first, options)?;
    let parts = RowFormulas { terms: &terms, near: &near, filter: &filter, oracle: &oracle };
    parts.spend(case, &rows, &mut steps)?;
    let steps = steps.most();
    let wanted = case.laws.iter().filter(|law| options.partners || law.partners.is_empty());
    let laws = wanted
        .map(|law| {
            let mut partners =
                partner::prepare_partners(law, module, &languages, subjects, &rows, &scope)?;
            limit_steps(&mut partners, steps);
            Ok(BoundLaw { law, rows: laws::transform_rows(law, &rows, &scope)?, partners })
        })
        .collect::<Result<_, Diagnostic>>()?;
    let mut job = CaseJob {
        module: module.to_owned(),
        record: record.to_owned(),
        case,
        index,
        terms,
        near,
        filter,
        laws,
        oracle,
        fixtures: first.resources().map(|resource| resource.fixture.clone()).collect(),
        expected: Vec::new(),
        rows,
        kernels,
    };
    job.expected = expected_goals(&job)?;
    Ok(job)
}

/// The rows of a case, counted among those of its file.
fn counted_rows(
    file: &CaseFile,
    case: &Case,
    scope: &Scope,
    total: &Total,
    steps: &mut Steps,
) -> Result<Rows, Diagnostic> {
    let rows = cases::case_rows(case, scope, steps)?;
    total.add(&rows, case);
    total.check(file)?;
    if rows.is_empty() {
        let error = Diagnostic::error(codes::CASE_INVALID, "no row is left to try");
        return Err(placed_at(error, case));
    }
    Ok(rows)
}

/// The quantity whose closeness to a jump excuses a row, and how close that is.
fn bind_margin(case: &Case, scope: &Scope<'_>) -> Result<Option<(Formula, f64)>, Diagnostic> {
    let bind = |(text, margin): &(FormulaText, f64)| Ok((text.bind(scope)?, *margin));
    case.near.as_ref().map(bind).transpose()
}

/// Bounds the work of the functions that a law compares with.
fn limit_steps(partners: &mut [Partner], steps: u64) {
    let kernels = partners.iter_mut().flat_map(|partner| &mut partner.kernels);
    kernels.for_each(|(_, kernel)| kernel.steps = steps);
}

/// A case of a file, and what the cases of the file share.
struct CasePlace<'a, 't> {
    file: &'a CaseFile,
    index: usize,
    record: &'t str,
    total: &'t Total,
}

/// The names under which the measurements of the cases are recorded: `math::safe::saturate`, and
/// from a function's second case on `math::safe::saturate#2`.
fn record_names<'f>(module: &str, file: &'f CaseFile) -> Vec<String> {
    let mut seen: HashMap<&'f str, usize> = HashMap::new();
    let record = |case: &'f Case| {
        let earlier = seen.entry(&case.function).or_default();
        *earlier += 1;
        match *earlier {
            1 => format!("{module}::{}", case.function),
            number => format!("{module}::{}#{number}", case.function),
        }
    };
    file.cases.iter().map(record).collect()
}

/// Both languages must have the same parameters and results.
fn check_agreement(kernels: &[(Language, Kernel)]) -> Result<(), Diagnostic> {
    let kinds =
        |kernel: &Kernel| kernel.words().flat_map(|(_, shape)| shape.kinds()).collect::<Vec<_>>();
    let differs = kernels.iter().find(|(_, kernel)| {
        kinds(kernel) != kinds(&kernels[0].1)
            || kernel.result_kinds() != kernels[0].1.result_kinds()
    });
    match differs {
        Some((_, kernel)) => {
            let message = format!(
                "`{}` has other parameters or another result in the other language",
                kernel.name
            );
            Err(Diagnostic::error(codes::UNTESTABLE_FUNCTION, message))
        }
        None => Ok(()),
    }
}

fn bound_oracle(
    module: &str,
    case: &Case,
    scope: &Scope<'_>,
    kernel: &Kernel,
    options: &CheckOptions<'_>,
) -> Result<BoundOracle, Diagnostic> {
    let reference = || {
        references::find_reference(module, &case.function)
            .filter(|_| options.references)
            .map(BoundOracle::Reference)
    };
    let eval =
        || Interpreter::new(kernel).map(|interpreter| BoundOracle::Eval(Box::new(interpreter)));
    match &case.oracle {
        Oracle::Formula(text) => text.bind(scope).map(BoundOracle::Formula),
        Oracle::Table(_) | Oracle::None => Ok(BoundOracle::Fixed),
        Oracle::Eval => eval(),
        Oracle::Default => reference().map_or_else(eval, Ok),
        Oracle::Reference => reference().ok_or_else(|| {
            let message = format!("there is no reference for `{module}::{}`", case.function);
            let error =
                Diagnostic::error(codes::CASE_INVALID, message).at(case.span, "of this function");
            error.note("give a `formula`, a table of `rows`, or `oracle = \"eval\"`")
        }),
    }
}

fn expected_goals(job: &CaseJob<'_>) -> Result<Vec<Goal>, Diagnostic> {
    let expected: Vec<Goal> = match &job.case.oracle {
        Oracle::Table(table) => {
            table.iter().map(|row| Expected::words(row.expect.iter().copied()).into()).collect()
        }
        _ => job.goals(&job.rows).map_err(|error| placed_at(error, job.case))?.unwrap_or_default(),
    };
    let words = job.kernel().results.iter().map(TypeShape::words).sum::<u32>() as usize;
    match expected.iter().find(|goal| goal.expected.value.len() != words) {
        Some(wrong) => {
            let message = format!(
                "`{}` returns {words} values, but the case expects {}",
                job.case.function,
                wrong.expected.value.len()
            );
            Err(Diagnostic::error(codes::CASE_INVALID, message)
                .at(job.case.span, "of this function"))
        }
        None => Ok(expected),
    }
}

/// How many rows one parallel task evaluates.
const CHUNK: usize = 1024;

/// The value of every row in f64, with a bound on its error in f32.
pub fn bounded_goals(
    interpreter: &Interpreter,
    rows: &Rows,
    kinds: &[ScalarKind],
) -> Result<Vec<Goal>, Diagnostic> {
    let chunks: Vec<Vec<Goal>> = rows
        .words
        .par_chunks(CHUNK * rows.stride)
        .map(|words| {
            let mut calls = interpreter.calls::<Bounded>()?;
            words
                .chunks(rows.stride)
                .map(|row| bounded_row(&mut calls, row, kinds))
                .collect::<Result<_, _>>()
        })
        .collect::<Result<_, Diagnostic>>()?;
    Ok(chunks.into_iter().flatten().collect())
}

fn bounded_row(
    calls: &mut KernelCalls<'_, Bounded>,
    row: &[u32],
    kinds: &[ScalarKind],
) -> Result<Goal, Diagnostic> {
    calls.machine.forget();
    let found = calls.call(row)?;
    let expected =
        Expected::words(found.iter().zip(kinds).map(|(slot, kind)| slot_value(*slot, *kind)));
    let errors = found
        .iter()
        .zip(kinds)
        .map(|(slot, kind)| if *kind == ScalarKind::Float { slot.error() } else { 0.0 })
        .collect();
    let doubtful =
        calls.machine.findings().iter().any(|finding| finding.kind == FindingKind::Ambiguous);
    Ok(Goal { expected, errors, doubtful })
}

/// Gives the kernels of one function with the same fixtures the same code, so that executors
/// compile it once for all its cases and laws.
fn share_code(jobs: &mut [CaseJob<'_>]) {
    let mut known: Vec<(String, Vec<Arc<Fixture>>, Vec<u64>)> = Vec::new();
    let mut share = |path: String, fixtures: &[Arc<Fixture>], kernels: &mut [(_, Kernel)]| {
        let is_same =
            |(other, others, _): &&(String, Vec<_>, _)| *other == path && others == fixtures;
        match known.iter().find(is_same) {
            Some((_, _, codes)) => {
                kernels.iter_mut().zip(codes).for_each(|((_, kernel), code)| kernel.code = *code);
            }
            None => {
                let codes = kernels.iter().map(|(_, kernel)| kernel.code).collect();
                known.push((path, fixtures.to_vec(), codes));
            }
        }
    };
    for job in jobs {
        let CaseJob { module, case, fixtures, kernels, laws, .. } = job;
        share(format!("{module}::{}", case.function), fixtures, kernels);
        for law in laws {
            for (partner, name) in law.partners.iter_mut().zip(&law.law.partners) {
                let is_path = name.contains("::");
                let path = if is_path { name.clone() } else { format!("{module}::{name}") };
                share(path, &[], &mut partner.kernels);
            }
        }
    }
}

/// The steps that each case of a file may take: an equal share of the limit of the file. The order
/// in which cases run therefore makes no difference.
fn steps_of_case(file: &CaseFile) -> Steps {
    Steps::new(CASE_WORK / file.cases.len().max(1) as u64)
}

/// The sums over all cases of a file. Cases are prepared in any order, but whether a sum exceeds
/// its limit does not depend on the order.
#[derive(Default)]
struct Total {
    rows: AtomicUsize,
    words: AtomicUsize,
}

impl Total {
    /// Counts the rows of a case; each of its laws may have as many.
    pub fn add(&self, rows: &Rows, case: &Case) {
        let words = rows.words.len().saturating_mul(1 + case.laws.len());
        self.rows.fetch_add(rows.len(), Ordering::Relaxed);
        self.words.fetch_add(words, Ordering::Relaxed);
    }

    pub fn check(&self, file: &CaseFile) -> Result<(), Diagnostic> {
        let is_too_much = self.rows.load(Ordering::Relaxed) > CASE_ROWS
            || self.words.load(Ordering::Relaxed) > CASE_WORDS;
        let Some(first) = file.cases.first().filter(|_| is_too_much) else { return Ok(()) };
        let message = format!(
            "the cases of this file have more than {CASE_ROWS} rows together, or more than \
             {CASE_WORDS} scalars with those of their laws"
        );
        Err(Diagnostic::error(codes::CASE_INVALID, message).at(first.span, "the first of them"))
    }
}

/// What is evaluated for each row of a case.
struct RowFormulas<'a> {
    pub terms: &'a [BoundTerm],
    pub near: &'a Option<(Formula, f64)>,
    pub filter: &'a Option<Formula>,
    pub oracle: &'a BoundOracle,
}

impl RowFormulas<'_> {
    /// Subtracts the work of these parts from the steps, before any of it is done: for every row
    /// once for the values and once for each law.
    pub fn spend(&self, case: &Case, rows: &Rows, steps: &mut Steps) -> Result<(), Diagnostic> {
        let near = self.near.as_ref().map_or(0, |(formula, _)| formula.parts());
        let filter = self.filter.as_ref().map_or(0, Formula::parts);
        let oracle = match self.oracle {
            BoundOracle::Formula(formula) => formula.parts(),
            _ => 1,
        };
        let terms: usize = self.terms.iter().map(BoundTerm::parts).sum();
        let each = (1 + case.laws.len()).saturating_mul(rows.stride + near + filter + terms);
        cases::spend_steps(case, rows.len(), each.saturating_add(oracle), steps)
    }
}
