//! Judges laws about several functions, with kernels of the other functions.

use std::collections::BTreeMap;

use super::job::{BoundLaw, Job};
use super::judge;
use super::law::LawVerdict;
use super::{Language, Session, Subjects};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::execute::kernel::{self, Kernel, word_value};
use crate::proof::cases::{Rows, word_of};
use crate::proof::formula::{Formula, Scope};
use crate::proof::laws::{Albedo, Inverse, Law, Wanted};

/// Another function that a law is about.
pub struct Partner {
    pub kernels: Vec<(Language, Kernel)>,
    /// The arguments that it is called with, where they do not depend on results.
    rows: Option<Rows>,
}

/// The partners of a law, ready to run.
pub fn prepare_partners(
    law: &Law,
    module: &str,
    languages: &[Language],
    subjects: &Subjects<'_>,
    rows: &Rows,
    scope: &Scope<'_>,
) -> Result<Vec<Partner>, Diagnostic> {
    let partner = |name: &String| {
        let (module, function) = name.rsplit_once("::").unwrap_or((module, name));
        let kernels = languages
            .iter()
            .map(|language| {
                let found = subjects(module, *language, &[function.to_owned()])
                    .map_err(|errors| first_error(errors, law, name))?;
                let kernel = kernel::build_kernel(&found, function, &BTreeMap::new());
                Ok((*language, kernel.map_err(|error| error.at(law.span, "named here"))?))
            })
            .collect::<Result<Vec<_>, Diagnostic>>()?;
        let factor = |albedo: &Albedo| {
            let parameters = kernels.iter().take(1).flat_map(|(_, kernel)| kernel.words());
            albedo.rows(rows, scope, &Scope(parameters.collect()), law.span)
        };
        Ok(Partner { rows: law.albedo.as_ref().map(factor).transpose()?, kernels })
    };
    law.partners.iter().map(partner).collect()
}

fn first_error(errors: Diagnostics, law: &Law, name: &str) -> Diagnostic {
    let found = errors.into_iter().next();
    let error = found.unwrap_or_else(|| {
        let message = format!("there is no function `{name}`");
        Diagnostic::error(crate::diagnostic::codes::UNKNOWN_FUNCTION, message)
    });
    if error.labels.is_empty() { error.at(law.span, "named here") } else { error }
}

/// Judges a law that has partners; `results` are those of the case's own rows.
pub fn judge_partners(
    job: &Job<'_>,
    bound: &BoundLaw<'_>,
    language: Language,
    results: &[u32],
    session: &mut dyn Session,
) -> Result<Option<LawVerdict>, Diagnostic> {
    match (&bound.law.albedo, &bound.law.inverse, bound.partners.first()) {
        (Some(rule), _, Some(_)) => {
            judge_albedo(job, bound, rule, language, results, session).map(Some)
        }
        (None, Some(rule), Some(partner)) => {
            judge_inverse(job, (bound.law, rule, partner), language, results, session).map(Some)
        }
        _ => Ok(None),
    }
}

/// The components of a function's values, one list for each call.
type Values = Vec<Vec<f64>>;

fn run_partner(
    partner: &Partner,
    language: Language,
    rows: &Rows,
    session: &mut dyn Session,
) -> Result<Values, Diagnostic> {
    let Some((_, kernel)) = partner.kernels.iter().find(|(known, _)| *known == language) else {
        return Ok(Vec::new());
    };
    let words = session.run(kernel, &rows.words)?;
    let kinds = kernel.result_kinds();
    let call = |words: &[u32]| -> Vec<f64> {
        words.iter().zip(&kinds).map(|(word, kind)| word_value(*word, *kind)).collect()
    };
    Ok(words.chunks(kinds.len().max(1)).map(call).collect())
}

/// The product, component by component. A single number is multiplied with every component.
fn component_product(left: &Values, right: &Values) -> Values {
    let pick = |values: &[f64], index: usize| values[if values.len() == 1 { 0 } else { index }];
    let one = |(a, b): (&Vec<f64>, &Vec<f64>)| {
        (0..a.len().max(b.len())).map(|index| pick(a, index) * pick(b, index)).collect()
    };
    left.iter().zip(right).map(one).collect()
}

fn judge_albedo(
    job: &Job<'_>,
    bound: &BoundLaw<'_>,
    rule: &Albedo,
    language: Language,
    results: &[u32],
    session: &mut dyn Session,
) -> Result<LawVerdict, Diagnostic> {
    let scope = Scope(job.kernel().words().collect());
    let mut values: Option<Values> = None;
    for partner in &bound.partners {
        let Some(rows) = &partner.rows else { continue };
        let found = run_partner(partner, language, rows, session)?;
        values = Some(values.map_or(found.clone(), |values| component_product(&values, &found)));
    }
    let values = values.unwrap_or_default();
    let wanted = wanted_formula(rule, &scope)?;
    let mut verdict = LawVerdict::new(bound.law);
    let components = match rule.component {
        Some(component) => component..component + 1,
        None => 0..values.first().map_or(0, Vec::len),
    };
    for component in components {
        let column: Vec<f64> = values.iter().map(|call| component_of(call, component)).collect();
        let sums = rule.sums(&job.rows, &scope, &column)?;
        for (row, sum) in rule.chosen(&job.rows).into_iter().zip(sums) {
            let inputs = job.rows.row(row);
            let wanted = match &wanted {
                Some(formula) => component_of(&formula.eval(inputs), component),
                None => own_component(job, results, row, component),
            };
            let at_most = matches!(rule.wanted, Wanted::AtMost(_));
            let off = if at_most { (sum - wanted).max(0.0) } else { (sum - wanted).abs() };
            // An error of NaN counts as too large.
            if off.is_nan() || off > rule.within {
                verdict.broken += 1;
                let most = if at_most { "at most " } else { "" };
                verdict.example.get_or_insert_with(|| {
                    format!(
                        "{inputs:?}: the integral is {sum}, expected {most}{wanted}: off by {off:e}"
                    )
                });
            }
        }
    }
    Ok(verdict)
}

fn wanted_formula(rule: &Albedo, scope: &Scope<'_>) -> Result<Option<Formula>, Diagnostic> {
    match &rule.wanted {
        Wanted::Own => Ok(None),
        Wanted::Exactly(text) | Wanted::AtMost(text) => text.bind(scope).map(Some),
    }
}

/// A component of a formula's value. A single number stands for every component.
fn component_of(values: &[f64], component: usize) -> f64 {
    let index = if values.len() == 1 { 0 } else { component };
    values.get(index).copied().unwrap_or(f64::NAN)
}

/// A component of what the case's function gave.
fn own_component(job: &Job<'_>, results: &[u32], row: usize, component: usize) -> f64 {
    let kinds = job.kernel().result_kinds();
    let component = if kinds.len() == 1 { 0 } else { component };
    results
        .get(row * kinds.len() + component)
        .map_or(f64::NAN, |word| word_value(*word, kinds[component]))
}

fn judge_inverse(
    job: &Job<'_>,
    (law, rule, partner): (&Law, &Inverse, &Partner),
    language: Language,
    results: &[u32],
    session: &mut dyn Session,
) -> Result<LawVerdict, Diagnostic> {
    let scope = Scope(job.kernel().words().collect());
    let mut verdict = LawVerdict::new(law);
    let Some((_, kernel)) = partner.kernels.first() else { return Ok(verdict) };
    let path = rule.of.clone().or_else(|| Some(scope.0.first()?.0.to_owned())).unwrap_or_default();
    let target = scope.find(std::slice::from_ref(&path));
    let (first, shape) = target.ok_or_else(|| scope.unknown(&path).at(law.span, "in this law"))?;
    let rows = inverse_rows(job, kernel, &scope, results);
    let found = run_partner(partner, language, &rows, session)?;
    for (row, found) in found.iter().enumerate() {
        let inputs = job.rows.row(row);
        let unknown = job.expected.get(row).is_some_and(judge::is_indeterminate);
        if unknown || judge::is_ambiguous(job, inputs) {
            continue;
        }
        let wanted = &inputs[first..first + shape.words() as usize];
        let off = |(found, wanted): (&f64, &f64)| (found - wanted).abs() / wanted.abs().max(1.0);
        let worst = found.iter().zip(wanted).map(off).fold(0.0, nan_max);
        if worst.is_nan() || worst > rule.within || found.len() != wanted.len() {
            verdict.broken += 1;
            verdict.example.get_or_insert_with(|| {
                format!("{inputs:?}: `{}` leads back to {found:?}, off by {worst:e}", kernel.name)
            });
        }
    }
    Ok(verdict)
}

/// The larger number; NaN if one of them is NaN.
fn nan_max(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}

/// The calls of the inverse: the value's words first, then parameters of the case by name.
fn inverse_rows(job: &Job<'_>, kernel: &Kernel, scope: &Scope<'_>, results: &[u32]) -> Rows {
    let kinds: Vec<_> = kernel.words().flat_map(|(_, shape)| shape.kinds()).collect();
    let (count, own) = (job.kernel().result_words() as usize, job.kernel().result_kinds());
    let mut words = Vec::new();
    for (row, value) in results.chunks(count.max(1)).enumerate() {
        let mut call: Vec<f64> =
            value.iter().zip(&own).map(|(word, kind)| word_value(*word, *kind)).collect();
        for (name, shape) in kernel.words() {
            let at = scope.find(&[name.to_owned()]);
            if let Some((first, _)) = at.filter(|_| call.len() < kinds.len()) {
                let inputs = &job.rows.row(row)[first..first + shape.words() as usize];
                call.extend(inputs);
            }
        }
        call.resize(kinds.len(), 0.0);
        words.extend(call.iter().zip(&kinds).map(|(value, kind)| word_of(*value, *kind)));
    }
    Rows::of(words, kinds)
}
