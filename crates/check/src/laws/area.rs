//! The laws `area` and `equal`: integrals of other functions along one parameter, and equality with
//! other functions.

use super::IntegralValue;
use super::factor::{Factor, Formulas};
use super::integral::MOST_CALLS;
use crate::cases::{FormulaText, Rows};
use crate::formula::{Formula, Scope};
use lamplight_diagnostic::Diagnostic;
use lamplight_diagnostic::source::Span;
use lamplight_execute::kernel::TypeShape;
use lamplight_scene::quadrature::gauss_legendre;
use naga::ScalarKind;

/// The function's value is that of another function, or the product of several.
#[derive(Debug, Clone)]
pub struct Equality {
    /// Formulas for the parameters of each function. A single table is for all of them.
    pub with: Vec<Formulas>,
    /// The allowed error: relative for values above 1, absolute below.
    pub within: f64,
}

impl Equality {
    /// The calls of a function, one for each row of the case.
    pub fn rows(
        &self,
        index: usize,
        rows: &Rows,
        (case, own): (&Scope<'_>, &Scope<'_>),
        span: Span,
    ) -> Result<Rows, Diagnostic> {
        let none = Formulas::new();
        let with = if self.with.len() == 1 {
            &self.with[0]
        } else {
            self.with.get(index).unwrap_or(&none)
        };
        let factor = Factor::new(case, own, with, span)?;
        let mut words = Vec::new();
        for row in 0..rows.len() {
            factor.push_call(&mut words, rows.row(row), |_| None)?;
        }
        Ok(Rows::of(words, factor.kinds()))
    }
}

/// The integral of a product of functions along one parameter, by Gauss-Legendre quadrature.
#[derive(Debug, Clone)]
pub struct Area {
    /// The parameter that is integrated over. It may be one of the case, whose own value the limits
    /// can name, or only one of the functions or of `times`.
    pub along: String,
    pub from: FormulaText,
    pub to: FormulaText,
    /// Steps become finer towards `to`, down to about this size.
    pub finest: Option<FormulaText>,
    /// A weight, which may contain the parameter.
    pub times: Option<FormulaText>,
    /// Formulas for parameters that the case does not have.
    pub with: Formulas,
    pub steps: usize,
    pub within: f64,
    pub wanted: IntegralValue,
}

static NUMBER: TypeShape = TypeShape::Scalar(ScalarKind::Float);

/// The formulas of an area for the parameters of a case.
struct AreaFormulas {
    from: Formula,
    to: Formula,
    finest: Option<Formula>,
}

impl Area {
    /// The indices of the rows of the case that are integrated.
    pub fn chosen(&self, rows: &Rows) -> Vec<usize> {
        let count = rows.len().min((MOST_CALLS / self.steps).max(1));
        (0..count).map(|index| index * rows.len() / count.max(1)).collect()
    }

    /// How many calls one row takes.
    pub fn calls(&self) -> usize {
        self.steps
    }

    /// The calls of a function for the chosen rows.
    pub fn rows(
        &self,
        rows: &Rows,
        (case, own): (&Scope<'_>, &Scope<'_>),
        span: Span,
    ) -> Result<Rows, Diagnostic> {
        let (factor, bound) = (Factor::new(case, own, &self.with, span)?, self.bind(case)?);
        let mut words = Vec::new();
        for row in self.chosen(rows) {
            let row = rows.row(row);
            for (x, _) in self.nodes(row, &bound) {
                let given = |name: &str| (name == self.along).then(|| vec![x]);
                factor.push_call(&mut words, row, given)?;
            }
        }
        Ok(Rows::of(words, factor.kinds()))
    }

    /// The integrals of one component for the chosen rows; `values` has one value for each call.
    pub fn sums(
        &self,
        rows: &Rows,
        case: &Scope<'_>,
        values: &[f64],
    ) -> Result<Vec<f64>, Diagnostic> {
        let bound = self.bind(case)?;
        // The place of `along` in a row: that of the parameter of the case, or a number after all
        // of them.
        let mut scope = Scope(case.0.clone());
        if case.find(std::slice::from_ref(&self.along)).is_none() {
            scope.0.push((&self.along, &NUMBER));
        }
        let place = scope.find(std::slice::from_ref(&self.along)).map_or(0, |(first, _)| first);
        let times = self.times.as_ref().map(|times| times.bind(&scope)).transpose()?;
        let area = |(row, values): (usize, &[f64])| -> f64 {
            let row = rows.row(row);
            let mut words = row.to_vec();
            words.resize(row.len().max(place + 1), 0.0);
            let part = |((x, weight), value): ((f64, f64), &f64)| {
                words[place] = x;
                weight * value * times.as_ref().map_or(1.0, |times| times.scalar(&words))
            };
            self.nodes(row, &bound).into_iter().zip(values).map(part).sum()
        };
        Ok(self.chosen(rows).into_iter().zip(values.chunks(self.steps)).map(area).collect())
    }

    fn bind(&self, case: &Scope<'_>) -> Result<AreaFormulas, Diagnostic> {
        let finest = self.finest.as_ref().map(|finest| finest.bind(case)).transpose()?;
        Ok(AreaFormulas { from: self.from.bind(case)?, to: self.to.bind(case)?, finest })
    }

    /// The nodes of the rule, rounded to f32 as the functions get them, and their weights.
    fn nodes(&self, row: &[f64], bound: &AreaFormulas) -> Vec<(f64, f64)> {
        let (from, to) = (bound.from.scalar(row), bound.to.scalar(row));
        let (length, finest) = (to - from, bound.finest.as_ref().map(|finest| finest.scalar(row)));
        let node = |(x, weight): (f64, f64)| {
            let (u, weight) = (0.5 * (x + 1.0), 0.5 * weight);
            let (x, slope) = match finest {
                Some(finest) => {
                    let grown = (1.0 + length / finest).powf(1.0 - u);
                    (to - finest * (grown - 1.0), finest * grown * (1.0 + length / finest).ln())
                }
                None => (from + length * u, length),
            };
            (f64::from(x as f32), weight * slope)
        };
        gauss_legendre(self.steps).into_iter().map(node).collect()
    }
}
