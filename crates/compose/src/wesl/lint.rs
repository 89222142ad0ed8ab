//! Warns of conditions that have the same value in every permutation.

use super::evaluate::Evaluator;
use crate::resolve::wesl::Graph;
use lamplight_diagnostic::source::Span;
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_permute::Settings;
use lamplight_syntax::wesl::{ConditionId, Expression, ExpressionId, PlacedModule};

/// How the conditions of the root package came out in the permutations that were shown so far.
#[derive(Clone)]
pub struct Outcomes<'g> {
    graph: &'g Graph,
    /// Those that had the same value each time.
    open: Vec<LintCondition>,
}

#[derive(Clone)]
struct LintCondition {
    node: u32,
    id: ConditionId,
    held: bool,
    failed: bool,
    /// It asks for something that has no value in the permutations.
    unknown: bool,
}

impl<'g> Outcomes<'g> {
    /// No permutation was shown yet.
    pub fn new(graph: &'g Graph) -> Self {
        let own = graph.nodes.iter().enumerate().filter(|(_, node)| node.package == 0);
        let conditions = own.flat_map(|(index, node)| {
            tested_conditions(&node.module).map(move |id| (index as u32, id))
        });
        let open = conditions.map(|(node, id)| LintCondition {
            node,
            id,
            held: false,
            failed: false,
            unknown: false,
        });
        Self { graph, open: open.collect() }
    }

    /// Whether no further permutation can change the outcome.
    pub fn is_settled(&self) -> bool {
        self.open.is_empty()
    }

    /// Evaluates the remaining conditions for one permutation.
    pub fn see(&mut self, settings: &Settings) {
        let mut evaluator = Evaluator::new(self.graph, settings);
        for condition in &mut self.open {
            let holds = evaluator.holds(condition.node, condition.id);
            condition.held |= holds;
            condition.failed |= !holds;
            condition.unknown |= !evaluator.errors.is_empty();
            evaluator.errors.clear();
        }
        self.settle();
    }

    /// Adds what other permutations showed of the same graph.
    pub fn join(mut self, other: &Self) -> Self {
        let place = |condition: &LintCondition| (condition.node, condition.id);
        let find = |condition: &LintCondition| {
            let found = other.open.binary_search_by_key(&place(condition), place);
            found.ok().and_then(|index| other.open.get(index))
        };
        self.open.retain_mut(|condition| {
            find(condition).is_some_and(|found| {
                condition.held |= found.held;
                condition.failed |= found.failed;
                true
            })
        });
        self.settle();
        self
    }

    /// Drops the conditions that no further permutation can change.
    fn settle(&mut self) {
        let graph = self.graph;
        self.open.retain(|condition| {
            !condition.unknown
                && !(condition.held && (condition.failed || is_later(graph, condition)))
        });
    }

    /// The places of the conditions that are evaluated.
    pub fn places(&self) -> impl Iterator<Item = Span> {
        self.graph.nodes.iter().filter(|node| node.package == 0).flat_map(|node| {
            let conditions = tested_conditions(&node.module)
                .filter_map(|id| node.module.conditions[id as usize].expression);
            conditions.filter_map(|expression| expression_span(&node.module, expression))
        })
    }

    /// A warning for each condition that always had the same value.
    pub fn warnings(&self) -> impl Iterator<Item = Diagnostic> {
        self.open.iter().filter(|condition| condition.held || condition.failed).filter_map(
            |condition| {
                let module = &self.graph.nodes[condition.node as usize].module;
                let span =
                    expression_span(module, module.conditions[condition.id as usize].expression?)?;
                Some(constant_condition(span, condition.held))
            },
        )
    }
}

/// The warning about a condition that always had the same value.
pub fn constant_condition(span: Span, held: bool) -> Diagnostic {
    let word = if held { "true" } else { "false" };
    let warning = Diagnostic::warning(
        codes::CONSTANT_CONDITION,
        format!("this condition is {word} in every permutation"),
    );
    warning.at(span, if held { "decides nothing" } else { "what it guards is in no permutation" })
}

/// Whether it may be the last branch of a chain, which covers all that is left: such a branch only
/// has to hold once.
fn is_later(graph: &Graph, condition: &LintCondition) -> bool {
    graph.nodes[condition.node as usize].module.conditions[condition.id as usize].after.is_some()
}

/// The conditions that ask for a setting; one like `@if(true)` is meant as it stands.
fn tested_conditions(module: &PlacedModule) -> impl Iterator<Item = ConditionId> {
    let asks = |(_, condition): &(usize, &lamplight_syntax::wesl::Condition)| {
        condition.expression.is_some_and(|root| expression_span(module, root).is_some())
    };
    module.conditions.iter().enumerate().filter(asks).map(|(id, _)| id as ConditionId)
}

/// From the first name of an expression to its last.
fn expression_span(module: &PlacedModule, root: ExpressionId) -> Option<Span> {
    let mut range: Option<std::ops::Range<u32>> = None;
    let mut open = vec![root];
    while let Some(next) = open.pop() {
        match &module.expressions[next as usize] {
            Expression::Literal(_) => {}
            Expression::Not(operand) => open.push(*operand),
            Expression::All(operands) | Expression::Any(operands) => open.extend(operands),
            Expression::Flag(_, found) | Expression::Compare { range: found, .. } => {
                let known = range.unwrap_or_else(|| found.clone());
                range = Some(known.start.min(found.start)..known.end.max(found.end));
            }
        }
    }
    range.map(|range| module.span(range))
}
