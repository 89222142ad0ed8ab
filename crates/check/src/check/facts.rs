//! What a case's formulas say about its rows. It is computed once, since every executor is compared
//! with it, in both languages. Rows belong to one case.

use super::job::CaseJob;
use super::verdict;
use crate::cases::Rows;
use crate::tolerance;

/// The values of the formulas of the tolerance for one row, as [`tolerance::allowed_error`] takes
/// them.
pub fn term_values<'r>(job: &CaseJob<'_>, rows: &'r Rows, index: usize) -> &'r [f64] {
    let all = rows.facts.terms.get_or_init(|| {
        let of_row = |index| tolerance::formula_values(&job.terms, rows.row(index));
        (0..rows.len()).flat_map(of_row).collect()
    });
    let count = tolerance::formula_count(&job.terms);
    &all[index * count..(index + 1) * count]
}

/// [`verdict::is_ambiguous`] of one row.
pub fn is_ambiguous(job: &CaseJob<'_>, rows: &Rows, index: usize) -> bool {
    let all = rows.facts.near.get_or_init(|| {
        (0..rows.len()).map(|index| verdict::is_ambiguous(job, rows.row(index))).collect()
    });
    all[index]
}

/// Whether one row is within the case's filter, if it has one.
pub fn is_inside(job: &CaseJob<'_>, rows: &Rows, index: usize) -> bool {
    let Some(filter) = &job.filter else { return true };
    let all = rows.facts.inside.get_or_init(|| {
        (0..rows.len()).map(|index| filter.scalar(rows.row(index)) == 1.0).collect()
    });
    all[index]
}
