//! The other functions of a law, and where the arguments of their calls come from.

use naga::ScalarKind;

use crate::cases::{FormulaText, word_of};
use crate::formula::{Formula, Scope};
use lamplight_diagnostic::source::Span;
use lamplight_diagnostic::{Diagnostic, codes};

/// Formulas over the case's parameters, by the names of parameters of other functions.
pub type Formulas = Vec<(String, FormulaText)>;

/// Another function that a law calls. Each of its arguments is the value of a formula of the law,
/// else what the law itself gives for this name, else the case's parameter of this name.
pub struct Factor<'a> {
    case: &'a Scope<'a>,
    own: &'a Scope<'a>,
    with: Vec<(String, Formula)>,
    span: Span,
}

impl<'a> Factor<'a> {
    /// `case` has the case's parameters, `own` those of the function.
    pub fn new(
        case: &'a Scope<'a>,
        own: &'a Scope<'a>,
        with: &Formulas,
        span: Span,
    ) -> Result<Self, Diagnostic> {
        let bound = |(name, text): &(String, FormulaText)| Ok((name.clone(), text.bind(case)?));
        let with = with.iter().map(bound).collect::<Result<_, Diagnostic>>()?;
        Ok(Self { case, own, with, span })
    }

    /// The kinds of the words of a call.
    pub fn kinds(&self) -> Vec<ScalarKind> {
        self.own.0.iter().flat_map(|(_, shape)| shape.kinds()).collect()
    }

    /// Appends the words of a call for a row of the case. `given` is what the law gives for a name.
    pub fn push_call(
        &self,
        words: &mut Vec<u32>,
        row: &[f64],
        given: impl Fn(&str) -> Option<Vec<f64>>,
    ) -> Result<(), Diagnostic> {
        for (name, shape) in &self.own.0 {
            let with = self.with.iter().find(|(known, _)| known == name);
            let value = with
                .map(|(_, formula)| formula.eval(row))
                .or_else(|| given(name))
                .or_else(|| self.parameter(name, row))
                .filter(|value| value.len() == shape.words() as usize)
                .ok_or_else(|| unknown_argument(name, self.span))?;
            words
                .extend(value.iter().zip(shape.kinds()).map(|(value, kind)| word_of(*value, kind)));
        }
        Ok(())
    }

    fn parameter(&self, name: &str, row: &[f64]) -> Option<Vec<f64>> {
        let (first, shape) = self.case.find(&[name.to_owned()])?;
        Some(row[first..first + shape.words() as usize].to_vec())
    }
}

fn unknown_argument(name: &str, span: Span) -> Diagnostic {
    let message = format!("neither the law nor the case gives a `{name}` of this type");
    Diagnostic::error(codes::CASE_INVALID, message)
        .at(span, "in this law")
        .note("a value for it is given by `with`, such as `with = { f90 = 1 }`")
}
