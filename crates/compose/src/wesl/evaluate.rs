//! Evaluates conditions for one choice of settings, each at most once.

use std::collections::HashSet;

use rustc_hash::FxHashMap;

use crate::resolve::wesl::{Graph, NodeCondition, flag_places, shown_at};
use lamplight_diagnostic::source::Span;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_files::limits::count_steps;
use lamplight_permute::{Setting, Settings};
use lamplight_syntax::wesl::{
    ComparisonOperand, ComparisonOperator, ConditionId, Event, Expression, ExpressionId, Name,
};

/// What is known of a condition.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ConditionState {
    Unknown,
    False,
    True,
    /// False, since an earlier one in its chain is true.
    Passed,
}

/// Answers conditions and records which settings they asked for.
pub struct Evaluator<'a> {
    graph: &'a Graph,
    settings: &'a Settings,
    states: Vec<ConditionState>,
    /// The settings in the order in which they were asked for.
    pub reads: Vec<(String, Setting)>,
    pub errors: Diagnostics,
    unknown: HashSet<Name>,
    /// Where flags are named, once one of them has no value.
    places: Option<FxHashMap<Name, Vec<Span>>>,
    /// By node and guard: whether the condition of that guard, or of one after it in its chain,
    /// holds.
    guards: FxHashMap<(u32, u32), bool>,
}

impl<'a> Evaluator<'a> {
    pub fn new(graph: &'a Graph, settings: &'a Settings) -> Self {
        let states = vec![ConditionState::Unknown; graph.totals.conditions as usize];
        Self {
            graph,
            settings,
            states,
            reads: Vec::new(),
            errors: Vec::new(),
            unknown: HashSet::new(),
            places: None,
            guards: FxHashMap::default(),
        }
    }

    /// Whether a condition of a node's module holds.
    pub fn holds(&mut self, node: u32, condition: ConditionId) -> bool {
        let here = &self.graph.nodes[node as usize];
        let state = |this: &Self, id: u32| this.states[(here.bases.conditions + id) as usize];
        let mut chain = Vec::new();
        let mut next = Some(condition);
        while let Some(id) = next.filter(|id| state(self, *id) == ConditionState::Unknown) {
            chain.push(id);
            count_steps(1);
            next = here.module.conditions[id as usize].after;
        }
        for id in chain.into_iter().rev() {
            let condition = &here.module.conditions[id as usize];
            let before = condition.after.map(|before| state(self, before));
            let answer = match (before, condition.expression) {
                _ if condition.within.is_some_and(|block| !self.holds(node, block)) => {
                    ConditionState::False
                }
                (Some(ConditionState::True | ConditionState::Passed), _) => ConditionState::Passed,
                (_, Some(expression)) if !self.value(node, expression) => ConditionState::False,
                _ => ConditionState::True,
            };
            self.states[(here.bases.conditions + id) as usize] = answer;
        }
        state(self, condition) == ConditionState::True
    }

    /// Whether all hold. Evaluation ends at the first that does not.
    pub fn all_hold(&mut self, conditions: &[NodeCondition]) -> bool {
        conditions.iter().all(|one| self.holds(one.node, one.condition))
    }

    /// Visits the events of an item under these settings: uses of globals, cuts, and removed nodes.
    pub fn live(&mut self, node: u32, events: &[Event], mut visit: impl FnMut(&mut Self, Event)) {
        let (mut at, mut steps) = (0, 0);
        while let Some(event) = events.get(at) {
            at += 1;
            steps += 1;
            match *event {
                Event::Node { condition, .. } if self.holds(node, condition) => {}
                Event::Node { next, .. } => {
                    visit(self, *event);
                    at = next as usize;
                }
                Event::Use { guard: Some(guard), .. } if self.is_local(node, guard) => {}
                _ => visit(self, *event),
            }
        }
        count_steps(steps);
    }

    /// Whether a use means a local declaration whose condition holds. The chains of guards share
    /// their ends, so the answer for each guard is remembered.
    fn is_local(&mut self, node: u32, guard: u32) -> bool {
        let graph = self.graph;
        let (mut guard, mut passed, mut answer) = (Some(guard), Vec::new(), false);
        while let Some(index) = guard {
            if let Some(known) = self.guards.get(&(node, index)) {
                answer = *known;
                break;
            }
            let found = graph.nodes[node as usize].module.guards[index as usize];
            passed.push(index);
            count_steps(1);
            if self.holds(node, found.condition) {
                answer = true;
                break;
            }
            guard = found.next;
        }
        self.guards.extend(passed.into_iter().map(|index| ((node, index), answer)));
        answer
    }

    /// The default of a setting that becomes an `override`. It is not recorded as read, since the
    /// text is the same whatever value the permutation has.
    pub fn open(&self, name: Name) -> Option<Setting> {
        self.settings
            .open
            .get(self.graph.names.text(name))
            .filter(|value| !matches!(value, Setting::Name(_)))
            .cloned()
    }

    /// The literal of a constant that was given from outside.
    pub fn given(&self, name: Name) -> Option<&str> {
        self.settings.constants.get(self.graph.names.text(name)).map(String::as_str)
    }

    /// The value of an axis that is used as a constant. The value for undeclared features does not
    /// apply to numbers.
    pub fn number(&mut self, name: Name, span: Span) -> Option<Setting> {
        let text = self.graph.names.text(name);
        if self.settings.values.contains_key(text) {
            return self.setting(name, span);
        }
        if self.unknown.insert(name) {
            let error = Diagnostic::error(
                codes::UNKNOWN_FEATURE,
                format!("the constant `{text}` has no value"),
            )
            .at(span, "asked for here")
            .note(format!("help: give it one with `--constant {text}=VALUE`"));
            let known = self.settings.constants.keys().chain(self.settings.values.keys());
            self.errors.push(error.suggest(text, known.map(String::as_str)));
        }
        None
    }

    /// The value of a setting, which is recorded; an error at `span` if it has none.
    pub fn setting(&mut self, name: Name, span: Span) -> Option<Setting> {
        let text = self.graph.names.text(name);
        let Some(value) = self.settings.value(text) else {
            if self.unknown.insert(name) {
                let error =
                    Diagnostic::error(codes::UNKNOWN_FEATURE, format!("unknown feature `{text}`"))
                        .at(span, "asked for here");
                let places = self.places.get_or_insert_with(|| flag_places(self.graph));
                let others = places.remove(&name).unwrap_or_default().into_iter();
                let others = others.filter(|place| *place != span).collect();
                let error = shown_at(error, others, "and here");
                self.errors
                    .push(error.suggest(text, self.settings.values.keys().map(String::as_str)));
            }
            return None;
        };
        if !self.reads.iter().any(|(read, _)| read == text) {
            self.reads.push((text.to_owned(), value.clone()));
        }
        Some(value.clone())
    }

    fn span(&self, node: u32, range: &std::ops::Range<u32>) -> Span {
        self.graph.nodes[node as usize].module.span(range.clone())
    }

    fn value(&mut self, node: u32, expression: ExpressionId) -> bool {
        let graph = self.graph;
        match &graph.nodes[node as usize].module.expressions[expression as usize] {
            Expression::Literal(value) => *value,
            Expression::Flag(name, range) => self.flag(*name, self.span(node, range)),
            Expression::Not(operand) => !self.value(node, *operand),
            Expression::All(operands) => operands.iter().all(|operand| self.value(node, *operand)),
            Expression::Any(operands) => operands.iter().any(|operand| self.value(node, *operand)),
            Expression::Compare { left, operator, right, range } => {
                let outcome = self.compare(node, left, *operator, right, range);
                outcome.unwrap_or_else(|error| {
                    self.errors.push(error);
                    false
                })
            }
        }
    }

    fn flag(&mut self, name: Name, span: Span) -> bool {
        match self.setting(name, span) {
            Some(Setting::Bool(value)) => value,
            Some(value) => {
                let text = self.graph.names.text(name);
                let error =
                    Diagnostic::error(codes::WRONG_KIND, format!("`{text}` is not boolean"))
                        .at(span, format!("its value is `{value}`"));
                self.errors.push(error.note(format!("help: compare it: `{text} == {value}`")));
                false
            }
            None => false,
        }
    }

    fn compare(
        &mut self,
        node: u32,
        left: &ComparisonOperand,
        operator: ComparisonOperator,
        right: &ComparisonOperand,
        range: &std::ops::Range<u32>,
    ) -> Result<bool, Diagnostic> {
        let is_enum = |name: &Name| self.settings.enums.contains_key(self.graph.names.text(*name));
        match (left, right) {
            (ComparisonOperand::Name(axis, at), ComparisonOperand::Name(value, value_at))
                if is_enum(axis) =>
            {
                self.compare_enum(node, (*axis, at), operator, (*value, value_at))
            }
            (ComparisonOperand::Name(value, value_at), ComparisonOperand::Name(axis, at))
                if is_enum(axis) =>
            {
                self.compare_enum(node, (*axis, at), operator, (*value, value_at))
            }
            (ComparisonOperand::Name(axis, at), ComparisonOperand::Integer(value, _)) => self
                .compare_integer(node, *axis, at, |axis| compare_ordered(axis, operator, *value)),
            (ComparisonOperand::Integer(value, _), ComparisonOperand::Name(axis, at)) => self
                .compare_integer(node, *axis, at, |axis| compare_ordered(*value, operator, axis)),
            (ComparisonOperand::Name(axis, at), ComparisonOperand::Name(..)) => {
                Err(self.undeclared(*axis, self.span(node, at), "enum"))
            }
            (ComparisonOperand::Integer(..), ComparisonOperand::Integer(..)) => {
                Err(Diagnostic::error(codes::WRONG_KIND, "a comparison without an axis")
                    .at(self.span(node, range), "always the same"))
            }
        }
    }

    fn compare_enum(
        &mut self,
        node: u32,
        (axis, axis_at): (Name, &std::ops::Range<u32>),
        operator: ComparisonOperator,
        (value, value_at): (Name, &std::ops::Range<u32>),
    ) -> Result<bool, Diagnostic> {
        let (axis_text, text) = (self.graph.names.text(axis), self.graph.names.text(value));
        let span = self.span(node, axis_at);
        let known = self.settings.enums.get(axis_text).map_or(&[][..], Vec::as_slice);
        if !known.iter().any(|known| known == text) {
            return Err(Diagnostic::error(
                codes::UNKNOWN_VALUE,
                format!("the axis `{axis_text}` has no value `{text}`"),
            )
            .at(self.span(node, value_at), "not one of its values")
            .note(format!("its values are {}", quoted_values(known)))
            .suggest(text, known.iter().map(String::as_str)));
        }
        let Some(chosen) = self.setting(axis, span) else { return Ok(false) };
        let equal = chosen.to_string() == text;
        match operator {
            ComparisonOperator::Equal => Ok(equal),
            ComparisonOperator::NotEqual => Ok(!equal),
            _ => Err(Diagnostic::error(
                codes::WRONG_KIND,
                format!("the values of `{axis_text}` have no order"),
            )
            .at(span, "an enum axis")),
        }
    }

    fn compare_integer(
        &mut self,
        node: u32,
        axis: Name,
        at: &std::ops::Range<u32>,
        answer: impl Fn(i64) -> bool,
    ) -> Result<bool, Diagnostic> {
        let span = self.span(node, at);
        if !self.settings.integers.contains(self.graph.names.text(axis)) {
            return Err(self.undeclared(axis, span, "integer"));
        }
        match self.setting(axis, span) {
            Some(Setting::Int(value)) => Ok(answer(value)),
            Some(value) => {
                let message = format!("`{}` is not an integer", self.graph.names.text(axis));
                Err(Diagnostic::error(codes::WRONG_KIND, message)
                    .at(span, format!("its value is `{value}`")))
            }
            None => Ok(false),
        }
    }

    fn undeclared(&self, axis: Name, span: Span, kind: &str) -> Diagnostic {
        let text = self.graph.names.text(axis);
        let declared =
            self.settings.enums.keys().chain(&self.settings.integers).map(String::as_str);
        Diagnostic::error(
            codes::WRONG_KIND,
            format!("`{text}` is compared but is not a declared {kind} axis"),
        )
        .at(span, "only declared axes can be compared")
        .suggest(text, declared)
    }
}

fn quoted_values(values: &[String]) -> String {
    values.iter().map(|value| format!("`{value}`")).collect::<Vec<_>>().join(", ")
}

fn compare_ordered(left: i64, operator: ComparisonOperator, right: i64) -> bool {
    match operator {
        ComparisonOperator::Equal => left == right,
        ComparisonOperator::NotEqual => left != right,
        ComparisonOperator::Less => left < right,
        ComparisonOperator::LessEqual => left <= right,
        ComparisonOperator::Greater => left > right,
        ComparisonOperator::GreaterEqual => left >= right,
    }
}
