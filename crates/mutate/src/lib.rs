//! Measures how much the numeric cases notice: by the coverage of the library's statements and
//! branches, and by mutants. A mutant is a function of the library with one mistake put in.
//!
//! `module -> sites (what could be wrong where) -> mutant -> rows until one fails -> fate`
//!
//! A mutant is made in naga's module and runs on the evaluator in f32, with the same verdicts as
//! `lamplight check`. It is killed when a row is off by more than its tolerance, when a law is
//! broken, or when a call does not end. Before that it runs in f64. There it is compared to nine
//! digits with the oracle, unless that is the code itself; digits that the code as written loses do
//! not count. Mutants that no input can distinguish from the original, and those that survive for
//! another reason, are listed in `survivors.toml` at the package's root.

mod coverage;
mod limit;
mod report;
mod shared;
mod site;
mod suite;

pub use coverage::{Coverage, UncoveredBlock, measure_coverage};
pub use report::{Fate, MutantOutcome, MutantReport};
pub use shared::{
    HEAD as SHARED_HEAD, Kind, SharedFate, SharedOutcome, SharedReport, run_shared_mutants,
};

use std::sync::Mutex;

use rayon::prelude::*;

use lamplight_check::library::Library;
use lamplight_diagnostic::Diagnostics;
use lamplight_diagnostic::source::SourceSet;
use lamplight_validate::on_large_stack;
use report::Listed;
use site::Site;
use suite::{Subject, Suite};

/// Runs every mutant of the modules (`lighting::spot`) against their own cases.
///
/// # Errors
/// Mistakes in modules and case files, and cases that fail without any mutation.
pub fn run_mutants(
    library: &Library,
    sources: &Mutex<SourceSet>,
    modules: &[String],
) -> Result<MutantReport, Diagnostics> {
    let listed = report::read_list(library)?;
    on_large_stack(|| {
        let files = suite::case_files(library, sources, modules)?;
        let suites = suite::make_suites(library, sources, &files, false)?;
        suites
            .par_iter()
            .map(Suite::check)
            .collect::<Result<(), _>>()
            .map_err(|error| vec![error])?;
        let mutants: Vec<(&Suite<'_>, &Subject, Site)> =
            suites.iter().flat_map(all_mutants).collect();
        let texts = sources.lock().map(|sources| sources.clone()).unwrap_or_default();
        let outcomes = mutants
            .par_iter()
            .filter_map(|(suite, subject, site)| {
                mutant_outcome(&texts, &listed, suite, subject, site)
            })
            .collect();
        Ok(report::make_report(outcomes, &listed))
    })
}

fn all_mutants<'a, 'f>(
    suite: &'a Suite<'f>,
) -> impl Iterator<Item = (&'a Suite<'f>, &'a Subject, Site)> {
    let sites = |subject: &'a Subject| {
        site::mutation_sites(&suite.whole, &suite.info, subject.function)
            .into_iter()
            .map(move |site| (subject, site))
    };
    suite.subjects.iter().flat_map(sites).map(move |(subject, site)| (suite, subject, site))
}

/// The fate of one mutant; `None` if it is not valid.
fn mutant_outcome(
    sources: &SourceSet,
    listed: &[Listed],
    suite: &Suite<'_>,
    subject: &Subject,
    site: &Site,
) -> Option<MutantOutcome> {
    let fate = suite.fate(subject, site)?;
    let text = site::QuotedSource {
        sources,
        map: &suite.map,
        function: &suite.whole.functions[subject.function],
    };
    let (place, line) = text.place(site.span);
    let mut outcome = MutantOutcome {
        function: format!("{}::{}", suite.module, subject.name),
        place,
        line,
        mistake: text.describe(site),
        fate,
    };
    if let (Fate::Survived, Some(index)) =
        (outcome.fate, listed.iter().position(|listed| listed.is(&outcome)))
    {
        outcome.fate =
            if listed[index].equivalent { Fate::Equivalent(index) } else { Fate::Explained(index) };
    }
    Some(outcome)
}
