//! What a case may take of its file's bounds.

use std::sync::atomic::{AtomicUsize, Ordering};

use super::job::BoundOracle;
use crate::diagnostic::{Diagnostic, codes};
use crate::limits::{CASE_ROWS, CASE_WORDS, CASE_WORK, Steps};
use crate::proof::cases::{self, Case, File, Rows};
use crate::proof::formula::Formula;
use crate::proof::tolerance::Bound;

/// What a case may take of its file's steps: the same for every case, whatever order they run in.
pub fn steps_of_case(file: &File) -> Steps {
    Steps::new(CASE_WORK / file.cases.len().max(1) as u64)
}

/// What the cases of a file have together. They are made in any order: whether it is too much does
/// not depend on that.
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

    pub fn check(&self, file: &File) -> Result<(), Diagnostic> {
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

/// What is computed for each row.
pub struct Parts<'a> {
    pub terms: &'a [Bound],
    pub near: &'a Option<(Formula, f64)>,
    pub filter: &'a Option<Formula>,
    pub oracle: &'a BoundOracle,
}

impl Parts<'_> {
    /// Counts it for every row, once for the values and once for each law, before any of it is
    /// computed or kept.
    pub fn spend(&self, case: &Case, rows: &Rows, steps: &mut Steps) -> Result<(), Diagnostic> {
        let near = self.near.as_ref().map_or(0, |(formula, _)| formula.parts());
        let filter = self.filter.as_ref().map_or(0, Formula::parts);
        let oracle = match self.oracle {
            BoundOracle::Formula(formula) => formula.parts(),
            _ => 1,
        };
        let terms: usize = self.terms.iter().map(Bound::parts).sum();
        let each = (1 + case.laws.len()).saturating_mul(rows.stride + near + filter + terms);
        cases::spend_steps(case, rows.len(), each.saturating_add(oracle), steps)
    }
}
