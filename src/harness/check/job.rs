//! A case made ready: kernels, rows, expected values. Nothing here needs an executor.

use std::sync::Arc;

use rayon::prelude::*;

use super::Subjects;
use crate::compose::Language;
use crate::diagnostic::{Diagnostic, Diagnostics, codes};
use crate::harness::cases::{self, Case, File, Oracle, Rows};
use crate::harness::fixture::Fixture;
use crate::harness::formula::{Formula, Scope};
use crate::harness::kernel::{self, Kernel, Shape};
use crate::harness::laws::{self, Law};
use crate::harness::references::{self, Arguments, Expected, Reference};
use crate::harness::tolerance::{self, Bound};

/// One case of one module.
pub struct Job<'a> {
    pub module: String,
    pub case: &'a Case,
    pub kernels: Vec<(Language, Kernel)>,
    pub rows: Rows,
    /// For each row; empty where the case has laws alone.
    pub expected: Vec<Expected>,
    pub terms: Vec<Bound>,
    pub near: Option<(Formula, f64)>,
    pub filter: Option<Formula>,
    pub laws: Vec<BoundLaw<'a>>,
    pub oracle: Judge,
    pub fixtures: Vec<Arc<Fixture>>,
}

/// A law and the rows it compares with.
pub struct BoundLaw<'a> {
    pub law: &'a Law,
    pub rows: Option<Rows>,
}

/// Gives the expected value of any row: shrinking asks for rows that no case lists.
pub enum Judge {
    Reference(Reference),
    Formula(Formula),
    /// A table or nothing: rows cannot be changed.
    Fixed,
}

impl Job<'_> {
    /// What a row should give, if the oracle can tell.
    pub fn expect(&self, row: &[f64]) -> Option<Expected> {
        match &self.oracle {
            Judge::Reference(reference) => Some(reference(&mut Arguments::new(row, &self.fixtures))),
            Judge::Formula(formula) => Some(Expected::words(formula.eval(row))),
            Judge::Fixed => None,
        }
    }

    /// The kernel whose parameters name the columns: the first language's.
    pub fn kernel(&self) -> &Kernel {
        &self.kernels[0].1
    }
}

/// The jobs of a module's case file.
pub fn prepare<'a>(module: &str, file: &'a File, languages: &[Language], subjects: &Subjects<'_>) -> Result<Vec<Job<'a>>, Diagnostics> {
    let mut functions: Vec<String> = file.cases.iter().map(|case| case.function.clone()).collect();
    functions.sort();
    functions.dedup();
    let modules: Vec<_> = languages
        .iter()
        .map(|language| Ok((*language, subjects(module, *language, &functions)?)))
        .collect::<Result<_, Diagnostics>>()
        .map_err(|errors| errors.into_iter().map(|error| placed(error, file)).collect::<Vec<_>>())?;
    let jobs: Vec<_> = file.cases.par_iter().map(|case| job(module, case, &modules)).collect();
    let (mut done, mut errors) = (Vec::new(), Vec::new());
    for result in jobs {
        match result {
            Ok(job) => done.push(job),
            Err(error) => errors.push(error),
        }
    }
    if errors.is_empty() { Ok(done) } else { Err(errors) }
}

/// An error without a place is put at the case that names the function it is about.
fn placed(error: Diagnostic, file: &File) -> Diagnostic {
    let about = file.cases.iter().find(|case| error.message.contains(&format!("`{}`", case.function)));
    match about {
        Some(case) if error.labels.is_empty() => error.at(case.span, "named here"),
        _ => error,
    }
}

fn job<'a>(module: &str, case: &'a Case, modules: &[(Language, Arc<naga::Module>)]) -> Result<Job<'a>, Diagnostic> {
    let placed = |error: Diagnostic| if error.labels.is_empty() { error.at(case.span, "in this case") } else { error };
    let kernels: Vec<(Language, Kernel)> = modules
        .iter()
        .map(|(language, naga)| Ok((*language, kernel::build(naga, &case.function, &case.fixtures)?)))
        .collect::<Result<_, Diagnostic>>()
        .map_err(placed)?;
    let Some((_, first)) = kernels.first() else { return Err(placed(Diagnostic::error(codes::CASE_INVALID, "no language was chosen"))) };
    agree(&kernels).map_err(placed)?;
    let scope = Scope(first.words().collect());
    let rows = cases::rows(case, &scope)?;
    if rows.is_empty() {
        return Err(placed(Diagnostic::error(codes::CASE_INVALID, "no row is left to try")));
    }
    let terms = tolerance::bind(&case.tolerance, &scope, &first.results).map_err(placed)?;
    let laws = case
        .laws
        .iter()
        .map(|law| Ok(BoundLaw { law, rows: laws::transformed(law, &rows, &scope)? }))
        .collect::<Result<_, Diagnostic>>()?;
    let mut job = Job {
        module: module.to_owned(),
        case,
        terms,
        near: case.near.as_ref().map(|(text, margin)| Ok::<_, Diagnostic>((text.bind(&scope)?, *margin))).transpose()?,
        filter: case.filter().map(|text| text.bind(&scope)).transpose()?,
        laws,
        oracle: judge(module, case, &scope)?,
        fixtures: first.resources().map(|resource| resource.fixture.clone()).collect(),
        expected: Vec::new(),
        rows,
        kernels,
    };
    job.expected = expected(&job)?;
    Ok(job)
}

/// Both languages must have the same parameters and results.
fn agree(kernels: &[(Language, Kernel)]) -> Result<(), Diagnostic> {
    let kinds = |kernel: &Kernel| kernel.words().flat_map(|(_, shape)| shape.kinds()).collect::<Vec<_>>();
    let differs =
        kernels.iter().find(|(_, kernel)| kinds(kernel) != kinds(&kernels[0].1) || kernel.result_kinds() != kernels[0].1.result_kinds());
    match differs {
        Some((_, kernel)) => {
            let message = format!("`{}` has other parameters or another result in the other language", kernel.name);
            Err(Diagnostic::error(codes::UNTESTABLE_FUNCTION, message))
        }
        None => Ok(()),
    }
}

fn judge(module: &str, case: &Case, scope: &Scope<'_>) -> Result<Judge, Diagnostic> {
    match &case.oracle {
        Oracle::Formula(text) => text.bind(scope).map(Judge::Formula),
        Oracle::Table(_) | Oracle::None => Ok(Judge::Fixed),
        Oracle::Reference => references::find(module, &case.function).map(Judge::Reference).ok_or_else(|| {
            let message = format!("there is no reference for `{module}::{}`", case.function);
            let error = Diagnostic::error(codes::CASE_INVALID, message).at(case.span, "of this function");
            error.note("give a `formula`, a table of `rows`, or `oracle = \"none\"` with laws")
        }),
    }
}

fn expected(job: &Job<'_>) -> Result<Vec<Expected>, Diagnostic> {
    let expected: Vec<Expected> = match &job.case.oracle {
        Oracle::Table(table) => table.iter().map(|row| Expected::words(row.expect.iter().copied())).collect(),
        _ => (0..job.rows.len()).into_par_iter().filter_map(|index| job.expect(job.rows.row(index))).collect(),
    };
    let words = job.kernel().results.iter().map(Shape::words).sum::<u32>() as usize;
    match expected.iter().find(|expected| expected.value.len() != words) {
        Some(wrong) => {
            let message = format!("`{}` returns {words} values, {} are expected of it", job.case.function, wrong.value.len());
            Err(Diagnostic::error(codes::CASE_INVALID, message).at(job.case.span, "of this function"))
        }
        None => Ok(expected),
    }
}
