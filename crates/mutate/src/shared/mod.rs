//! Mistakes that a function and its reference share. Whoever writes both may leave out the same guard,
//! or copy the same wrong number into both, and then the comparison of the two notices nothing. What can
//! notice it are numbers that cases state, and laws: symmetries, ranges, integrals.
//!
//! `module -> sites that are guards, numbers or orders -> mutant -> tables and laws -> fate`
//!
//! A mutant runs as in [`crate::run_mutants`], except that values of references, of formulas and of the
//! code in f64 count for nothing.

mod kind;
mod notice;
mod report;

pub use kind::Kind;
pub use report::{HEAD, SharedFate, SharedOutcome, SharedReport};

use std::sync::Mutex;

use lamplight_check::library::Library;
use lamplight_check::references::{self, Source};
use lamplight_diagnostic::source::SourceSet;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_validate::on_large_stack;
use rayon::prelude::*;

use crate::limit::limit_sites;
use crate::report::{Fate, Listed, MutantOutcome, read_list};
use crate::site::{QuotedSource, Site, mutation_sites};
use crate::suite::{self, ReadyCase, Subject, Suite};
use notice::{ENDLESS, Mistake};

/// Runs the mistakes that functions of the modules could share with their references: those in guards of
/// every function, and all of functions whose reference is an integral or a specification's code.
///
/// # Errors
/// Mistakes in modules and case files, and cases that fail without any mutation.
pub fn run_shared_mutants(
    library: &Library,
    sources: &Mutex<SourceSet>,
    modules: &[String],
) -> Result<SharedReport, Diagnostics> {
    let listed = read_list(library)?;
    on_large_stack(|| {
        let files = suite::case_files(library, sources, modules)?;
        let suites = suite::make_suites(library, sources, &files, true)?;
        suites.par_iter().try_for_each(check_as_it_is).map_err(|error| vec![error])?;
        let mutants: Vec<_> = suites.iter().flat_map(wanted_mutants).collect();
        let texts = sources.lock().map(|sources| sources.clone()).unwrap_or_default();
        let outcomes = mutants
            .par_iter()
            .filter_map(|mutant| shared_outcome(&texts, &listed, mutant))
            .collect();
        Ok(SharedReport { outcomes })
    })
}

/// A mistake with its kind.
struct SharedMutant<'a, 's> {
    suite: &'a Suite<'s>,
    subject: &'a Subject,
    site: Site,
    kind: Kind,
    source: Option<Source>,
}

fn wanted_mutants<'a, 's>(suite: &'a Suite<'s>) -> Vec<SharedMutant<'a, 's>> {
    let of_subject = |subject: &'a Subject| {
        let source = references::find_source(&suite.module, &subject.name);
        let function = &suite.whole.functions[subject.function];
        let limits = limit_sites(&suite.whole, subject.function);
        let sites = mutation_sites(&suite.whole, &suite.info, subject.function);
        sites.into_iter().chain(limits).filter_map(move |site| {
            let kind = kind::kind_of(function, &site)?;
            let all = matches!(source, Some(Source::Integral | Source::Specification));
            (all || kind.is_of_guard()).then_some(SharedMutant {
                suite,
                subject,
                site,
                kind,
                source,
            })
        })
    };
    suite.subjects.iter().flat_map(of_subject).collect()
}

/// No case notices the code as it is.
fn check_as_it_is(suite: &Suite<'_>) -> Result<(), Diagnostic> {
    let Some(subject) = suite.subjects.first() else { return Ok(()) };
    let mistake = Mistake { suite, subject, site: None };
    suite.cases.par_iter().try_for_each(|case| {
        let named = case.job.case;
        match mistake.notice(case).map_err(|error| error.at(named.span, "in this case"))? {
            None => Ok(()),
            Some(notice) => {
                let message = format!("`{}` fails `{notice}` as it is", named.function);
                Err(Diagnostic::error(codes::CASE_INVALID, message).at(named.span, "in this case"))
            }
        }
    })
}

fn shared_outcome(
    sources: &SourceSet,
    listed: &[Listed],
    mutant: &SharedMutant<'_, '_>,
) -> Option<SharedOutcome> {
    let SharedMutant { suite, subject, site, kind, source } = mutant;
    let function = &suite.whole.functions[subject.function];
    let text = QuotedSource { sources, map: &suite.map, function };
    let (place, line) = text.place(site.span);
    let mut outcome = SharedOutcome {
        function: format!("{}::{}", suite.module, subject.name),
        place,
        line,
        mistake: text.describe(site),
        kind: *kind,
        source: *source,
        fate: SharedFate::Missed,
    };
    if !suite.is_valid(subject, site) {
        return None;
    }
    outcome.fate = fate(mutant, is_listed(listed, &outcome));
    Some(outcome)
}

/// Whether the list says that the mistake changes no value.
fn is_listed(listed: &[Listed], outcome: &SharedOutcome) -> bool {
    let plain = MutantOutcome {
        function: outcome.function.clone(),
        place: outcome.place.clone(),
        line: outcome.line.clone(),
        mistake: outcome.mistake.clone(),
        fate: Fate::Survived,
    };
    listed.iter().any(|entry| entry.equivalent && entry.is(&plain))
}

fn fate(mutant: &SharedMutant<'_, '_>, is_listed: bool) -> SharedFate {
    let SharedMutant { suite, subject, site, .. } = mutant;
    let mistake = Mistake { suite, subject, site: Some(site) };
    if is_listed {
        return SharedFate::Equivalent;
    }
    let is_own = |case: &&ReadyCase<'_>| case.job.case.function == subject.name;
    let (own, others): (Vec<_>, Vec<_>) = suite.cases.iter().partition(is_own);
    for case in own.iter().chain(&others) {
        // A mutant that takes too many steps is an error, and is noticed too.
        if let Some(notice) = mistake.notice(case).unwrap_or(Some(ENDLESS)) {
            return SharedFate::Noticed(notice);
        }
    }
    let within: Vec<bool> = own
        .iter()
        .chain(&others)
        .filter_map(|case| mistake.is_within(case).unwrap_or(Some(false)))
        .collect();
    match !within.is_empty() && within.iter().all(|within| *within) {
        true => SharedFate::WithinError,
        false => SharedFate::Missed,
    }
}
