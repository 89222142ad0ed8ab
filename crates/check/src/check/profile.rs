//! How the error of a case depends on its inputs, for the plots of a report.

use super::job::{CaseJob, Goal};
use super::verdict::{self, Worst};
use lamplight_execute::kernel::TypeShape;
use naga::ScalarKind;

/// How many bins an axis is divided into.
pub const BINS: usize = 48;
/// How many cells each side of a map has.
pub const CELLS: usize = 32;
/// How many of the worst inputs are kept.
const WORST: usize = 5;
/// The ratio of the largest magnitude to the median one, or of the ends of a positive range, above
/// which a scale is logarithmic.
const WIDE: f64 = 1e3;

/// The error over the inputs of one case in one language on one executor.
#[derive(Debug, Clone)]
pub struct Profile {
    /// An axis for each word of a row that varies.
    pub axes: Vec<ProfileAxis>,
    /// A map, if exactly two words vary.
    pub map: Option<ErrorMap>,
    /// The inputs whose error is closest to what is allowed, or beyond it.
    pub worst: Vec<ProfiledInput>,
}

/// One varying word of the rows.
#[derive(Debug, Clone)]
pub struct ProfileAxis {
    /// `c`, `at.uv.x`.
    pub name: String,
    pub scale: ProfileScale,
    /// The bins, by their place along the scale. Bins without a row are left out.
    pub bins: Vec<Bin>,
}

/// How the values of an axis are placed along a plot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProfileScale {
    pub low: f64,
    pub high: f64,
    /// Values up to this size are placed linearly, larger ones by their logarithm; 0 for a linear
    /// scale.
    pub bend: f64,
}

/// The largest errors of the rows in a part of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bin {
    /// Index along the axis, below [`BINS`].
    pub index: usize,
    pub error: f64,
    pub allowed: f64,
    pub ulps: f64,
}

/// The largest errors over two parameters, each as a share of what is allowed.
#[derive(Debug, Clone)]
pub struct ErrorMap {
    /// Indices of the axes.
    pub across: usize,
    pub up: usize,
    /// [`CELLS`]² shares, row by row from the lowest value of `up`. A cell without a row is NaN.
    pub cells: Vec<f64>,
}

/// One input with its outcome.
#[derive(Debug, Clone)]
pub struct ProfiledInput {
    /// Name, value and bits of each word.
    pub words: Vec<(String, f64, u32)>,
    pub worst: Worst,
}

impl ProfileScale {
    fn of(values: impl Iterator<Item = f64> + Clone) -> Self {
        let (low, high) =
            values.clone().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                (low.min(value), high.max(value))
            });
        let mut sizes: Vec<f64> = values.map(f64::abs).filter(|size| *size > 0.0).collect();
        sizes.sort_by(f64::total_cmp);
        let median = sizes.get(sizes.len() / 2).copied().unwrap_or(0.0);
        let largest = sizes.last().copied().unwrap_or(0.0);
        let bend = if low > 0.0 && high / low > WIDE {
            low
        } else if largest > WIDE * median {
            median
        } else {
            0.0
        };
        Self { low, high, bend }
    }

    fn bent(self, value: f64) -> f64 {
        if self.bend == 0.0 { value } else { (value / self.bend).asinh() }
    }

    /// Where a value lies along the scale, from 0 to 1.
    pub fn place(self, value: f64) -> f64 {
        let (low, high) = (self.bent(self.low), self.bent(self.high));
        if high > low { ((self.bent(value) - low) / (high - low)).clamp(0.0, 1.0) } else { 0.5 }
    }

    /// The value at a place.
    pub fn value(self, place: f64) -> f64 {
        let (low, high) = (self.bent(self.low), self.bent(self.high));
        let bent = low + (high - low) * place;
        if self.bend == 0.0 { bent } else { bent.sinh() * self.bend }
    }

    fn index(self, value: f64, count: usize) -> usize {
        ((self.place(value) * count as f64) as usize).min(count - 1)
    }
}

/// The profile of the results for the rows of a job.
pub fn make_profile(job: &CaseJob<'_>, results: &[u32]) -> Profile {
    let kinds = job.kernel().result_kinds();
    let found: Vec<Worst> = job
        .expected
        .iter()
        .zip(results.chunks(kinds.len().max(1)))
        .enumerate()
        .filter(|(_, (goal, _))| !verdict::is_indeterminate(goal))
        .filter_map(|(index, (goal, found)): (usize, (&Goal, &[u32]))| {
            verdict::compare_goal(job, &job.rows, goal, found, &kinds, index)
        })
        .collect();
    let is_doubtful =
        |row: usize| job.expected[row].doubtful || verdict::is_ambiguous(job, job.rows.row(row));
    let found: Vec<Worst> =
        found.into_iter().filter(|worst| worst.share() <= 1.0 || !is_doubtful(worst.row)).collect();
    let names = column_names(job);
    let varying: Vec<(usize, ProfileScale)> = (0..names.len().min(job.rows.stride))
        .filter_map(|column| Some((column, column_scale(job, column)?)))
        .collect();
    let axes = varying
        .iter()
        .map(|(column, scale)| profile_axis(job, &found, names[*column].clone(), *column, *scale))
        .collect();
    let map = match varying[..] {
        [(across, x), (up, y)] => Some(profile_map(job, &found, (across, x), (up, y))),
        _ => None,
    };
    Profile { axes, map, worst: worst_inputs(job, found, &names) }
}

fn column_scale(job: &CaseJob<'_>, column: usize) -> Option<ProfileScale> {
    let values = (0..job.rows.len()).map(|row| job.rows.row(row)[column]);
    let scale = ProfileScale::of(values);
    (scale.low < scale.high).then_some(scale)
}

fn profile_axis(
    job: &CaseJob<'_>,
    found: &[Worst],
    name: String,
    column: usize,
    scale: ProfileScale,
) -> ProfileAxis {
    let mut bins: Vec<Option<Bin>> = vec![None; BINS];
    for worst in found {
        let index = scale.index(job.rows.row(worst.row)[column], BINS);
        let bin = bins[index].get_or_insert(Bin { index, error: 0.0, allowed: 0.0, ulps: 0.0 });
        bin.error = bin.error.max(worst.error);
        bin.allowed = bin.allowed.max(worst.allowed);
        bin.ulps = bin.ulps.max(worst.ulps());
    }
    ProfileAxis { name, scale, bins: bins.into_iter().flatten().collect() }
}

fn profile_map(
    job: &CaseJob<'_>,
    found: &[Worst],
    across: (usize, ProfileScale),
    up: (usize, ProfileScale),
) -> ErrorMap {
    let mut cells = vec![f64::NAN; CELLS * CELLS];
    for worst in found {
        let row = job.rows.row(worst.row);
        let cell =
            &mut cells[up.1.index(row[up.0], CELLS) * CELLS + across.1.index(row[across.0], CELLS)];
        *cell = cell.max(worst.share());
    }
    ErrorMap { across: 0, up: 1, cells }
}

fn worst_inputs(job: &CaseJob<'_>, mut found: Vec<Worst>, names: &[String]) -> Vec<ProfiledInput> {
    found.sort_by(|a, b| b.share().total_cmp(&a.share()).then(a.row.cmp(&b.row)));
    let input = |worst: Worst| {
        let words = names.iter().zip(job.rows.row(worst.row)).zip(job.rows.row_words(worst.row));
        ProfiledInput {
            words: words.map(|((name, value), word)| (name.clone(), *value, *word)).collect(),
            worst,
        }
    };
    found.into_iter().filter(|worst| worst.error > 0.0).take(WORST).map(input).collect()
}

/// The words of a row by their names: `d = 1.5, light.kind = 3`.
pub fn arguments_text(job: &CaseJob<'_>, row: &[f64]) -> String {
    let named = column_names(job).into_iter().zip(row);
    named.map(|(name, value)| format!("{name} = {value}")).collect::<Vec<_>>().join(", ")
}

/// The words of a row by parameters: `mu = 0.5, n = (0, 0.6, 0.8)`.
pub fn parameters_text(job: &CaseJob<'_>, row: &[f64]) -> String {
    let mut at = 0;
    let parameters = job.kernel().words().map(|(name, shape)| {
        let kinds = shape.kinds();
        let values = row.iter().skip(at).zip(&kinds);
        at += kinds.len();
        format!("{name} = {}", components_text(values.map(|(value, kind)| (*value, *kind))))
    });
    parameters.collect::<Vec<_>>().join(", ")
}

/// A number, or the components of something else in parentheses.
pub fn components_text(values: impl Iterator<Item = (f64, ScalarKind)>) -> String {
    let texts: Vec<String> = values.map(|(value, kind)| value_text(value, kind)).collect();
    match &texts[..] {
        [one] => one.clone(),
        several => format!("({})", several.join(", ")),
    }
}

/// The shortest number that is this value: an `f32` has fewer digits than the same `f64`.
pub fn value_text(value: f64, kind: ScalarKind) -> String {
    match kind {
        ScalarKind::Float => (value as f32).to_string(),
        ScalarKind::Bool => (value != 0.0).to_string(),
        ScalarKind::Sint
        | ScalarKind::Uint
        | ScalarKind::AbstractInt
        | ScalarKind::AbstractFloat => value.to_string(),
    }
}

/// The name of each word of a row.
pub fn column_names(job: &CaseJob<'_>) -> Vec<String> {
    job.kernel().words().flat_map(|(name, shape)| part_names(name, shape)).collect()
}

fn part_names(name: &str, shape: &TypeShape) -> Vec<String> {
    let letters = |size: u32| "xyzw".chars().take(size as usize);
    match shape {
        TypeShape::Scalar(_) => vec![name.to_owned()],
        TypeShape::Vector { size, .. } => {
            letters(*size).map(|letter| format!("{name}.{letter}")).collect()
        }
        TypeShape::Matrix { columns, rows } => (0..*columns)
            .flat_map(|column| {
                letters(*rows).map(move |letter| format!("{name}[{column}].{letter}"))
            })
            .collect(),
        TypeShape::Array { base, count } => {
            (0..*count).flat_map(|index| part_names(&format!("{name}[{index}]"), base)).collect()
        }
        TypeShape::Struct { members } => members
            .iter()
            .flat_map(|(member, shape)| part_names(&format!("{name}.{member}"), shape))
            .collect(),
    }
}
