//! Makes a failing input simpler: towards 0, 1 and few mantissa bits, with a batch of candidates in
//! each draw.

use super::job::{CaseJob, Goal};
use super::law::{self, RowResults};
use super::verdict;
use crate::cases::Rows;
use crate::formula::Scope;
use crate::laws::{self, Law};
use lamplight_diagnostic::Diagnostic;
use lamplight_execute::Session;
use lamplight_execute::kernel::Kernel;
use lamplight_execute::kernel::word_value;
use naga::ScalarKind;

/// The most rounds. Each round keeps the simplest input that still fails.
const ROUNDS: usize = 24;

/// Simplifies a failing row. Returns text: the values in decimal and hexadecimal, and a case ready
/// to paste.
pub fn shrink_row(
    job: &CaseJob<'_>,
    kernel: &Kernel,
    session: &mut dyn Session,
    failing: usize,
) -> Result<String, Diagnostic> {
    let best = smallest_input(job, failing, &mut |rows| {
        let Some(expected) = job.goals(rows)? else { return Ok(None) };
        let results = session.run(kernel, &rows.words)?;
        Ok(verdict::check_rows(job, rows, &expected, &results).failing.first().copied())
    })?;
    let found = session.run(kernel, &best)?;
    let goal = if best == job.rows.row_words(failing) {
        None
    } else {
        job.goals(&job.rows.with_words(best.clone()))?
    };
    match goal.as_ref().and_then(|goals| goals.first()).or(job.expected.get(failing)) {
        Some(goal) => Ok(describe_input(job, &best, goal, &found)),
        None => Ok(String::new()),
    }
}

/// As [`shrink_row`], for a row that breaks a law.
pub fn shrink_law(
    job: &CaseJob<'_>,
    kernel: &Kernel,
    session: &mut dyn Session,
    law: &Law,
    failing: usize,
) -> Result<String, Diagnostic> {
    let scope = Scope(job.kernel().words().collect());
    let best = smallest_input(job, failing, &mut |rows| {
        let others = laws::transform_rows(law, rows, &scope)?;
        let expected = job.goals(rows)?.unwrap_or_default();
        let results = session.run(kernel, &rows.words)?;
        let transformed =
            others.as_ref().map(|rows| session.run(kernel, &rows.words)).transpose()?;
        let transformed = others.as_ref().zip(transformed.as_deref());
        Ok(law::check_law(
            job,
            law,
            &RowResults { rows, expected: &expected, results: &results, transformed },
        )
        .row)
    })?;
    let found = session.run(kernel, &best)?;
    let input = ShrunkInput::new(job, &best);
    let found = format!("  found {}\n\n", decimal_words(&found, &job.kernel().result_kinds()));
    let head = format!("[[case]]\nfunction = {:?}\noracle = \"none\"\n", job.case.function);
    let laws =
        format!("{}laws = [{}]\n# {}\n", fixtures_line(job), laws::law_toml(law), input.bits);
    Ok(format!("{}{found}{head}{laws}inputs = {{ {} }}\n", input.text, input.lists))
}

/// The simplest input found that still fails. `first_failing` gives the index of the first of some
/// rows that fails.
fn smallest_input(
    job: &CaseJob<'_>,
    failing: usize,
    first_failing: &mut dyn FnMut(&Rows) -> Result<Option<usize>, Diagnostic>,
) -> Result<Vec<u32>, Diagnostic> {
    let mut best = job.rows.row_words(failing).to_vec();
    let ranges = column_ranges(job);
    for _ in 0..ROUNDS {
        let mut candidates = simpler_inputs(job, &best);
        candidates.retain(|candidate| {
            row_complexity(job, candidate) < row_complexity(job, &best)
                && is_meant(job, &ranges, candidate)
        });
        candidates.sort_by_key(|candidate| row_complexity(job, candidate));
        candidates.truncate(1024);
        if candidates.is_empty() {
            break;
        }
        let Some(simpler) = first_failing(&job.rows.with_words(candidates.concat()))? else {
            break;
        };
        best = candidates.swap_remove(simpler);
    }
    Ok(best)
}

/// Inputs with one value, or one unit vector, made simpler.
fn simpler_inputs(job: &CaseJob<'_>, row: &[u32]) -> Vec<Vec<u32>> {
    let mut found = Vec::new();
    for range in &job.rows.units {
        for axis in 0..2 * range.len() {
            let mut candidate = row.to_vec();
            candidate[range.clone()].fill(0);
            candidate[range.start + axis / 2] =
                if axis % 2 == 0 { 1f32.to_bits() } else { (-1f32).to_bits() };
            found.push(candidate);
        }
    }
    // A function without parameters has rows of one word, which has no kind.
    for (index, (word, kind)) in row.iter().zip(&job.rows.kinds).enumerate() {
        if !job.rows.units.iter().any(|range| range.contains(&index)) {
            found.extend(simpler_words(*word, *kind).into_iter().map(|value| {
                let mut candidate = row.to_vec();
                candidate[index] = value;
                candidate
            }));
        }
    }
    found
}

fn simpler_words(word: u32, kind: ScalarKind) -> Vec<u32> {
    if kind != ScalarKind::Float {
        return vec![0, 1, word / 2, word.saturating_sub(1)];
    }
    let plain = [0.0f32, 1.0, -1.0, 0.5, 2.0].map(f32::to_bits);
    let shorter = [22, 20, 16, 12, 8, 4, 2, 1].map(|bits| word & (u32::MAX << bits));
    plain.into_iter().chain(shorter).collect()
}

/// The least and the largest value of each column.
fn column_ranges(job: &CaseJob<'_>) -> Vec<(f64, f64)> {
    let mut ranges = vec![(f64::INFINITY, f64::NEG_INFINITY); job.rows.kinds.len()];
    for row in 0..job.rows.len() {
        ranges
            .iter_mut()
            .zip(job.rows.row(row))
            .for_each(|(range, value)| *range = (range.0.min(*value), range.1.max(*value)));
    }
    ranges
}

/// Whether the case is about such an input: within the ranges of the columns, and not filtered out.
fn is_meant(job: &CaseJob<'_>, ranges: &[(f64, f64)], candidate: &[u32]) -> bool {
    let row = crate::cases::words_to_numbers(candidate, &job.rows.kinds);
    let is_within =
        row.iter().zip(ranges).all(|(value, (low, high))| (*low..=*high).contains(value));
    is_within && job.filter.as_ref().is_none_or(|filter| filter.scalar(&row) == 1.0)
}

/// A measure of complexity, smaller is simpler: how many values are not 0, then mantissa bits, then
/// magnitude.
fn row_complexity(job: &CaseJob<'_>, row: &[u32]) -> (u32, u32) {
    let cost = |(word, kind): (&u32, &ScalarKind)| match kind {
        ScalarKind::Float if *word & 0x7fff_ffff == 0 => (0, *word >> 31),
        ScalarKind::Float => {
            let mantissa = 23 - (word & 0x7f_ffff | 0x80_0000).trailing_zeros();
            (1, 1 + mantissa * 8 + ((word >> 23 & 0xff) as i32 - 127).unsigned_abs() + (word >> 31))
        }
        _ => (u32::from(*word != 0), 32 - word.leading_zeros()),
    };
    row.iter()
        .zip(&job.rows.kinds)
        .map(cost)
        .fold((0, 0), |sum, cost| (sum.0 + cost.0, sum.1 + cost.1))
}

/// One row, parameter by parameter.
struct ShrunkInput {
    /// In decimal and hexadecimal, one line for each value.
    text: String,
    /// As the row of a table.
    row: String,
    /// As lists for `inputs`.
    lists: String,
    bits: String,
}

impl ShrunkInput {
    fn new(job: &CaseJob<'_>, words: &[u32]) -> Self {
        let numbers = crate::cases::words_to_numbers(words, &job.rows.kinds);
        let (mut text, mut at) = (String::new(), 0);
        let (mut row, mut lists, mut bits) = (Vec::new(), Vec::new(), Vec::new());
        for (name, shape) in job.kernel().words() {
            let range = at..at + shape.words() as usize;
            at = range.end;
            text += &format!(
                "  {name} = {}\n",
                decimal_words(&words[range.clone()], &job.rows.kinds[range.clone()])
            );
            bits.push(format!("{name} = {}", hex_words(&words[range.clone()])));
            row.push(format!("{name} = {}", toml_list(&numbers[range.clone()])));
            lists.push(if range.len() == 1 {
                row[row.len() - 1].clone()
            } else {
                format!("{name} = [{}]", toml_list(&numbers[range]))
            });
        }
        Self { text, row: row.join(", "), lists: lists.join(", "), bits: bits.join(", ") }
    }
}

/// The input in decimal and hexadecimal, then a case to paste that fails in the same way.
fn describe_input(job: &CaseJob<'_>, words: &[u32], goal: &Goal, found: &[u32]) -> String {
    let input = ShrunkInput::new(job, words);
    let worst = verdict::check_rows(
        job,
        &job.rows.with_words(words.to_vec()),
        std::slice::from_ref(goal),
        found,
    )
    .worst;
    let allowed = worst.map_or(0.0, |worst| worst.allowed);
    let (found, expected) =
        (decimal_words(found, &job.kernel().result_kinds()), toml_list(&goal.expected.value));
    let found_text = format!(
        "  found {found}\n  expected {expected}\n  allowed {}\n\n",
        law::amount_text(allowed)
    );
    input.text.clone() + &found_text + &case_to_paste(job, &input, &expected, allowed)
}

/// A case with the one row, and the fixtures that it names.
fn case_to_paste(job: &CaseJob<'_>, input: &ShrunkInput, expected: &str, allowed: f64) -> String {
    let mut text = format!("[[case]]\nfunction = {:?}\n", job.case.function);
    if allowed > 0.0 {
        text += &format!("tolerance = {{ abs = {allowed:e} }}\n");
    }
    text += &fixtures_line(job);
    if !input.bits.is_empty() {
        text += &format!("# {}\n", input.bits);
    }
    let separator = if input.row.is_empty() { "" } else { ", " };
    text + &format!("rows = [{{ {}{separator}expect = {expected} }}]\n", input.row)
}

/// The line of a case that names its fixtures; empty if it has none.
fn fixtures_line(job: &CaseJob<'_>) -> String {
    let names: Vec<String> = job
        .case
        .fixture_names
        .iter()
        .map(|(parameter, name)| format!("{parameter} = {name:?}"))
        .collect();
    if names.is_empty() {
        String::new()
    } else {
        format!("fixtures = {{ {} }}\n", names.join(", "))
    }
}

/// Numbers as TOML writes them.
fn toml_list(numbers: &[f64]) -> String {
    let one = |number: &f64| if number.is_nan() { "nan".to_owned() } else { format!("{number:?}") };
    format!("[{}]", numbers.iter().map(one).collect::<Vec<_>>().join(", "))
}

fn hex_words(words: &[u32]) -> String {
    let words: Vec<String> = words.iter().map(|word| format!("0x{word:08x}")).collect();
    if let [word] = &words[..] { word.clone() } else { format!("[{}]", words.join(", ")) }
}

fn decimal_words(words: &[u32], kinds: &[ScalarKind]) -> String {
    let one =
        |(word, kind): (&u32, &ScalarKind)| format!("{} (0x{word:08x})", word_value(*word, *kind));
    words.iter().zip(kinds).map(one).collect::<Vec<_>>().join(", ")
}
