//! What items use, and under which conditions.

use crate::condition::Condition;
use crate::tree::{Block, Callee, Count, Expression, ExpressionKind, Field, Item, ItemPath};
use crate::tree::{Meaning, Node, Statement, Type, whole_conditions};

/// Calls `visit` with each item that an item uses, under a condition within it.
pub fn item_uses(item: &Item, visit: &mut dyn FnMut(&ItemPath, &Condition)) {
    let always = Condition::Literal(true);
    match item {
        Item::Function(function) => {
            field_uses(&function.parameters, visit);
            if let Some(field) = &function.result {
                type_uses(&field.ty, &always, visit);
            }
            block_uses(&function.body, &always, visit);
        }
        Item::Structure(structure) => field_uses(&structure.members, visit),
        Item::Constant(constant) => {
            expression_uses(&constant.value, &always, visit);
            constant.given.iter().for_each(|ty| type_uses(ty, &always, visit));
        }
        Item::Variable(variable) => {
            type_uses(&variable.ty, &always, visit);
            variable.value.iter().for_each(|value| expression_uses(value, &always, visit));
        }
        Item::Alias(..) | Item::Assertion(_) => {}
    }
}

fn field_uses(nodes: &[Node<Field>], visit: &mut dyn FnMut(&ItemPath, &Condition)) {
    for (node, condition) in nodes.iter().zip(whole_conditions(nodes)) {
        type_uses(&node.body.ty, &condition, visit);
    }
}

fn type_uses(ty: &Type, condition: &Condition, visit: &mut dyn FnMut(&ItemPath, &Condition)) {
    super::visit::within(ty, &mut |ty| {
        if let Type::Structure(path) | Type::Array(_, Count::Constant(path)) = ty {
            visit(path, condition);
        }
    });
}

fn block_uses(block: &Block, outer: &Condition, visit: &mut dyn FnMut(&ItemPath, &Condition)) {
    for (node, condition) in block.nodes.iter().zip(whole_conditions(&block.nodes)) {
        let condition = outer.clone().and(condition);
        for value in super::visit::own_expressions(&node.body) {
            expression_uses(value, &condition, visit);
        }
        statement_uses(&node.body, &condition, visit);
    }
}

fn statement_uses(
    statement: &Statement,
    condition: &Condition,
    visit: &mut dyn FnMut(&ItemPath, &Condition),
) {
    match statement {
        Statement::Local(local) => {
            local.ty.iter().for_each(|ty| type_uses(ty, condition, visit));
        }
        Statement::If { accept, reject, condition: _ } => {
            block_uses(accept, condition, visit);
            if let Some(node) = reject {
                for value in super::visit::own_expressions(&node.body) {
                    expression_uses(value, condition, visit);
                }
                statement_uses(&node.body, condition, visit);
            }
        }
        Statement::Block(block)
        | Statement::Group(block)
        | Statement::While { body: block, condition: _ } => block_uses(block, condition, visit),
        Statement::For { first, condition: _, step, body } => {
            for part in [first, step].into_iter().flatten() {
                for value in super::visit::own_expressions(part) {
                    expression_uses(value, condition, visit);
                }
                statement_uses(part, condition, visit);
            }
            block_uses(body, condition, visit);
        }
        Statement::Loop { body, continuing, break_if: _ } => {
            block_uses(body, condition, visit);
            if let Some(block) = continuing {
                block_uses(block, condition, visit);
            }
        }
        Statement::Switch { cases, .. } => {
            for (node, own) in cases.iter().zip(whole_conditions(cases)) {
                block_uses(&node.body.body, &condition.clone().and(own), visit);
            }
        }
        _ => {}
    }
}

fn expression_uses(
    value: &Expression,
    condition: &Condition,
    visit: &mut dyn FnMut(&ItemPath, &Condition),
) {
    value.walk(&mut |part| match &part.kind {
        ExpressionKind::Name(_, Meaning::Item(path)) => visit(path, condition),
        ExpressionKind::Call { callee: Callee::Function(path), .. } => visit(path, condition),
        ExpressionKind::Call { callee: Callee::Construct(ty), .. } => {
            type_uses(ty, condition, visit);
        }
        _ => {}
    });
}
