//! Prepares a module and its cases to be run many times, on the evaluator in f32, and orders the
//! rows so that those that notice most are tried first.

use crate::report::Fate;
use crate::site::{Site, apply_mutation, author_span};
use lamplight_bundle::Language;
use lamplight_check::cases::{CaseFile, Rows};
use lamplight_check::check::job::{BoundOracle, CaseJob, Goal};
use lamplight_check::check::law::RowResults;
use lamplight_check::check::{CheckOptions, CheckedModule, job, law, verdict};
use lamplight_check::library::Library;
use lamplight_check::tolerance;
use lamplight_compose::SourceMap;
use lamplight_diagnostic::source::SourceSet;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_eval::Machine;
use lamplight_execute::interpreter::{Interpreter, KernelCalls, slot_value, word_of};
use lamplight_execute::kernel::Kernel;
use lamplight_execute::module_info;
use naga::valid::ModuleInfo;
use naga::{Expression, Function, Handle, Module, ScalarKind};
use rayon::prelude::*;
use std::sync::{Arc, Mutex};

/// The most loop iterations of one call: many times what any case needs, and few enough to stop a
/// mutant soon that loops without end.
pub const TRIPS: u64 = 20_000;

/// How many rows are run before the results are checked for the first time. Each later batch is
/// four times as large.
const FIRST_BATCH: usize = 48;

/// Two parts of the allowed error in f64: a share of the value, and a share of the error that the
/// case allows in f32. The second is 8 times the ratio of the rounding errors, which is 2^-29: a
/// margin for functions that round more often in f64 than their error model counts.
const RELATIVE: f64 = 1e-9;
const OF_STATED: f64 = 1.0 / (1u64 << 26) as f64;

/// A library module.
pub struct Suite<'f> {
    pub module: String,
    pub map: SourceMap,
    /// Everything that the module declares and reaches, compacted as kernels are.
    pub whole: Module,
    pub info: ModuleInfo,
    /// The module's own functions.
    pub subjects: Vec<Subject>,
    pub cases: Vec<ReadyCase<'f>>,
}

/// A function that the module itself declares.
pub struct Subject {
    pub function: Handle<Function>,
    pub name: String,
}

/// A case with its rows in batches. Rows that probably notice a mistake come first.
pub struct ReadyCase<'f> {
    pub job: CaseJob<'f>,
    order: Vec<usize>,
    pub batches: Vec<RowBatch>,
}

/// Rows with their expected values.
pub struct RowBatch {
    pub rows: Rows,
    pub expected: Vec<Goal>,
    /// The allowed error of each word in f64: twice the error of the code without a mistake, which
    /// comes from its constants in f32, and the parts `RELATIVE` and `OF_STATED`. It is infinite
    /// where the oracle is the code itself or accepts every value, or the code without a mistake is
    /// off by more than the case states.
    slack: Vec<f64>,
}

/// A module's path, and its cases if it has any.
pub type NamedCases = (String, Option<CaseFile>);

/// The case files of the modules.
pub fn case_files(
    library: &Library,
    sources: &Mutex<SourceSet>,
    modules: &[String],
) -> Result<Vec<NamedCases>, Diagnostics> {
    let present = library.case_files();
    let read = |module: &String| {
        let path = format!("{}.toml", module.replace("::", "/"));
        if !present.contains(&path) {
            return Ok((module.clone(), None));
        }
        Ok((module.clone(), library.read(sources, &[path])?.pop().map(|(_, file)| file)))
    };
    modules.iter().map(read).collect()
}

/// Composes the modules and prepares their cases. With `partners`, laws about several functions are
/// among these.
pub fn make_suites<'f>(
    library: &Library,
    sources: &Mutex<SourceSet>,
    files: &'f [NamedCases],
    partners: bool,
) -> Result<Vec<Suite<'f>>, Diagnostics> {
    files
        .par_iter()
        .map(|(module, file)| make_suite((library, sources), module, file.as_ref(), partners))
        .collect()
}

fn make_suite<'f>(
    (library, sources): (&Library, &Mutex<SourceSet>),
    module: &str,
    file: Option<&'f CaseFile>,
    partners: bool,
) -> Result<Suite<'f>, Diagnostics> {
    let (composed, validated) = library.whole(sources, module)?;
    let mut whole = validated.module;
    let parsed = Arc::new(whole.clone());
    naga::compact::compact(&mut whole, naga::compact::KeepUnused::Yes);
    let info = module_info(module, &whole).map_err(|_| vec![internal_error(module)])?;
    let subjects = find_subjects(sources, module, &composed.map, &whole);
    let jobs = match file {
        Some(file) => job::prepare_jobs(
            module,
            file,
            &[Language::Wesl],
            &|other, language, functions| match other == module {
                true => Ok(CheckedModule::without_text(parsed.clone())),
                false => library.checked_module(sources, other, language, functions),
            },
            // Where the results of a mutant are compared with the case's oracle, laws about several
            // functions are left out.
            &CheckOptions { partners, ..CheckOptions::default() },
        )?,
        None => Vec::new(),
    };
    let cases = jobs.into_par_iter().map(ready_job).collect::<Result<_, _>>()?;
    Ok(Suite { module: module.to_owned(), map: composed.map, whole, info, subjects, cases })
}

fn internal_error(name: &str) -> Diagnostic {
    Diagnostic::error(codes::EVAL_INTERNAL, format!("`{name}` is not valid after compaction"))
}

fn find_subjects(
    sources: &Mutex<SourceSet>,
    module: &str,
    map: &SourceMap,
    whole: &Module,
) -> Vec<Subject> {
    let Ok(sources) = sources.lock() else { return Vec::new() };
    let file = format!("{}.wesl", module.replace("::", "/"));
    let own = |handle| {
        author_span(map, whole.functions.get_span(handle))
            .is_some_and(|span| is_file(&sources.get(span.source).path, &file))
    };
    let named = whole.functions.iter().filter(|(handle, _)| own(*handle));
    named
        .map(|(function, found)| Subject { function, name: found.name.clone().unwrap_or_default() })
        .collect()
}

fn is_file(path: &str, file: &str) -> bool {
    path == file || path.strip_suffix(file).is_some_and(|rest| rest.ends_with('/'))
}

fn ready_job(job: CaseJob<'_>) -> Result<ReadyCase<'_>, Diagnostics> {
    let order = row_order(&job.rows);
    let interpreter = Interpreter::new(job.kernel()).map_err(|error| vec![error])?;
    let mut calls = interpreter.calls::<f64>().map_err(|error| vec![error])?;
    let mut batches = Vec::new();
    let (mut from, mut size) = (0, FIRST_BATCH);
    while from < order.len() && !job.expected.is_empty() {
        let chosen = &order[from..order.len().min(from + size)];
        let words = chosen.iter().flat_map(|row| job.rows.row_words(*row)).copied().collect();
        let (rows, expected) = (
            job.rows.with_words(words),
            chosen.iter().map(|row| job.expected[*row].clone()).collect::<Vec<_>>(),
        );
        let slack = row_slack(&job, &rows, &expected, &mut calls).map_err(|error| vec![error])?;
        batches.push(RowBatch { rows, expected, slack });
        (from, size) = (from + size, size * 4);
    }
    drop(calls);
    Ok(ReadyCase { order, batches, job })
}

fn row_slack(
    job: &CaseJob<'_>,
    rows: &Rows,
    expected: &[Goal],
    calls: &mut KernelCalls<'_, f64>,
) -> Result<Vec<f64>, Diagnostic> {
    let kinds = job.kernel().result_kinds();
    let mut slack = Vec::new();
    for (index, goal) in expected.iter().enumerate() {
        let found = exact_result(calls, rows.row_words(index), &kinds)?;
        let values = tolerance::formula_values(&job.terms, rows.row(index));
        let is_known =
            !matches!(job.oracle, BoundOracle::Eval(_)) && !verdict::is_indeterminate(goal);
        slack.extend((0..kinds.len()).map(|word| {
            let value = goal.expected.value[word];
            let stated = tolerance::allowed_error(&job.terms, &values, word, value);
            let off = nearest_distance(goal, &found, word);
            let own = 2.0 * off + RELATIVE * value.abs() + OF_STATED * stated;
            if is_known && off <= stated { own } else { f64::INFINITY }
        }));
    }
    Ok(slack)
}

/// The result of one row in f64.
pub fn exact_result(
    calls: &mut KernelCalls<'_, f64>,
    row: &[u32],
    kinds: &[ScalarKind],
) -> Result<Vec<f64>, Diagnostic> {
    Ok(calls.call(row)?.iter().zip(kinds).map(|(slot, kind)| slot_value(*slot, *kind)).collect())
}

/// The distance of a word from the nearest accepted value.
fn nearest_distance(goal: &Goal, found: &[f64], word: usize) -> f64 {
    let all = std::iter::once(&goal.expected.value).chain(&goal.expected.alternatives);
    all.map(
        |value| if found[word] == value[word] { 0.0 } else { (found[word] - value[word]).abs() },
    )
    .fold(f64::INFINITY, f64::min)
}

impl Suite<'_> {
    /// Checks that every case passes without a mistake put in. The error is about the first one
    /// that does not.
    pub fn check(&self) -> Result<(), Diagnostic> {
        self.cases.iter().try_for_each(|case| {
            let named = case.job.case;
            let notices =
                case.interpreter(&case.job.kernel().module).and_then(|it| case.notices(&it));
            match notices.map_err(|error| error.at(named.span, "in this case"))? {
                false => Ok(()),
                true => {
                    let message = format!("`{}` fails this case as it is", named.function);
                    Err(Diagnostic::error(codes::CASE_INVALID, message)
                        .at(named.span, "in this case"))
                }
            }
        })
    }

    /// What becomes of the mutant with this mistake; `None` if the mutant is not valid.
    pub fn fate(&self, subject: &Subject, site: &Site) -> Option<Fate> {
        let reaching = |case: &&ReadyCase<'_>| {
            find_function(&case.job.kernel().module, &subject.name).is_some()
        };
        let (own, others): (Vec<_>, Vec<_>) = self
            .cases
            .iter()
            .filter(reaching)
            .partition(|case| case.job.case.function == subject.name);
        let mut fate =
            if own.is_empty() && others.is_empty() { Some(Fate::Unreached) } else { None };
        for case in own.into_iter().chain(others) {
            fate = self.run(case, subject, site);
            if fate != Some(Fate::Survived) {
                break;
            }
        }
        fate
    }

    /// Whether the mutant can be run.
    pub fn is_valid(&self, subject: &Subject, site: &Site) -> bool {
        let mutants =
            self.cases.iter().filter_map(|case| self.mutant(case.job.kernel(), subject, site));
        mutants.take(1).all(|module| module_info(&self.module, &module).is_ok())
    }

    /// The module of a kernel with the mistake; `None` if it has no place for it.
    fn mutant(&self, kernel: &Kernel, subject: &Subject, site: &Site) -> Option<Module> {
        let mut module = kernel.module.clone();
        let ty = |handle: Handle<Expression>| {
            Some(self.info[subject.function][handle].ty.inner_with(&self.whole.types).clone())
        };
        let function = find_function(&module, &subject.name)?;
        apply_mutation(module.functions.get_mut(function), site, ty).then_some(module)
    }

    fn run(&self, case: &ReadyCase<'_>, subject: &Subject, site: &Site) -> Option<Fate> {
        let module = self.mutant(case.job.kernel(), subject, site)?;
        let interpreter = case.interpreter(&module).ok()?;
        // A mutant that takes too many steps is an error, and is noticed too.
        Some(if case.notices(&interpreter).unwrap_or(true) { Fate::Killed } else { Fate::Survived })
    }
}

pub fn find_function(module: &Module, name: &str) -> Option<Handle<Function>> {
    module
        .functions
        .iter()
        .find(|(_, function)| function.name.as_deref() == Some(name))
        .map(|(handle, _)| handle)
}

impl ReadyCase<'_> {
    /// An interpreter for the kernel's module, or for a changed copy of it. All rows run twice, in
    /// f64 and in f32, and once more for each law with rows of its own. Each time may take the
    /// steps of a case.
    pub fn interpreter(&self, module: &Module) -> Result<Interpreter, Diagnostic> {
        let with_rows = self.job.laws.iter().filter(|law| law.rows.is_some()).count();
        let times = 2 + with_rows as u64;
        Ok(Interpreter::of(self.job.kernel(), module)?.with_steps_times(times))
    }

    /// Whether the case fails for the mutant: a value is wrong, a law is broken, or too many rows
    /// are ambiguous.
    fn notices(&self, interpreter: &Interpreter) -> Result<bool, Diagnostic> {
        Ok(self.is_off(interpreter)? || self.fails(interpreter)?)
    }

    /// Whether a value in f64 differs from the oracle in any of the digits that are compared.
    pub fn is_off(&self, interpreter: &Interpreter) -> Result<bool, Diagnostic> {
        let kinds = self.job.kernel().result_kinds();
        let mut calls = interpreter.calls::<f64>()?;
        calls.machine.loop_limit = TRIPS;
        for batch in &self.batches {
            for (index, goal) in batch.expected.iter().enumerate() {
                let found = exact_result(&mut calls, batch.rows.row_words(index), &kinds)?;
                let slack = &batch.slack[index * kinds.len()..];
                // NaN is infinitely far from every value, unless the oracle accepts every result.
                if (0..kinds.len()).any(|word| nearest_distance(goal, &found, word) > slack[word]) {
                    return Ok(true);
                }
            }
        }
        Ok(false)
    }

    /// Whether a row in f32, or a law, fails as `lamplight check` checks them.
    fn fails(&self, interpreter: &Interpreter) -> Result<bool, Diagnostic> {
        let mut runner = RowRunner::new(self.job.kernel(), interpreter)?;
        let words = self.job.kernel().result_words() as usize;
        let mut results = vec![0; words * self.job.rows.len()];
        let mut order = self.order.iter();
        for RowBatch { rows, expected, .. } in &self.batches {
            let found = runner.run(&rows.words)?;
            if !verdict::check_rows(&self.job, rows, expected, &found).failing.is_empty() {
                return Ok(true);
            }
            found.chunks(words).zip(&mut order).for_each(|(found, row)| {
                results[row * words..(row + 1) * words].copy_from_slice(found)
            });
        }
        if self.batches.is_empty() {
            results = runner.run(&self.job.rows.words)?;
        }
        if verdict::check_rows(&self.job, &self.job.rows, &self.job.expected, &results)
            .too_ambiguous
        {
            return Ok(true);
        }
        for law in &self.job.laws {
            let transformed = law.rows.as_ref().map(|rows| runner.run(&rows.words)).transpose()?;
            let transformed = law.rows.as_ref().zip(transformed.as_deref());
            let given = RowResults {
                rows: &self.job.rows,
                expected: &self.job.expected,
                results: &results,
                transformed,
            };
            if law::check_law(&self.job, law.law, &given).broken > 0 {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Runs every row of the case, and shows `seen` what the machine recorded.
    pub fn record(
        &self,
        interpreter: &Interpreter,
        seen: &mut dyn FnMut(&Machine<'_, f32>),
    ) -> Result<(), Diagnostic> {
        let mut runner = RowRunner::new(self.job.kernel(), interpreter)?;
        runner.run(&self.job.rows.words)?;
        seen(&runner.calls.machine);
        Ok(())
    }
}

/// Runs rows of a kernel in f32.
pub struct RowRunner<'p> {
    pub calls: KernelCalls<'p, f32>,
    kinds: Vec<ScalarKind>,
    stride: usize,
}

impl<'p> RowRunner<'p> {
    pub fn new(kernel: &Kernel, interpreter: &'p Interpreter) -> Result<Self, Diagnostic> {
        let mut calls = interpreter.calls::<f32>()?;
        calls.machine.loop_limit = TRIPS;
        Ok(Self { calls, kinds: kernel.result_kinds(), stride: kernel.input_words() as usize })
    }

    /// Runs the rows. A function without parameters has one row.
    pub fn run(&mut self, inputs: &[u32]) -> Result<Vec<u32>, Diagnostic> {
        let mut results = Vec::new();
        let count = inputs.len().checked_div(self.stride).unwrap_or(1);
        for row in 0..count {
            let found = self.calls.call(&inputs[row * self.stride..(row + 1) * self.stride])?;
            results.extend(found.iter().zip(&self.kinds).map(|(slot, kind)| word_of(*slot, *kind)));
        }
        Ok(results)
    }
}

/// An order of the rows in which rows with simple values, or at the ends of their columns,
/// alternate with rows from everywhere.
fn row_order(rows: &Rows) -> Vec<usize> {
    let column = |index: usize| (0..rows.len()).map(move |row| rows.row(row)[index]);
    let ends: Vec<(f64, f64)> = (0..rows.stride.min(rows.row(0).len()))
        .map(|index| {
            (
                column(index).fold(f64::INFINITY, f64::min),
                column(index).fold(f64::NEG_INFINITY, f64::max),
            )
        })
        .collect();
    let is_edge = |(value, (low, high)): (&f64, &(f64, f64))| {
        value == low || value == high || *value == 0.0 || value.abs() == 1.0
    };
    let edges = |row: usize| rows.row(row).iter().zip(&ends).filter(|pair| is_edge(*pair)).count();
    // With a step near the golden section the rows are visited evenly.
    let count = rows.len();
    let step = (1..=count)
        .rev()
        .find(|step| *step as f64 <= count as f64 * 0.618 && gcd(*step, count) == 1)
        .unwrap_or(1);
    let spread = (0..count).map(|index| index * step % count);
    let mut by_edges: Vec<usize> = spread.clone().collect();
    by_edges.sort_by_key(|row| std::cmp::Reverse(edges(*row)));
    let mut seen = vec![false; count];
    spread
        .zip(by_edges)
        .flat_map(|(even, edge)| [even, edge])
        .filter(|row| !std::mem::replace(&mut seen[*row], true))
        .collect()
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}
