//! Conditions of the syntax crate as those of the tree.

use lamplight_diagnostic::source::{SourceId, Span};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_syntax::wesl::{
    self, Chain, ComparisonOperand, ComparisonOperator, ConditionId, Expression, Name, Names,
};

use super::Reader;
use crate::condition::{AxisValue, Comparison, Condition};
use crate::tree::Branch;

/// The conditions of a module.
pub struct ConditionTable<'a> {
    pub module: wesl::Module,
    /// The axes with named values, for comparisons that have the value on the left.
    pub enums: &'a [String],
    /// The number of expressions whose axes are checked.
    pub checked: usize,
}

impl ConditionTable<'_> {
    /// The errors for comparisons, new since the last call, of which no side is an axis. Without any
    /// axis that is known, the axis is on the left.
    pub fn check_axes(&mut self, names: &Names, source: SourceId) -> Diagnostics {
        let is_enum = |name: &Name| self.enums.iter().any(|known| known == names.text(*name));
        let mut errors = Diagnostics::new();
        let new = self.checked..self.module.expressions.len();
        self.checked = new.end;
        for expression in &self.module.expressions[new] {
            if let Expression::Compare {
                left: ComparisonOperand::Name(left, _),
                right: ComparisonOperand::Name(right, _),
                operator: _,
                range,
            } = expression
                && !self.enums.is_empty()
                && !is_enum(left)
                && !is_enum(right)
            {
                let (left, right) = (names.text(*left), names.text(*right));
                let span = Span { source, start: range.start, end: range.end };
                let what = format!("neither `{left}` nor `{right}` is an axis with named values");
                errors.push(Diagnostic::error(codes::WRONG_KIND, what).at(span, "compared here"));
            }
        }
        errors
    }

    /// The condition of a node beside its siblings.
    pub fn branch(&self, id: ConditionId, names: &Names) -> Branch {
        let found = &self.module.conditions[id as usize];
        match (found.expression, found.after) {
            (None, _) => Branch::Else,
            (Some(expression), None) => Branch::If(self.formula(expression, names)),
            (Some(expression), Some(_)) => Branch::Elif(self.formula(expression, names)),
        }
    }

    /// The condition of a node wherever it stands: that of the blocks around it and of the siblings
    /// before it are in it.
    pub fn whole(&self, id: ConditionId, names: &Names) -> Condition {
        let found = &self.module.conditions[id as usize];
        let mut all = Condition::Literal(true);
        let mut before = found.after;
        while let Some(id) = before {
            let earlier = &self.module.conditions[id as usize];
            if let Some(expression) = earlier.expression {
                all = self.formula(expression, names).negated().and(all);
            }
            before = earlier.after;
        }
        if let Some(expression) = found.expression {
            all = all.and(self.formula(expression, names));
        }
        match found.within {
            Some(block) => self.whole(block, names).and(all),
            None => all,
        }
    }

    fn formula(&self, id: u32, names: &Names) -> Condition {
        let all = |ids: &[u32]| ids.iter().map(|id| self.formula(*id, names)).collect();
        match &self.module.expressions[id as usize] {
            Expression::Literal(value) => Condition::Literal(*value),
            Expression::Flag(name, _) => Condition::Flag(names.text(*name).to_owned()),
            Expression::Not(inner) => Condition::Not(Box::new(self.formula(*inner, names))),
            Expression::All(ids) => Condition::All(all(ids)),
            Expression::Any(ids) => Condition::Any(all(ids)),
            Expression::Compare { left, operator, right, range: _ } => {
                self.comparison(left, *operator, right, names)
            }
        }
    }

    fn comparison(
        &self,
        left: &ComparisonOperand,
        operator: ComparisonOperator,
        right: &ComparisonOperand,
        names: &Names,
    ) -> Condition {
        let text = |name: &Name| names.text(*name).to_owned();
        let is_enum = |name: &Name| self.enums.iter().any(|known| known == names.text(*name));
        let operator = comparison_of(operator);
        match (left, right) {
            (ComparisonOperand::Name(value, _), ComparisonOperand::Name(axis, _))
                if is_enum(axis) && !is_enum(value) =>
            {
                let value = AxisValue::Name(text(value));
                Condition::Compare { axis: text(axis), operator: operator.swapped(), value }
            }
            (ComparisonOperand::Name(axis, _), ComparisonOperand::Name(value, _)) => {
                let value = AxisValue::Name(text(value));
                Condition::Compare { axis: text(axis), operator, value }
            }
            (ComparisonOperand::Name(axis, _), ComparisonOperand::Integer(value, _)) => {
                let value = AxisValue::Integer(*value);
                Condition::Compare { axis: text(axis), operator, value }
            }
            (ComparisonOperand::Integer(value, _), ComparisonOperand::Name(axis, _)) => {
                let value = AxisValue::Integer(*value);
                Condition::Compare { axis: text(axis), operator: operator.swapped(), value }
            }
            (ComparisonOperand::Integer(left, _), ComparisonOperand::Integer(right, _)) => {
                Condition::Literal(operator.holds(*left, *right))
            }
        }
    }
}

fn comparison_of(operator: ComparisonOperator) -> Comparison {
    match operator {
        ComparisonOperator::Equal => Comparison::Equal,
        ComparisonOperator::NotEqual => Comparison::NotEqual,
        ComparisonOperator::Less => Comparison::Less,
        ComparisonOperator::LessEqual => Comparison::LessEqual,
        ComparisonOperator::Greater => Comparison::Greater,
        ComparisonOperator::GreaterEqual => Comparison::GreaterEqual,
    }
}

impl Reader<'_> {
    /// The translate-time attribute of the node that is next, and the index after all of its
    /// attributes.
    pub fn node_branch(
        &mut self,
        chain: &mut Chain,
    ) -> Result<(Option<Branch>, usize), Diagnostic> {
        let tokens = self.tokens;
        let found = wesl::read_attributes(&mut self.table.module, tokens, self.at, chain);
        if let Some(error) = self.table.module.take_errors().into_iter().next() {
            return Err(error);
        }
        let errors = self.table.check_axes(tokens.names, tokens.source);
        if let Some(error) = errors.into_iter().next() {
            return Err(error);
        }
        let id = found.condition.filter(|_| found.conditional);
        Ok((id.map(|id| self.table.branch(id, tokens.names)), found.end))
    }
}
