//! Makes the input words of every invocation from the domains of a case.

use std::sync::OnceLock;

use super::domain::{self, Domain};
use super::{Case, Oracle, TableRow};
use crate::formula::Scope;
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_execute::kernel::TypeShape;
use lamplight_execute::kernel::word_value;
use lamplight_files::limits::{CASE_ROWS, CASE_WORDS, Steps};
use naga::ScalarKind;

/// The inputs of a case, with one row for each invocation.
#[derive(Debug)]
pub struct Rows {
    /// The words, row by row, which executors take.
    pub words: Vec<u32>,
    /// The same as numbers, which references and formulas take.
    pub numbers: Vec<f64>,
    /// How many words a row has.
    pub stride: usize,
    pub kinds: Vec<ScalarKind>,
    /// The ranges of words that hold a unit vector. Shrinking changes such a vector as a whole.
    pub units: Vec<std::ops::Range<usize>>,
    pub facts: RowFacts,
}

/// What the formulas of a case say about each row, once that is asked for. All executors and
/// languages ask for the same.
#[derive(Debug, Default)]
pub struct RowFacts {
    /// The values of the formulas of the tolerance, row by row.
    pub terms: OnceLock<Vec<f64>>,
    /// Whether rounding may decide a comparison that the case names in `near`.
    pub near: OnceLock<Vec<bool>>,
    /// Whether the row is within the case's filter.
    pub inside: OnceLock<Vec<bool>>,
}

/// A parameter, or a field of one, and its domain, while rows are made.
struct Column<'a> {
    /// Index of its first word in a row.
    first: usize,
    shape: TypeShape,
    domain: &'a Domain,
    /// How many values the domain has: the same for every row.
    count: usize,
}

impl Rows {
    /// Rows of words of these kinds.
    pub fn of(words: Vec<u32>, kinds: Vec<ScalarKind>) -> Self {
        let (numbers, stride) = (words_to_numbers(&words, &kinds), kinds.len().max(1));
        Self { words, numbers, stride, kinds, units: Vec::new(), facts: RowFacts::default() }
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.words.len() / self.stride.max(1)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.words.is_empty()
    }

    /// One row as numbers; empty for a function without parameters.
    pub fn row(&self, index: usize) -> &[f64] {
        self.numbers.get(index * self.stride..(index + 1) * self.stride).unwrap_or(&[])
    }

    pub fn row_words(&self, index: usize) -> &[u32] {
        &self.words[index * self.stride..(index + 1) * self.stride]
    }

    /// Rows of the same columns from other words.
    pub fn with_words(&self, words: Vec<u32>) -> Self {
        let numbers = words_to_numbers(&words, &self.kinds);
        Self {
            words,
            numbers,
            stride: self.stride,
            kinds: self.kinds.clone(),
            units: self.units.clone(),
            facts: RowFacts::default(),
        }
    }
}

/// Makes the rows of a case for the parameters of its function. The work is subtracted from
/// `steps`.
pub fn case_rows(case: &Case, scope: &Scope<'_>, steps: &mut Steps) -> Result<Rows, Diagnostic> {
    let kinds: Vec<ScalarKind> = scope.0.iter().flat_map(|(_, shape)| shape.kinds()).collect();
    let stride = kinds.len().max(1);
    let (words, units) = match &case.oracle {
        Oracle::Table(table) => (table_words(table, scope, stride)?, Vec::new()),
        _ => generate_rows(case, scope, &kinds, steps)?,
    };
    let (numbers, facts) = (words_to_numbers(&words, &kinds), RowFacts::default());
    let rows = Rows { numbers, words, stride, kinds, units, facts };
    let Some(filter) = &case.filter else { return Ok(rows) };
    let filter = filter.bind(scope)?;
    spend_steps(case, rows.len(), filter.parts(), steps)?;
    let kept = (0..rows.len())
        .filter(|index| filter.scalar(rows.row(*index)) == 1.0)
        .flat_map(|index| rows.row_words(index).to_vec())
        .collect();
    Ok(rows.with_words(kept))
}

type GeneratedRows = (Vec<u32>, Vec<std::ops::Range<usize>>);

fn generate_rows(
    case: &Case,
    scope: &Scope<'_>,
    kinds: &[ScalarKind],
    steps: &mut Steps,
) -> Result<GeneratedRows, Diagnostic> {
    let columns = ordered_columns(case, scope)?;
    let stride = kinds.len().max(1);
    let count = bounded_count(case, &columns, stride)?;
    let fresh = columns.iter().map(|column| match (column.domain.fresh(), case.zip) {
        (0, _) | (_, false) => 1,
        // With `zip`, a row computes all these values, and takes one of them.
        (_, true) => column.count,
    });
    spend_steps(case, count, fresh.fold(stride, usize::saturating_add), steps)?;
    let grid = Grid { kinds, scope, stride };
    let mut rows = vec![0u32; stride];
    for (index, column) in columns.iter().enumerate() {
        rows = if case.zip && index > 0 {
            grid.zipped(&rows, column)
        } else {
            grid.product(&rows, column)
        };
    }
    let units = columns
        .iter()
        .filter(|column| column.domain.is_unit())
        .map(|column| column.first..column.first + column.shape.words() as usize);
    Ok((rows, units.collect()))
}

/// Subtracts the work of a case from its steps: `each` steps for each of `rows` rows.
///
/// # Errors
/// The case has fewer steps left.
pub fn spend_steps(
    case: &Case,
    rows: usize,
    each: usize,
    steps: &mut Steps,
) -> Result<(), Diagnostic> {
    let most = steps.most();
    steps.spend(rows as u64 * each as u64).map_err(|_| {
        let function = &case.function;
        let message =
            format!("the {rows} rows of `{function}` take {each} steps each, more than {most}");
        Diagnostic::error(codes::CASE_INVALID, message)
            .at(case.span, "of this function")
            .note("its domains, formulas, laws and tolerances are counted for every row")
    })
}

/// How many rows there will be. Refuses a case with too many, before any of them is made.
fn bounded_count(case: &Case, columns: &[Column<'_>], stride: usize) -> Result<usize, Diagnostic> {
    let counts = columns.iter().map(|column| column.count);
    let rows = match case.zip {
        true => counts.max().unwrap_or(1),
        false => counts.fold(1, usize::saturating_mul),
    };
    let most = CASE_ROWS.min(CASE_WORDS / stride.max(1));
    if rows <= most {
        return Ok(rows);
    }
    let message = format!("the domains of `{}` multiply to more than {most} rows", case.function);
    Err(Diagnostic::error(codes::CASE_INVALID, message)
        .at(case.span, "of this function")
        .note("`mode = \"zip\"` takes the domains side by side"))
}

/// The columns, each after those that its values depend on. Fails if a parameter has no values, or
/// if columns depend on each other in a cycle.
fn ordered_columns<'a>(case: &'a Case, scope: &Scope<'_>) -> Result<Vec<Column<'a>>, Diagnostic> {
    let mut left: Vec<_> = case.inputs.iter().collect();
    let mut done: Vec<&str> = Vec::new();
    let mut columns = Vec::new();
    while !left.is_empty() {
        let ready = left
            .iter()
            .position(|(_, domain, _)| domain.needs().iter().all(|need| done.contains(need)));
        let Some(ready) = ready else {
            let (_, domain, span) = left[0];
            let message =
                format!("`{}` is given no values, or only in a cycle", domain.needs().join("`, `"));
            return Err(Diagnostic::error(codes::CASE_INVALID, message).at(*span, "needed here"));
        };
        let (path, domain, span) = left.remove(ready);
        let (first, shape) = scope
            .find(&path_parts(path))
            .ok_or_else(|| scope.unknown(path).at(*span, "given here"))?;
        let count = domain
            .count(shape, &|other| scope.find(&path_parts(other)).map(|(_, shape)| shape.clone()))
            .map_err(|message| {
                Diagnostic::error(codes::CASE_INVALID, format!("`{path}`: {message}"))
                    .at(*span, "given here")
            })?;
        columns.push(Column { first, shape: shape.clone(), domain, count });
        done.push(path);
    }
    for (name, _) in &scope.0 {
        let given = |path: &str| {
            path == *name || path.strip_prefix(name).is_some_and(|rest| rest.starts_with('.'))
        };
        if !case.inputs.iter().any(|(path, _, _)| given(path)) {
            return Err(Diagnostic::error(
                codes::CASE_INVALID,
                format!("the parameter `{name}` is given no values"),
            )
            .at(case.span, "of this function"));
        }
    }
    Ok(columns)
}

/// What is needed to add columns to rows: the kinds of the words, the parameters, and the words of
/// a row.
struct Grid<'g, 's> {
    kinds: &'g [ScalarKind],
    scope: &'g Scope<'s>,
    stride: usize,
}

impl Grid<'_, '_> {
    /// Combines every row with every value of the column.
    fn product(&self, rows: &[u32], column: &Column<'_>) -> Vec<u32> {
        let mut grown = Vec::with_capacity(rows.len().saturating_mul(column.count));
        let mut values = Vec::new();
        for (salt, row) in rows.chunks(self.stride).enumerate() {
            if salt == 0 || !column.domain.needs().is_empty() {
                values = self.values(row, column, salt as u64);
            }
            for value in &values {
                push_row(&mut grown, row, column.first, value);
            }
        }
        grown
    }

    /// Gives each row one value of the column, in order. The shorter of the two lists is repeated.
    fn zipped(&self, rows: &[u32], column: &Column<'_>) -> Vec<u32> {
        let rows: Vec<&[u32]> = rows.chunks(self.stride).collect();
        let Some(first) = rows.first() else { return Vec::new() };
        let mut grown = Vec::new();
        if column.domain.needs().is_empty() {
            let values = self.values(first, column, 0);
            for index in 0..rows.len().max(values.len()) {
                let value = &values[index % values.len()];
                push_row(&mut grown, rows[index % rows.len()], column.first, value);
            }
            return grown;
        }
        for (index, row) in rows.iter().enumerate() {
            let values = self.values(row, column, index as u64);
            push_row(&mut grown, row, column.first, &values[index % values.len()]);
        }
        grown
    }

    fn values(&self, row: &[u32], column: &Column<'_>, salt: u64) -> Vec<Vec<u32>> {
        let other = |path: &str| {
            let (first, count) = self
                .scope
                .find(&path_parts(path))
                .map_or((0, 0), |(first, shape)| (first, shape.words() as usize));
            words_to_numbers(&row[first..first + count], &self.kinds[first..first + count])
        };
        column.domain.words(&column.shape, &other, salt)
    }
}

/// Appends a copy of `row` in which `value` stands from word `first` on.
fn push_row(rows: &mut Vec<u32>, row: &[u32], first: usize, value: &[u32]) {
    let start = rows.len() + first;
    rows.extend_from_slice(row);
    rows[start..start + value.len()].copy_from_slice(value);
}

/// The parts of a path: `light` and `kind` of `light.kind`.
fn path_parts(path: &str) -> Vec<String> {
    path.split('.').map(str::to_owned).collect()
}

fn table_words(
    table: &[TableRow],
    scope: &Scope<'_>,
    stride: usize,
) -> Result<Vec<u32>, Diagnostic> {
    let most = CASE_WORDS / stride.max(1);
    if let Some(row) = table.get(most) {
        let message = format!("the table has more than {most} rows");
        return Err(Diagnostic::error(codes::CASE_INVALID, message).at(row.span, "in this row"));
    }
    let mut words = Vec::new();
    for row in table {
        let mut filled = vec![0; stride];
        for (path, value) in &row.values {
            let (first, shape) = scope
                .find(&path_parts(path))
                .ok_or_else(|| scope.unknown(path).at(row.span, "in this row"))?;
            let kinds = shape.kinds();
            if value.len() != kinds.len() {
                let message = format!("`{path}` has {} values, not {}", kinds.len(), value.len());
                return Err(
                    Diagnostic::error(codes::CASE_INVALID, message).at(row.span, "in this row")
                );
            }
            for (index, (value, kind)) in value.iter().zip(kinds).enumerate() {
                filled[first + index] = domain::word_of(*value, kind);
            }
        }
        words.extend(filled);
    }
    Ok(words)
}

/// Words as numbers. `kinds` are those of one row, and repeat.
pub fn words_to_numbers(words: &[u32], kinds: &[ScalarKind]) -> Vec<f64> {
    words.iter().zip(kinds.iter().cycle()).map(|(word, kind)| word_value(*word, *kind)).collect()
}
