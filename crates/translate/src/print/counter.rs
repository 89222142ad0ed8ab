//! Loops that count up, and loops that go on early.

use super::visit::{own_expressions, statements, targets};
use crate::tree::{Binary, Block, Expression, ExpressionKind, Meaning, NumberValue, Statement};
use crate::tree::{Type, Unary};

/// The variable of a loop if it only counts up, from zero or more to a bound.
pub fn counter_of(
    first: Option<&Statement>,
    condition: Option<&Expression>,
    step: Option<&Statement>,
    body: &Block,
) -> Option<u32> {
    let Some(Statement::Local(local)) = first else { return None };
    let number = local.span.start;
    let is_natural = match &local.value.as_ref()?.bare().kind {
        ExpressionKind::Number(value) => match value.value {
            NumberValue::Integer(value) => value >= 0,
            NumberValue::Float(_) => false,
        },
        _ => false,
    };
    let is_it = |value: &Expression| value.bare().kind_is_local(number);
    let is_bounded = match &condition?.bare().kind {
        ExpressionKind::Binary { operator: Binary::Less, left, .. } => is_it(left),
        _ => false,
    };
    let is_stepped = matches!(step, Some(Statement::Step { target, is_up: true }) if is_it(target));
    let mut is_changed = false;
    targets(body, &mut |target| {
        target.walk(&mut |part| is_changed |= part.kind_is_local(number));
    });
    super::visit::block_expressions(body, &mut |value| {
        if let ExpressionKind::Unary(Unary::Address, inner) = &value.kind {
            is_changed |= is_it(inner);
        }
    });
    let is_signed = local.ty == Some(Type::I32);
    (is_natural && is_bounded && is_stepped && !is_changed && is_signed).then_some(number)
}

impl Expression {
    /// Whether it is a local by itself.
    pub fn kind_is_local(&self, number: u32) -> bool {
        matches!(&self.kind, ExpressionKind::Name(_, Meaning::Local(found)) if found.contains(&number))
    }
}

/// Whether a statement names a local that a body declares.
pub fn uses_locals(statement: &Statement, body: &Block) -> bool {
    let mut declared = Vec::new();
    statements(body, &mut |one| {
        if let Statement::Local(local) = one {
            declared.push(local.span.start);
        }
    });
    let mut found = false;
    for value in own_expressions(statement) {
        value.walk(&mut |part| {
            found |= declared.iter().any(|number| part.kind_is_local(*number));
        });
    }
    found
}

/// Whether a body has a `continue` of its own.
pub fn continues(body: &Block) -> bool {
    let mut found = false;
    for node in &body.nodes {
        found |= continues_itself(&node.body);
    }
    found
}

fn continues_itself(statement: &Statement) -> bool {
    match statement {
        Statement::Continue => true,
        Statement::For { .. } | Statement::While { .. } | Statement::Loop { .. } => false,
        Statement::If { accept, reject, condition: _ } => {
            continues(accept) || reject.as_ref().is_some_and(|node| continues_itself(&node.body))
        }
        Statement::Block(block) | Statement::Group(block) => continues(block),
        Statement::Switch { cases, .. } => cases.iter().any(|node| continues(&node.body.body)),
        _ => false,
    }
}
