//! What can be checked of a case without a device: how its tolerance compares with what WGSL
//! allows, whether the code in f64 agrees with the oracle, and whether both languages compute the
//! same.

use rayon::prelude::*;

use super::job::{self, BoundOracle, CaseJob, Goal};
use super::{profile, verdict};
use crate::cases::Oracle;
use crate::tolerance;
use lamplight_diagnostic::Diagnostic;
use lamplight_diagnostic::source::Span;
use lamplight_execute::interpreter::Interpreter;
use lamplight_validate::on_large_stack;
use naga::ScalarKind;

/// The largest relative difference between the two languages in f64.
const PARITY: f64 = 1e-12;
/// The largest error of the code in f64, as a share of the tolerance of the case. The rest of the
/// tolerance is left for rounding to f32. The values of a table are themselves rounded, so they may
/// use the whole tolerance.
const VALUE: f64 = 0.5;
const VALUE_OF_TABLE: f64 = 1.0;
/// The rounding error in f64 as a share of the one in f32, with a few bits to spare.
const F64_SHARE: f64 = 1.0 / (1u64 << 26) as f64;

/// What was found of one case.
#[derive(Debug, Clone)]
pub struct Proof {
    pub module: String,
    pub function: String,
    /// Index of the case in its file.
    pub case: usize,
    /// Where the case names the function.
    pub span: Span,
    /// The arguments of the worst failure, if there is one.
    pub arguments: Option<String>,
    /// What WGSL allows, compared with what the case allows; or why that is not known.
    pub spec: Result<Spec, String>,
    /// The code in f64 compared with the oracle, unless the oracle is the code itself.
    pub value: Option<ValueProof>,
    /// WESL compared with GLSL in f64, if both exist.
    pub parity: Option<Result<Parity, String>>,
}

/// The tolerance of a case, compared with the error bound of its code under the accuracy that WGSL
/// demands.
#[derive(Debug, Clone, Copy, Default)]
pub struct Spec {
    /// Rows where the bound is finite and no comparison is in doubt.
    pub rows: usize,
    /// How many of those have a tolerance below what WGSL allows.
    pub stricter: usize,
    /// The smallest ratio of tolerance to bound, and both of them in units in the last place; 0
    /// without rows.
    pub least: f64,
    pub stated_ulps: f64,
    pub bound_ulps: f64,
}

/// How far the code is from the oracle before any rounding to f32.
#[derive(Debug, Clone, Copy, Default)]
pub struct ValueProof {
    /// Rows that were compared: those where no comparison is in doubt.
    pub rows: usize,
    /// Rows whose error leaves too little of the tolerance for rounding.
    pub off: usize,
    /// The largest error divided by the tolerance, and its row.
    pub share: f64,
    pub row: usize,
}

/// How far the two languages are apart.
#[derive(Debug, Clone, Copy, Default)]
pub struct Parity {
    /// Rows that were compared: those where no comparison is in doubt.
    pub rows: usize,
    /// Rows on which they differ.
    pub apart: usize,
    /// The largest relative difference, and its row.
    pub worst: f64,
    pub row: usize,
}

impl Proof {
    /// Whether the languages agree, and the code with the oracle.
    pub fn passed(&self) -> bool {
        self.agree() && self.value.is_none_or(|value| value.off == 0)
    }

    /// Whether the languages agree.
    pub fn agree(&self) -> bool {
        self.parity
            .as_ref()
            .is_none_or(|parity| parity.as_ref().is_ok_and(|parity| parity.apart == 0))
    }

    pub fn path(&self) -> String {
        format!("{}::{}", self.module, self.function)
    }
}

/// Proves what there is to prove of each job.
pub fn prove_jobs(jobs: &[CaseJob<'_>]) -> Vec<Proof> {
    on_large_stack(|| jobs.par_iter().map(prove_one).collect())
}

fn prove_one(job: &CaseJob<'_>) -> Proof {
    let text = |error: Diagnostic| error.message;
    let kinds = job.kernel().result_kinds();
    let bounded: Vec<Result<Vec<Goal>, String>> = job
        .kernels
        .iter()
        .map(|(_, kernel)| {
            Interpreter::new(kernel)
                .and_then(|interpreter| job::bounded_goals(&interpreter, &job.rows, &kinds))
                .map_err(text)
        })
        .collect();
    let parity = match &bounded[..] {
        [first, second, ..] => Some(match (first, second) {
            (Ok(first), Ok(second)) => Ok(parity_of(first, second, &kinds)),
            (Err(error), _) | (_, Err(error)) => Err(error.clone()),
        }),
        _ => None,
    };
    let value = bounded
        .first()
        .and_then(|first| first.as_ref().ok())
        .and_then(|first| value_proof(job, first));
    let apart = parity.iter().flatten().filter(|parity| parity.apart > 0).map(|parity| parity.row);
    let off = value.filter(|value| value.off > 0).map(|value| value.row);
    let row = apart.chain(off).next();
    let spec = match bounded.into_iter().next() {
        Some(Ok(first)) => Ok(spec_proof(job, &first, &kinds)),
        Some(Err(error)) => Err(error),
        None => Err("no language was chosen".to_owned()),
    };
    Proof {
        module: job.module.clone(),
        function: job.case.function.clone(),
        case: job.index,
        span: job.case.span,
        arguments: row.map(|row| profile::arguments_text(job, job.rows.row(row))),
        spec,
        value,
        parity,
    }
}

fn spec_proof(job: &CaseJob<'_>, bounds: &[Goal], kinds: &[ScalarKind]) -> Spec {
    let mut spec = Spec::default();
    for (index, (bound, goal)) in bounds.iter().zip(&job.expected).enumerate() {
        if bound.doubtful || verdict::is_indeterminate(bound) || verdict::is_indeterminate(goal) {
            continue;
        }
        spec.rows += 1;
        let values = tolerance::formula_values(&job.terms, job.rows.row(index));
        let mut stricter = false;
        for (word, expected) in goal
            .expected
            .value
            .iter()
            .enumerate()
            .filter(|(word, _)| kinds[*word] == ScalarKind::Float)
        {
            let stated = tolerance::allowed_error(&job.terms, &values, word, *expected)
                + goal.errors.get(word).copied().unwrap_or(0.0);
            let allowed = bound.errors[word];
            if allowed <= f64::from(f32::MIN_POSITIVE) {
                continue;
            }
            let share = stated / allowed;
            stricter |= share < 1.0;
            if spec.bound_ulps == 0.0 || share < spec.least {
                let ulp = tolerance::ulp_of(*expected);
                spec = Spec {
                    least: share,
                    stated_ulps: stated / ulp,
                    bound_ulps: allowed / ulp,
                    ..spec
                };
            }
        }
        spec.stricter += usize::from(stricter);
    }
    spec
}

fn value_proof(job: &CaseJob<'_>, found: &[Goal]) -> Option<ValueProof> {
    if matches!(job.oracle, BoundOracle::Eval(_)) || job.expected.is_empty() {
        return None;
    }
    let limit = if matches!(job.case.oracle, Oracle::Table(_)) { VALUE_OF_TABLE } else { VALUE };
    let mut value = ValueProof::default();
    for (row, (found, goal)) in found.iter().zip(&job.expected).enumerate() {
        let inputs = job.rows.row(row);
        if found.doubtful || verdict::is_indeterminate(goal) || verdict::is_ambiguous(job, inputs) {
            continue;
        }
        value.rows += 1;
        let share = error_share(job, inputs, found, goal);
        value.off += usize::from(share > limit);
        if share > value.share {
            value = ValueProof { share, row, ..value };
        }
    }
    Some(value)
}

/// The error divided by the tolerance: of the worst component, for the accepted value that fits
/// best.
fn error_share(job: &CaseJob<'_>, inputs: &[f64], found: &Goal, goal: &Goal) -> f64 {
    let values = tolerance::formula_values(&job.terms, inputs);
    let of = |expected: &Vec<f64>| {
        let component = |(word, (found, expected)): (usize, (&f64, &f64))| {
            let off = verdict::component_distance(*found, *expected, false);
            if off == 0.0 {
                0.0
            } else {
                off / tolerance::allowed_error(&job.terms, &values, word, *expected)
            }
        };
        found.expected.value.iter().zip(expected).enumerate().map(component).fold(0.0, f64::max)
    };
    std::iter::once(&goal.expected.value)
        .chain(&goal.expected.alternatives)
        .map(of)
        .fold(f64::INFINITY, f64::min)
}

fn parity_of(first: &[Goal], second: &[Goal], kinds: &[ScalarKind]) -> Parity {
    let mut parity = Parity::default();
    for (row, (a, b)) in first.iter().zip(second).enumerate() {
        if a.doubtful || b.doubtful || verdict::is_indeterminate(a) || verdict::is_indeterminate(b)
        {
            continue;
        }
        parity.rows += 1;
        let mut is_apart = false;
        for word in 0..kinds.len() {
            let (x, y) = (a.expected.value[word], b.expected.value[word]);
            let difference = (x - y).abs();
            let relative = difference / x.abs().max(y.abs()).max(f64::from(f32::MIN_POSITIVE));
            // Where terms cancel, the rounding error in f64 is relative to the terms.
            let rounding = a.errors[word].max(b.errors[word]) * F64_SHARE;
            if difference > rounding && relative > PARITY {
                is_apart = true;
                if relative > parity.worst {
                    parity = Parity { worst: relative, row, ..parity };
                }
            }
        }
        parity.apart += usize::from(is_apart);
    }
    parity
}
