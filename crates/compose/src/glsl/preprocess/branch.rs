//! Chooses which branch of a conditional is read.

use std::ops::Range;

use super::super::always;
use super::super::condition::evaluate_condition;
use super::super::expand::{Fatal, TokenInput};
use super::PreprocessorState;
use crate::Decision;
use lamplight_diagnostic::Diagnostics;
use lamplight_diagnostic::source::Span;
use lamplight_files::limits::count_steps;
use lamplight_syntax::glsl::{Directive, FilePart};

impl PreprocessorState<'_, '_> {
    /// Continues in the first branch whose condition holds. If a condition has an error, no branch
    /// is taken, since errors in the branches would only follow from it.
    pub(super) fn choose(&mut self, module: usize, mut index: usize) -> Result<(), Fatal> {
        while let Some(FilePart::Directive(directive, span)) =
            self.graph.modules[module].parts.get(index)
        {
            count_steps(1);
            self.warnings.extend(always::always_warning(
                &self.expander,
                &self.graph.modules[module],
                index,
            ));
            let (holds, next) = match directive {
                Directive::If { condition, next } => {
                    (self.decide(module, condition.clone(), *span, false)?, *next)
                }
                Directive::Elif { condition, next, .. } => {
                    (self.decide(module, condition.clone(), *span, true)?, *next)
                }
                Directive::Ifdef { name: Ok(name), negated, next } => {
                    (Ok(self.expander.table.is_defined(*name) != *negated), *next)
                }
                Directive::Ifdef { name: Err(error), next, .. } => {
                    (Err(vec![(**error).clone()]), *next)
                }
                _ => break,
            };
            match holds {
                Ok(true) => break,
                Ok(false) => index = next,
                Err(errors) => {
                    self.expander.errors.extend(errors);
                    self.skip_all(next);
                    return Ok(());
                }
            }
        }
        self.jump(index + 1);
        Ok(())
    }

    fn decide(
        &mut self,
        module: usize,
        condition: Range<u32>,
        span: Span,
        later: bool,
    ) -> Result<Result<bool, Diagnostics>, Fatal> {
        let before = self.expander.reads.count;
        let outcome = self.evaluate(module, condition, span)?;
        if let (Ok(holds), true) = (&outcome, self.expander.reads.count > before) {
            self.decisions.push(Decision { span, holds: *holds, later });
        }
        Ok(outcome)
    }

    fn evaluate(
        &mut self,
        module: usize,
        condition: Range<u32>,
        span: Span,
    ) -> Result<Result<bool, Diagnostics>, Fatal> {
        let mut tokens = Vec::new();
        let before = self.expander.errors.len();
        self.expander.in_condition = true;
        self.expander.run(
            TokenInput::Source { module: module as u32, at: condition.start, end: condition.end },
            &mut tokens,
        )?;
        self.expander.in_condition = false;
        if self.expander.errors.len() > before {
            return Ok(Err(self.expander.errors.split_off(before)));
        }
        Ok(evaluate_condition(&mut self.expander, &tokens, span).map_err(|error| vec![error]))
    }

    /// Continues at the `#endif` of a conditional; `next` is one of its later branches.
    fn skip_all(&mut self, mut next: usize) {
        let module = self.open.last().map_or(0, |open| open.module);
        let branch = self.graph.modules[module].parts.get(next);
        if let Some(FilePart::Directive(Directive::Elif { end, .. } | Directive::Else { end }, _)) =
            branch
        {
            next = *end;
        }
        self.jump(next);
    }
}
