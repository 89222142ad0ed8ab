//! Arguments for the law `finite`: those for which formulas overflow, divide by zero, or take the
//! root of a negative number.
//!
//! A function of one or two numbers gets every combination of the edge values. Any other function
//! gets seeded combinations: of the largest values alone, of edge values alone, and of plain values
//! with some edge values among them, since an edge value often makes a function return early.

use crate::cases::{Random, Rows, word_of, words_to_numbers};
use crate::formula::{Formula, Scope};
use lamplight_execute::kernel::TypeShape;
use lamplight_files::limits::CASE_WORDS;
use naga::ScalarKind;

/// The magnitude of arguments for which every function of the library has finite values.
pub const UP_TO: f64 = 1e9;
/// The most rows of seeded combinations.
const ROWS: usize = 1536;
/// The most rows of all combinations.
const PRODUCT: usize = 4096;
/// How many rows are drawn at most for each row that is wanted, since the `where` of a law may drop
/// most of them.
const TRIES: usize = 32;
/// The probability that a value is an edge value. Rows take these in turn.
const EDGES: [f64; 4] = [1.0, 0.5, 0.2, 0.1];
/// Rows in which every value is as large as it may be, with either sign.
const LARGEST: usize = 64;
/// Zero, the ends of ranges with their neighbours, and powers of ten.
const FLOATS: &[f32] = &[
    0.0,
    1e-45,
    1e-39,
    1.1754944e-38,
    1e-30,
    1e-18,
    1e-9,
    1e-6,
    1e-3,
    0.1,
    0.5,
    0.99999994,
    1.0,
    1.0000001,
    1.5,
    2.0,
    std::f32::consts::PI,
    10.0,
    89.0,
    1e3,
    1e4,
    1e6,
    1e9,
];
const INTEGERS: &[f64] = &[
    0.0,
    1.0,
    2.0,
    3.0,
    4.0,
    5.0,
    8.0,
    16.0,
    31.0,
    32.0,
    255.0,
    4096.0,
    65535.0,
    2147483647.0,
    -1.0,
    -2.0,
    -10.0,
    -11.0,
    -2147483648.0,
    4294967295.0,
];

/// Arguments no larger than `up_to`, as rows. `filter` says which are kept.
pub fn edge_rows(scope: &Scope<'_>, up_to: f64, filter: Option<&Formula>) -> Rows {
    let shapes: Vec<&TypeShape> = scope.0.iter().map(|(_, shape)| *shape).collect();
    let kinds: Vec<ScalarKind> = shapes.iter().flat_map(|shape| shape.kinds()).collect();
    let mut words = Vec::new();
    let mut keep = |row: &[f64]| {
        let held: Vec<u32> =
            row.iter().zip(&kinds).map(|(value, kind)| word_of(*value, *kind)).collect();
        let is_kept = |filter: &Formula| filter.scalar(&words_to_numbers(&held, &kinds)) == 1.0;
        if filter.is_none_or(is_kept) {
            words.extend(held);
        }
        words.len() / kinds.len().max(1)
    };
    match all_combinations(&kinds, up_to) {
        Some(rows) => rows.iter().for_each(|row| {
            keep(row);
        }),
        None => {
            let most = ROWS.min(CASE_WORDS / kinds.len().max(1));
            let mut draw = Draw { random: Random::new(1), up_to, seen: Vec::new(), edges: 1.0 };
            for index in 0..most * TRIES {
                if keep(&draw.row(&shapes, index)) >= most {
                    break;
                }
            }
        }
    }
    Rows::of(words, kinds)
}

/// The edge values of a scalar.
fn edge_values(kind: ScalarKind, up_to: f64) -> Vec<f64> {
    match kind {
        ScalarKind::Bool => vec![0.0, 1.0],
        ScalarKind::Float => {
            let sizes = FLOATS.iter().map(|value| f64::from(*value)).chain([up_to]);
            let held = sizes.filter(|value| *value <= up_to);
            held.flat_map(|value| [value, -value]).collect()
        }
        _ => INTEGERS.to_vec(),
    }
}

/// Every combination of edge values, unless there are too many.
fn all_combinations(kinds: &[ScalarKind], up_to: f64) -> Option<Vec<Vec<f64>>> {
    let mut rows = vec![Vec::new()];
    for kind in kinds {
        let values = edge_values(*kind, up_to);
        if rows.len() * values.len() > PRODUCT {
            return None;
        }
        let grown = |row: &Vec<f64>| -> Vec<Vec<f64>> {
            values.iter().map(|value| [&row[..], &[*value]].concat()).collect()
        };
        rows = rows.iter().flat_map(grown).collect();
    }
    Some(rows)
}

/// Draws the values of a row.
struct Draw {
    random: Random,
    up_to: f64,
    /// The vectors of this row so far, which others may be parallel or opposite to.
    seen: Vec<Vec<f64>>,
    /// The probability that a value of this row is an edge value.
    edges: f64,
}

impl Draw {
    fn row(&mut self, shapes: &[&TypeShape], index: usize) -> Vec<f64> {
        if index < LARGEST {
            let kinds = shapes.iter().flat_map(|shape| shape.kinds());
            return kinds.map(|kind| self.largest(kind, index)).collect();
        }
        self.seen.clear();
        self.edges = EDGES[index % EDGES.len()];
        shapes.iter().flat_map(|shape| self.value(shape)).collect()
    }

    /// The largest magnitude. All signs are positive in the first row and negative in the second,
    /// and then random. An integer is any edge value.
    fn largest(&mut self, kind: ScalarKind, index: usize) -> f64 {
        let is_negative = if index < 2 { index == 1 } else { self.chance(0.5) };
        match kind {
            ScalarKind::Float if is_negative => -self.up_to,
            ScalarKind::Float => self.up_to,
            _ => self.one_of(&edge_values(kind, self.up_to)),
        }
    }

    fn chance(&mut self, share: f64) -> bool {
        self.random.range(0.0, 1.0) < share
    }

    fn one_of(&mut self, values: &[f64]) -> f64 {
        values[self.random.range(0.0, values.len() as f64) as usize]
    }

    fn value(&mut self, shape: &TypeShape) -> Vec<f64> {
        match shape {
            TypeShape::Scalar(kind) => vec![self.number(*kind)],
            TypeShape::Vector { size, kind: ScalarKind::Float } => self.vector(*size as usize),
            TypeShape::Vector { size, kind } => (0..*size).map(|_| self.number(*kind)).collect(),
            TypeShape::Matrix { columns, rows } => self.matrix(*columns as usize, *rows as usize),
            TypeShape::Array { base, count } => {
                (0..*count).flat_map(|_| self.value(base)).collect()
            }
            TypeShape::Struct { members } => {
                members.iter().flat_map(|(_, shape)| self.value(shape)).collect()
            }
        }
    }

    fn number(&mut self, kind: ScalarKind) -> f64 {
        if kind != ScalarKind::Float || self.chance(self.edges) {
            return self.one_of(&edge_values(kind, self.up_to));
        }
        let high = self.up_to.min(if self.chance(0.8) { 1.0 } else { 10.0 });
        self.random.range(0.0, high)
    }

    /// The length of a vector: 1, or with the probability of an edge value any number.
    fn length(&mut self) -> f64 {
        if self.chance(self.edges) {
            self.number(ScalarKind::Float)
        } else {
            1.0f64.min(self.up_to)
        }
    }

    fn vector(&mut self, size: usize) -> Vec<f64> {
        let unit = self.random.unit(size);
        let length = self.length();
        let vector: Vec<f64> = if !self.chance(self.edges) {
            unit.iter().map(|value| value * length).collect()
        } else {
            match self.random.range(0.0, 6.0) as usize {
                0 => vec![0.0; size],
                1 => {
                    let axis = self.random.range(0.0, size as f64) as usize;
                    (0..size).map(|at| if at == axis { length } else { 0.0 }).collect()
                }
                2 => vec![length; size],
                3 => (0..size).map(|_| self.number(ScalarKind::Float)).collect(),
                _ => self.parallel(unit),
            }
        };
        self.seen.push(vector.clone());
        vector
    }

    /// A vector along an earlier one of the row, or against it.
    fn parallel(&mut self, otherwise: Vec<f64>) -> Vec<f64> {
        let size = otherwise.len();
        let known: Vec<Vec<f64>> =
            self.seen.iter().filter(|seen| seen.len() == size).cloned().collect();
        let along = match known.len() {
            0 => otherwise,
            count => known[self.random.range(0.0, count as f64) as usize].clone(),
        };
        let factor = self.one_of(&[1.0, 1.0, -1.0, -1.0, 0.5, 1e-9]);
        along.iter().map(|value| value * factor).collect()
    }

    fn matrix(&mut self, columns: usize, rows: usize) -> Vec<f64> {
        match self.random.range(0.0, 4.0) as usize {
            0 => vec![0.0; columns * rows],
            1 => {
                let scale = self.length();
                let words = (0..columns * rows).map(|at| (at / rows, at % rows));
                words.map(|(column, row)| if column == row { scale } else { 0.0 }).collect()
            }
            _ => (0..columns).flat_map(|_| self.vector(rows)).collect(),
        }
    }
}
