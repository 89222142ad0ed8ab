//! Values of an older version: records of what functions returned, and comparisons with them.
//!
//! `cases -> jobs -> measured values -> a record`, or `-> a comparison with a record`
//!
//! A record has the inputs, so a comparison calls the functions of today with the inputs of then.
//! It does not matter whether the domains of a case have changed meanwhile.

mod compare;
mod form;

pub use compare::{ValueChange, ValueComparison, compare_values};
pub use form::{is_record, parse_record, record_text};

use naga::ScalarKind;

use super::job::{CaseJob, Goal};
use super::{facts, profile, verdict};
use crate::tolerance;
use lamplight_bundle::Language;
use lamplight_diagnostic::source::Span;
use lamplight_diagnostic::{Diagnostic, Diagnostics};
use lamplight_execute::Session;
use lamplight_execute::fixture::{Fixture, FixtureSampler, FixtureTexture};
use lamplight_execute::kernel::{Kernel, ParameterKind, TypeShape, word_value};

/// The most inputs of a case that are recorded.
pub const ROWS: usize = 32;

/// What the functions of a package returned.
#[derive(Debug, Clone, PartialEq)]
pub struct ValueRecord {
    /// Version of the program that wrote it.
    pub tool: String,
    /// Version of the library that the program carried.
    pub library: String,
    /// Name of the package, if it declares one.
    pub package: Option<String>,
    /// Sorted by name and language.
    pub cases: Vec<RecordedCase>,
}

/// What one function returned for the inputs of one case.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedCase {
    /// [`Outcome::record`](super::Outcome::record).
    pub name: String,
    pub language: Language,
    /// The types of the parameters and of the result.
    pub signature: String,
    /// A hash of the textures and samplers that the case binds; empty if there are none.
    pub fixtures: String,
    pub rows: Vec<RecordedRow>,
}

/// One call.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedRow {
    pub inputs: Vec<u32>,
    pub results: Vec<u32>,
    /// The expected value of each result, if one is known.
    pub exact: Vec<f64>,
    /// How far each result may be from the expected value.
    pub allowed: Vec<f64>,
}

/// A case as it is today, and what a comparison needs to report about it.
#[derive(Debug)]
pub struct MeasuredCase {
    pub case: RecordedCase,
    /// The scalar kind of each result.
    pub kinds: Vec<ScalarKind>,
    /// The name of each input, and its scalar kind.
    pub inputs: Vec<(String, ScalarKind)>,
    /// Where the case names the function.
    pub span: Span,
}

impl RecordedCase {
    /// Path of the function: the name without the number of the case.
    pub fn function(&self) -> &str {
        self.name.split('#').next().unwrap_or_default()
    }

    /// Path of the module: `lighting::spot`.
    pub fn module(&self) -> &str {
        self.function().rsplit_once("::").map_or("", |(module, _)| module)
    }

    /// The name and the language, for messages.
    pub fn title(&self) -> String {
        format!("{} ({})", self.name, self.language.name())
    }

    /// The function as a whole, unless one of the others calls it too.
    fn title_among(&self, others: &mut dyn Iterator<Item = &Self>) -> String {
        let mut others = others.filter(|other| other.language == self.language);
        match others.any(|other| other.function() == self.function()) {
            true => self.title(),
            false => format!("{} ({})", self.function(), self.language.name()),
        }
    }

    /// Whether the other one calls the same function in the same language for the same case.
    pub fn is_same_case(&self, other: &Self) -> bool {
        self.name == other.name && self.language == other.language
    }

    /// Whether the inputs of one can be given to the other.
    fn takes_inputs_of(&self, other: &Self) -> bool {
        self.signature == other.signature && self.fixtures == other.fixtures
    }
}

/// Measures the cases of jobs: for the inputs of the record, where one is given and has the case,
/// and else for a choice of the inputs of the case.
pub fn measure_values(
    jobs: &[CaseJob<'_>],
    session: &mut dyn Session,
    old: Option<&ValueRecord>,
) -> Result<Vec<MeasuredCase>, Diagnostics> {
    let mut measured = Vec::new();
    for job in jobs {
        let chosen = if old.is_none() { chosen_rows(job) } else { Vec::new() };
        for (language, kernel) in &job.kernels {
            let mut case = described_case(job, *language, kernel);
            case.rows = match old.and_then(|old| old.find(&case)) {
                Some(known) if known.takes_inputs_of(&case) => known.rows.clone(),
                _ => chosen.iter().map(|row| RecordedRow::of(job, *row)).collect(),
            };
            run_rows(&mut case, kernel, session).map_err(|error| vec![error])?;
            if old.is_none() {
                add_tolerances(&mut case, job, &chosen);
            }
            let (names, kinds) = (profile::column_names(job), job.rows.kinds.iter().copied());
            measured.push(MeasuredCase {
                case,
                kinds: kernel.result_kinds(),
                inputs: names.into_iter().zip(kinds).collect(),
                span: job.case.span,
            });
        }
    }
    measured.sort_by(|a, b| form::case_order(&a.case).cmp(&form::case_order(&b.case)));
    Ok(measured)
}

impl ValueRecord {
    fn find(&self, case: &RecordedCase) -> Option<&RecordedCase> {
        self.cases.iter().find(|known| known.is_same_case(case))
    }
}

/// The results of all rows of a case. Inputs of another length, which a damaged record has, are
/// left without results, which the comparison reports.
fn run_rows(
    case: &mut RecordedCase,
    kernel: &Kernel,
    session: &mut dyn Session,
) -> Result<(), Diagnostic> {
    let stride = kernel.input_words().max(1) as usize;
    let results = kernel.result_words().max(1) as usize;
    if case.rows.iter().any(|row| row.inputs.len() != stride) {
        case.rows.iter_mut().for_each(|row| row.results.clear());
        return Ok(());
    }
    let words: Vec<u32> = case.rows.iter().flat_map(|row| row.inputs.iter().copied()).collect();
    if words.is_empty() {
        return Ok(());
    }
    let found = session.run(kernel, &words)?;
    for (row, found) in case.rows.iter_mut().zip(found.chunks(results)) {
        row.results = found.to_vec();
    }
    Ok(())
}

fn described_case(job: &CaseJob<'_>, language: Language, kernel: &Kernel) -> RecordedCase {
    RecordedCase {
        name: job.record.clone(),
        language,
        signature: signature_text(kernel),
        fixtures: fixtures_hash(kernel),
        rows: Vec::new(),
    }
}

/// A choice of the rows whose value is certain: a comparison of others would prove nothing.
fn chosen_rows(job: &CaseJob<'_>) -> Vec<usize> {
    let certain: Vec<usize> = (0..job.rows.len()).filter(|row| is_certain(job, *row)).collect();
    spread(certain.len()).into_iter().map(|at| certain[at]).collect()
}

fn is_certain(job: &CaseJob<'_>, row: usize) -> bool {
    let is_open = |goal: &Goal| goal.doubtful || verdict::is_indeterminate(goal);
    !job.expected.get(row).is_some_and(is_open) && !facts::is_ambiguous(job, &job.rows, row)
}

/// At most [`ROWS`] numbers below `count`, spread by the golden ratio. Equal steps would meet only
/// some values of a parameter where the rows are a product of domains.
fn spread(count: usize) -> Vec<usize> {
    const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;
    if count <= ROWS {
        return (0..count).collect();
    }
    let at = |index: u64| {
        let part = u128::from(index.wrapping_mul(GOLDEN)) * count as u128;
        (part >> 64) as usize
    };
    let mut chosen: Vec<usize> = (0..ROWS as u64).map(at).collect();
    chosen.sort_unstable();
    chosen.dedup();
    chosen
}

impl RecordedRow {
    /// A row without results.
    fn of(job: &CaseJob<'_>, row: usize) -> Self {
        let exact = job.expected.get(row).map_or_else(Vec::new, |goal| goal.expected.value.clone());
        let inputs = job.rows.row_words(row).to_vec();
        Self { inputs, results: Vec::new(), exact, allowed: Vec::new() }
    }
}

/// Adds to each row how far its results may be off. Rows for which everything is allowed are left
/// out.
fn add_tolerances(case: &mut RecordedCase, job: &CaseJob<'_>, chosen: &[usize]) {
    let kinds = job.kernel().result_kinds();
    for (row, index) in case.rows.iter_mut().zip(chosen) {
        let values = tolerance::formula_values(&job.terms, job.rows.row(*index));
        let goal = job.expected.get(*index);
        let allowed = |word: usize| {
            if kinds[word] != ScalarKind::Float {
                return 0.0;
            }
            let own = goal.and_then(|goal| goal.errors.get(word)).copied().unwrap_or(0.0);
            // A case that has only laws has no expected values.
            let found = || word_value(row.results[word], kinds[word]);
            let expected = row.exact.get(word).copied().unwrap_or_else(found);
            tolerance::allowed_error(&job.terms, &values, word, expected) + own
        };
        row.allowed = (0..kinds.len()).map(allowed).collect();
    }
    case.rows.retain(|row| row.allowed.iter().all(|allowed| allowed.is_finite()));
}

/// The types of the parameters and of what the function returns, in WGSL's words.
fn signature_text(kernel: &Kernel) -> String {
    let parameter = |kind: &ParameterKind| match kind {
        ParameterKind::Words { offset: _, shape } => type_text(shape),
        ParameterKind::Resource(resource) => match resource.fixture.sampler() {
            Some(_) => "sampler".to_owned(),
            None => "texture".to_owned(),
        },
    };
    let parameters: Vec<String> =
        kernel.parameters.iter().map(|found| parameter(&found.kind)).collect();
    let results: Vec<String> = kernel.results.iter().map(type_text).collect();
    format!("({}) -> {}", parameters.join(", "), results.join(", "))
}

fn type_text(shape: &TypeShape) -> String {
    match shape {
        TypeShape::Scalar(kind) => scalar_text(*kind).to_owned(),
        TypeShape::Vector { size, kind } => format!("vec{size}<{}>", scalar_text(*kind)),
        TypeShape::Matrix { columns, rows } => format!("mat{columns}x{rows}<f32>"),
        TypeShape::Array { base, count } => format!("array<{}, {count}>", type_text(base)),
        TypeShape::Struct { members } => {
            let member =
                |(name, shape): &(String, TypeShape)| format!("{name}: {}", type_text(shape));
            format!("{{ {} }}", members.iter().map(member).collect::<Vec<_>>().join(", "))
        }
    }
}

fn scalar_text(kind: ScalarKind) -> &'static str {
    match kind {
        ScalarKind::Float => "f32",
        ScalarKind::Sint => "i32",
        ScalarKind::Uint => "u32",
        ScalarKind::Bool => "bool",
        ScalarKind::AbstractInt | ScalarKind::AbstractFloat => "number",
    }
}

/// Characters of a hash: 64 bits.
const HASH: usize = 16;

fn fixtures_hash(kernel: &Kernel) -> String {
    let mut hasher = blake3::Hasher::new();
    let mut any = false;
    for resource in kernel.resources() {
        any = true;
        hash_fixture(&mut hasher, &resource.fixture);
    }
    if any { hasher.finalize().to_hex()[..HASH].to_owned() } else { String::new() }
}

fn hash_fixture(hasher: &mut blake3::Hasher, fixture: &Fixture) {
    match fixture {
        Fixture::Texture(FixtureTexture { kind, width, height, texels }) => {
            hasher.update(format!("{kind:?} {width} {height}\n").as_bytes());
            for texel in texels {
                hasher.update(&texel.to_bits().to_le_bytes());
            }
        }
        Fixture::Sampler(sampler) => {
            let FixtureSampler { compare: _, linear, address: _ } = sampler;
            let (address, compare) = sampler.web_words();
            hasher.update(format!("{linear} {address} {compare:?}\n").as_bytes());
        }
    }
}
