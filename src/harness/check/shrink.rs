//! Makes a failing input small: towards 0, 1 and few mantissa bits, a batch of candidates a draw.

use super::job::{Job, Target};
use super::judge;
use crate::diagnostic::Diagnostic;
use crate::harness::Session;
use crate::harness::cases::number;
use crate::harness::kernel::Kernel;
use naga::ScalarKind;

/// Rounds of candidates: each round keeps the simplest input that still fails.
const ROUNDS: usize = 24;

/// The smallest failing input found from a failing row, as text: values in decimal and hex, and a
/// case ready to paste.
pub fn shrink(job: &Job<'_>, kernel: &Kernel, session: &mut dyn Session, failing: usize) -> Result<String, Diagnostic> {
    let mut best = job.rows.row_words(failing).to_vec();
    let ranges = ranges(job);
    for _ in 0..ROUNDS {
        let mut candidates = candidates(job, &best);
        candidates.retain(|candidate| complexity(job, candidate) < complexity(job, &best) && meant(job, &ranges, candidate));
        candidates.sort_by_key(|candidate| complexity(job, candidate));
        candidates.truncate(1024);
        let Some(simpler) = first_failing(job, kernel, session, &candidates)? else { break };
        best = simpler;
    }
    let found = session.run(kernel, &best)?;
    let target = if best == job.rows.row_words(failing) { None } else { job.targets(&job.rows.with_words(best.clone()))? };
    match target.as_ref().and_then(|targets| targets.first()).or(job.expected.get(failing)) {
        Some(target) => Ok(describe(job, &best, target, &found)),
        None => Ok(String::new()),
    }
}

fn first_failing(
    job: &Job<'_>,
    kernel: &Kernel,
    session: &mut dyn Session,
    candidates: &[Vec<u32>],
) -> Result<Option<Vec<u32>>, Diagnostic> {
    if candidates.is_empty() {
        return Ok(None);
    }
    let rows = job.rows.with_words(candidates.concat());
    let Some(expected) = job.targets(&rows)? else { return Ok(None) };
    let results = session.run(kernel, &rows.words)?;
    let verdict = judge::judge(job, &rows, &expected, &results);
    Ok(verdict.failing.first().map(|index| candidates[*index].clone()))
}

/// Inputs with one value, or one unit vector, made simpler.
fn candidates(job: &Job<'_>, row: &[u32]) -> Vec<Vec<u32>> {
    let mut found = Vec::new();
    for range in &job.rows.units {
        for axis in 0..2 * range.len() {
            let mut candidate = row.to_vec();
            candidate[range.clone()].fill(0);
            candidate[range.start + axis / 2] = if axis % 2 == 0 { 1f32.to_bits() } else { (-1f32).to_bits() };
            found.push(candidate);
        }
    }
    for (index, word) in row.iter().enumerate() {
        if !job.rows.units.iter().any(|range| range.contains(&index)) {
            found.extend(simpler(*word, job.rows.kinds[index]).into_iter().map(|value| {
                let mut candidate = row.to_vec();
                candidate[index] = value;
                candidate
            }));
        }
    }
    found
}

fn simpler(word: u32, kind: ScalarKind) -> Vec<u32> {
    if kind != ScalarKind::Float {
        return vec![0, 1, word / 2, word.saturating_sub(1)];
    }
    let plain = [0.0f32, 1.0, -1.0, 0.5, 2.0].map(f32::to_bits);
    let shorter = [22, 20, 16, 12, 8, 4, 2, 1].map(|bits| word & (u32::MAX << bits));
    plain.into_iter().chain(shorter).collect()
}

/// The least and the largest value of each column.
fn ranges(job: &Job<'_>) -> Vec<(f64, f64)> {
    let mut ranges = vec![(f64::INFINITY, f64::NEG_INFINITY); job.rows.kinds.len()];
    for row in 0..job.rows.len() {
        ranges.iter_mut().zip(job.rows.row(row)).for_each(|(range, value)| *range = (range.0.min(*value), range.1.max(*value)));
    }
    ranges
}

/// Whether the case means such an input: within the columns' values, and not filtered out.
fn meant(job: &Job<'_>, ranges: &[(f64, f64)], candidate: &[u32]) -> bool {
    let row = crate::harness::cases::numbers(candidate, &job.rows.kinds);
    let is_within = row.iter().zip(ranges).all(|(value, (low, high))| (*low..=*high).contains(value));
    is_within && job.filter.as_ref().is_none_or(|filter| filter.scalar(&row) == 1.0)
}

/// Lower is simpler: values other than 0, then mantissa bits, then magnitude.
fn complexity(job: &Job<'_>, row: &[u32]) -> (u32, u32) {
    let cost = |(word, kind): (&u32, &ScalarKind)| match kind {
        ScalarKind::Float if *word & 0x7fff_ffff == 0 => (0, *word >> 31),
        ScalarKind::Float => {
            let mantissa = 23 - (word & 0x7f_ffff | 0x80_0000).trailing_zeros();
            (1, 1 + mantissa * 8 + ((word >> 23 & 0xff) as i32 - 127).unsigned_abs() + (word >> 31))
        }
        _ => (u32::from(*word != 0), 32 - word.leading_zeros()),
    };
    row.iter().zip(&job.rows.kinds).map(cost).fold((0, 0), |sum, cost| (sum.0 + cost.0, sum.1 + cost.1))
}

/// The input in decimal and hex, then a case to paste that fails alike.
fn describe(job: &Job<'_>, words: &[u32], target: &Target, found: &[u32]) -> String {
    let row = crate::harness::cases::numbers(words, &job.rows.kinds);
    let kinds = job.kernel().result_kinds();
    let mut text = String::new();
    let mut at = 0;
    let (mut paste, mut bits) = (Vec::new(), Vec::new());
    for (name, shape) in job.kernel().words() {
        let range = at..at + shape.words() as usize;
        at = range.end;
        text += &format!("  {name} = {}\n", values(&words[range.clone()], &job.rows.kinds[range.clone()]));
        bits.push(format!("{name} = {}", hex(&words[range.clone()])));
        paste.push(format!("{name} = {}", list(&row[range])));
    }
    text += &format!("  found {}\n", values(found, &kinds));
    text += &format!("  expected {}\n", list(&target.expected.value));
    let worst = judge::judge(job, &job.rows.with_words(words.to_vec()), std::slice::from_ref(target), found).worst;
    let allowed = worst.map_or(0.0, |worst| worst.allowed);
    text += &format!("  allowed {allowed:e}\n\n");
    paste.push(format!("expect = {}", list(&target.expected.value)));
    text + &pasted(job, &paste.join(", "), &bits.join(", "), allowed)
}

/// A case with the one row, with the fixtures that it names.
fn pasted(job: &Job<'_>, row: &str, bits: &str, allowed: f64) -> String {
    let mut text = format!("[[case]]\nfunction = {:?}\n", job.case.function);
    if allowed > 0.0 {
        text += &format!("tolerance = {{ abs = {allowed:e} }}\n");
    }
    if !job.case.fixture_names.is_empty() {
        let names: Vec<String> = job.case.fixture_names.iter().map(|(parameter, name)| format!("{parameter} = {name:?}")).collect();
        text += &format!("fixtures = {{ {} }}\n", names.join(", "));
    }
    if !bits.is_empty() {
        text += &format!("# {bits}\n");
    }
    text + &format!("rows = [{{ {row} }}]\n")
}

/// Numbers as TOML writes them.
fn list(numbers: &[f64]) -> String {
    let one = |number: &f64| if number.is_nan() { "nan".to_owned() } else { format!("{number:?}") };
    format!("[{}]", numbers.iter().map(one).collect::<Vec<_>>().join(", "))
}

fn hex(words: &[u32]) -> String {
    let words: Vec<String> = words.iter().map(|word| format!("0x{word:08x}")).collect();
    if let [word] = &words[..] { word.clone() } else { format!("[{}]", words.join(", ")) }
}

fn values(words: &[u32], kinds: &[ScalarKind]) -> String {
    let one = |(word, kind): (&u32, &ScalarKind)| format!("{} (0x{word:08x})", number(*word, *kind));
    words.iter().zip(kinds).map(one).collect::<Vec<_>>().join(", ")
}
