//! Checks laws about several functions, with kernels of the other functions.

use std::collections::BTreeMap;

use super::job::{BoundLaw, CaseJob};
use super::law::{LawVerdict, amount_text};
use super::profile::{components_text, parameters_text};
use super::verdict;
use super::{Language, Session, Subjects};
use crate::cases::{Rows, word_of};
use crate::formula::{Formula, Scope};
use crate::laws::{self, Albedo, Area, Equality, IntegralValue, Inverse, Law};
use lamplight_diagnostic::{Diagnostic, Diagnostics};
use lamplight_execute::kernel::{Kernel, word_value};
use naga::ScalarKind;

/// Another function that a law is about.
pub struct Partner {
    pub kernels: Vec<(Language, Kernel)>,
    /// The arguments of its calls. `None` for the law `inverse`, whose arguments are results of the
    /// case.
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
    let partner = |(index, name): (usize, &String)| {
        let (module, function) = name.rsplit_once("::").unwrap_or((module, name));
        let kernels = languages
            .iter()
            .map(|language| {
                let found = subjects(module, *language, &[function.to_owned()])
                    .map_err(|errors| first_error(errors, law, name))?;
                let kernel = found.kernel(function, &BTreeMap::new());
                Ok((*language, kernel.map_err(|error| error.at(law.span, "named here"))?))
            })
            .collect::<Result<Vec<_>, Diagnostic>>()?;
        let parameters = kernels.iter().take(1).flat_map(|(_, kernel)| kernel.words());
        let own = Scope(parameters.collect());
        Ok(Partner { rows: laws::partner_rows(law, index, rows, (scope, &own))?, kernels })
    };
    law.partners.iter().enumerate().map(partner).collect()
}

fn first_error(errors: Diagnostics, law: &Law, name: &str) -> Diagnostic {
    let found = errors.into_iter().next();
    let error = found.unwrap_or_else(|| {
        let message = format!("there is no function `{name}`");
        Diagnostic::error(lamplight_diagnostic::codes::UNKNOWN_FUNCTION, message)
    });
    if error.labels.is_empty() { error.at(law.span, "named here") } else { error }
}

/// Checks a law that has partners; `None` for other laws. `results` are those of the case's own
/// rows.
pub fn check_partners(
    job: &CaseJob<'_>,
    bound: &BoundLaw<'_>,
    language: Language,
    results: &[u32],
    session: &mut dyn Session,
) -> Result<Option<LawVerdict>, Diagnostic> {
    let law = bound.law;
    if let Some((rule, partner)) = law.inverse.as_ref().zip(bound.partners.first()) {
        return check_inverse(job, (law, rule, partner), language, results, session).map(Some);
    }
    if bound.partners.is_empty() {
        return Ok(None);
    }
    let values = partner_product(bound, language, session)?;
    if values.is_empty() {
        let example = Some("no row is left to compare".to_owned());
        return Ok(Some(LawVerdict { broken: 1, example, ..LawVerdict::new(law) }));
    }
    let verdict = match (&law.albedo, &law.area, &law.equality) {
        (Some(rule), ..) => check_albedo(job, law, rule, &values, results)?,
        (_, Some(rule), _) => check_area(job, law, rule, &values, results)?,
        (_, _, Some(rule)) => check_equality(job, law, rule, &values, results),
        _ => return Ok(None),
    };
    Ok(Some(verdict))
}

/// The components of a function's values, one list for each call.
type PartnerValues = Vec<Vec<f64>>;

fn run_partner(
    partner: &Partner,
    language: Language,
    rows: &Rows,
    session: &mut dyn Session,
) -> Result<PartnerValues, Diagnostic> {
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
fn component_product(left: &PartnerValues, right: &PartnerValues) -> PartnerValues {
    let pick = |values: &[f64], index: usize| values[if values.len() == 1 { 0 } else { index }];
    let one = |(a, b): (&Vec<f64>, &Vec<f64>)| {
        (0..a.len().max(b.len())).map(|index| pick(a, index) * pick(b, index)).collect()
    };
    left.iter().zip(right).map(one).collect()
}

/// The product of the law's functions, one value for each call.
fn partner_product(
    bound: &BoundLaw<'_>,
    language: Language,
    session: &mut dyn Session,
) -> Result<PartnerValues, Diagnostic> {
    let mut values: Option<PartnerValues> = None;
    for partner in &bound.partners {
        let Some(rows) = &partner.rows else { continue };
        let found = run_partner(partner, language, rows, session)?;
        values = Some(values.map_or(found.clone(), |values| component_product(&values, &found)));
    }
    Ok(values.unwrap_or_default())
}

fn check_albedo(
    job: &CaseJob<'_>,
    law: &Law,
    rule: &Albedo,
    values: &PartnerValues,
    results: &[u32],
) -> Result<LawVerdict, Diagnostic> {
    let scope = Scope(job.kernel().words().collect());
    let components = match rule.component {
        Some(component) => component..component + 1,
        None => 0..values.first().map_or(0, Vec::len),
    };
    let target = IntegralTarget {
        wanted: &rule.wanted,
        within: rule.within,
        chosen: rule.chosen(&job.rows),
    };
    let mut verdict = LawVerdict::new(law);
    for component in components {
        let column: Vec<f64> = values.iter().map(|call| component_of(call, component)).collect();
        let sums = rule.sums(&job.rows, &scope, &column)?;
        target.check(job, results, (component, &sums), &mut verdict)?;
    }
    Ok(verdict)
}

fn check_area(
    job: &CaseJob<'_>,
    law: &Law,
    rule: &Area,
    values: &PartnerValues,
    results: &[u32],
) -> Result<LawVerdict, Diagnostic> {
    let scope = Scope(job.kernel().words().collect());
    let target = IntegralTarget {
        wanted: &rule.wanted,
        within: rule.within,
        chosen: rule.chosen(&job.rows),
    };
    let mut verdict = LawVerdict::new(law);
    for component in 0..values.first().map_or(0, Vec::len) {
        let column: Vec<f64> = values.iter().map(|call| component_of(call, component)).collect();
        let sums = rule.sums(&job.rows, &scope, &column)?;
        target.check(job, results, (component, &sums), &mut verdict)?;
    }
    Ok(verdict)
}

/// What integrals must be, and the rows of the case that they belong to.
struct IntegralTarget<'a> {
    wanted: &'a IntegralValue,
    within: f64,
    chosen: Vec<usize>,
}

impl IntegralTarget<'_> {
    /// Checks the integrals of one component.
    fn check(
        &self,
        job: &CaseJob<'_>,
        results: &[u32],
        (component, sums): (usize, &[f64]),
        verdict: &mut LawVerdict,
    ) -> Result<(), Diagnostic> {
        let wanted = wanted_formula(self.wanted, &Scope(job.kernel().words().collect()))?;
        let at_most = matches!(self.wanted, IntegralValue::AtMost(_));
        for (row, sum) in self.chosen.iter().zip(sums) {
            let inputs = job.rows.row(*row);
            let wanted = match &wanted {
                Some(formula) => component_of(&formula.eval(inputs), component),
                None => own_component(job, results, *row, component),
            };
            let off = if at_most && *sum <= wanted { 0.0 } else { (sum - wanted).abs() };
            // An error of NaN counts as too large.
            if off.is_nan() || off > self.within {
                verdict.broken += 1;
                let most = if at_most { "at most " } else { "" };
                verdict.example.get_or_insert_with(|| {
                    let (given, off) = (parameters_text(job, inputs), amount_text(off));
                    format!(
                        "for {given} the integral is {sum}, expected {most}{wanted}: off by {off}"
                    )
                });
            }
        }
        Ok(())
    }
}

fn check_equality(
    job: &CaseJob<'_>,
    law: &Law,
    rule: &Equality,
    values: &PartnerValues,
    results: &[u32],
) -> LawVerdict {
    let (mut verdict, count) = (LawVerdict::new(law), job.kernel().result_words() as usize);
    for (row, other) in values.iter().enumerate() {
        let inputs = job.rows.row(row);
        let unknown = job.expected.get(row).is_some_and(verdict::is_indeterminate);
        if unknown || verdict::is_ambiguous(job, inputs) {
            continue;
        }
        let own: Vec<f64> =
            (0..count).map(|component| own_component(job, results, row, component)).collect();
        let off = |component: usize| {
            let wanted = component_of(other, component);
            (own[component] - wanted).abs() / wanted.abs().max(1.0)
        };
        let worst = (0..count).map(off).fold(0.0, nan_max);
        if worst.is_nan() || worst > rule.within {
            verdict.broken += 1;
            verdict.example.get_or_insert_with(|| {
                let names = law.partners.join("` * `");
                let (given, worst) = (parameters_text(job, inputs), amount_text(worst));
                let (own, other) = (results_text(&own), results_text(other));
                format!("for {given} it gives {own}, and `{names}` gives {other}: off by {worst}")
            });
        }
    }
    verdict
}

/// Results of a law's functions. They may be products, so they have the digits of `f64`.
fn results_text(values: &[f64]) -> String {
    components_text(values.iter().map(|value| (*value, ScalarKind::AbstractFloat)))
}

fn wanted_formula(
    wanted: &IntegralValue,
    scope: &Scope<'_>,
) -> Result<Option<Formula>, Diagnostic> {
    match wanted {
        IntegralValue::Own => Ok(None),
        IntegralValue::Exactly(text) | IntegralValue::AtMost(text) => text.bind(scope).map(Some),
    }
}

/// A component of a formula's value. A single number stands for every component.
fn component_of(values: &[f64], component: usize) -> f64 {
    let index = if values.len() == 1 { 0 } else { component };
    values.get(index).copied().unwrap_or(f64::NAN)
}

/// A component of the result of the case's function. A single number stands for every component.
fn own_component(job: &CaseJob<'_>, results: &[u32], row: usize, component: usize) -> f64 {
    let kinds = job.kernel().result_kinds();
    let component = if kinds.len() == 1 { 0 } else { component };
    results
        .get(row * kinds.len() + component)
        .map_or(f64::NAN, |word| word_value(*word, kinds[component]))
}

fn check_inverse(
    job: &CaseJob<'_>,
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
        let unknown = job.expected.get(row).is_some_and(verdict::is_indeterminate);
        if unknown || verdict::is_ambiguous(job, inputs) {
            continue;
        }
        let wanted = &inputs[first..first + shape.words() as usize];
        let off = |(found, wanted): (&f64, &f64)| (found - wanted).abs() / wanted.abs().max(1.0);
        let worst = found.iter().zip(wanted).map(off).fold(0.0, nan_max);
        if worst.is_nan() || worst > rule.within || found.len() != wanted.len() {
            verdict.broken += 1;
            verdict.example.get_or_insert_with(|| {
                let (given, name) = (parameters_text(job, inputs), &kernel.name);
                let (found, worst) = (results_text(found), amount_text(worst));
                format!("for {given} `{name}` leads back to {found}: off by {worst}")
            });
        }
    }
    Ok(verdict)
}

/// The larger number; NaN if one of them is NaN.
fn nan_max(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}

/// The arguments of the calls of the inverse: the words of the result, and then each further
/// parameter from the case's parameter of the same name, or 0 where the case has none.
fn inverse_rows(job: &CaseJob<'_>, kernel: &Kernel, scope: &Scope<'_>, results: &[u32]) -> Rows {
    let kinds: Vec<_> = kernel.words().flat_map(|(_, shape)| shape.kinds()).collect();
    let (count, own) = (job.kernel().result_words() as usize, job.kernel().result_kinds());
    let mut words = Vec::new();
    for (row, value) in results.chunks(count.max(1)).enumerate() {
        let mut call: Vec<f64> =
            value.iter().zip(&own).map(|(word, kind)| word_value(*word, *kind)).collect();
        let mut next = 0;
        for (name, shape) in kernel.words() {
            let (start, size) = (next, shape.words() as usize);
            next += size;
            let at = scope.find(&[name.to_owned()]);
            if let Some((first, _)) = at.filter(|_| start >= value.len()) {
                call.resize(start, 0.0);
                call.extend(&job.rows.row(row)[first..first + size]);
            }
        }
        call.resize(kinds.len(), 0.0);
        words.extend(call.iter().zip(&kinds).map(|(value, kind)| word_of(*value, *kind)));
    }
    Rows::of(words, kinds)
}
