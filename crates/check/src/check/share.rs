//! Limits on the rows and on the work of the cases of a file.

use std::sync::atomic::{AtomicUsize, Ordering};

use super::job::BoundOracle;
use crate::cases::{self, Case, CaseFile, Rows};
use crate::formula::Formula;
use crate::tolerance::BoundTerm;
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_files::limits::{CASE_ROWS, CASE_WORDS, CASE_WORK, Steps};

/// The steps that each case of a file may take: an equal share of the limit of the file. The order
/// in which cases run therefore makes no difference.
pub fn steps_of_case(file: &CaseFile) -> Steps {
    Steps::new(CASE_WORK / file.cases.len().max(1) as u64)
}

/// The sums over all cases of a file. Cases are prepared in any order, but whether a sum exceeds
/// its limit does not depend on the order.
#[derive(Default)]
pub struct Total {
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
pub struct RowFormulas<'a> {
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
