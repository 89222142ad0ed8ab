//! Walks over what is in items.

use crate::tree::{Block, Callee, Expression, ExpressionKind, Item, Local, Statement, Type};

/// Calls `visit` with every statement of a block, each before what is in it.
pub fn statements<'a>(block: &'a Block, visit: &mut dyn FnMut(&'a Statement)) {
    block.nodes.iter().for_each(|node| within_statement(&node.body, visit));
}

/// The same with a statement and what is in it.
pub fn within_statement<'a>(one: &'a Statement, visit: &mut dyn FnMut(&'a Statement)) {
    visit(one);
    match one {
        Statement::If { accept, reject, condition: _ } => {
            statements(accept, visit);
            if let Some(node) = reject {
                within_statement(&node.body, visit);
            }
        }
        Statement::Block(block)
        | Statement::Group(block)
        | Statement::While { body: block, condition: _ } => statements(block, visit),
        Statement::For { first, condition: _, step, body } => {
            for part in [first, step].into_iter().flatten() {
                within_statement(part, visit);
            }
            statements(body, visit);
        }
        Statement::Loop { body, continuing, break_if: _ } => {
            statements(body, visit);
            if let Some(continuing) = continuing {
                statements(continuing, visit);
            }
        }
        Statement::Switch { selector: _, cases, end: _ } => {
            cases.iter().for_each(|node| statements(&node.body.body, visit));
        }
        _ => {}
    }
}

/// The expressions of one statement, without those of statements in it.
pub fn own_expressions(one: &Statement) -> Vec<&Expression> {
    match one {
        Statement::Local(local) => local.value.iter().collect(),
        Statement::Assign { target, operator: _, value } => vec![target, value],
        Statement::Step { target, is_up: _ } => vec![target],
        Statement::Call(value) => vec![value],
        Statement::Return(value) => value.iter().collect(),
        Statement::If { condition, .. } | Statement::While { condition, .. } => vec![condition],
        Statement::For { condition, .. } => condition.iter().collect(),
        Statement::Loop { break_if, .. } => break_if.iter().collect(),
        Statement::Switch { selector, cases, end: _ } => {
            let cases = cases.iter().flat_map(|node| &node.body.selectors);
            std::iter::once(selector).chain(cases).collect()
        }
        _ => Vec::new(),
    }
}

/// Calls `visit` with every expression of a block, and every part of one.
pub fn block_expressions(block: &Block, visit: &mut dyn FnMut(&Expression)) {
    statements(block, &mut |one| {
        own_expressions(one).into_iter().for_each(|value| value.walk(visit));
    });
}

/// Calls `visit` with everything that is assigned to.
pub fn targets(block: &Block, visit: &mut dyn FnMut(&Expression)) {
    statements(block, &mut |one| match one {
        Statement::Assign { target, .. } | Statement::Step { target, .. } => visit(target),
        _ => {}
    });
}

/// Whether a block ends the invocation somewhere.
pub fn discards(block: &Block) -> bool {
    let mut found = false;
    statements(block, &mut |one| found |= matches!(one, Statement::Discard));
    found
}

/// Calls `visit` with the locals of an item.
pub fn item_locals(item: &Item, visit: &mut dyn FnMut(&Local)) {
    if let Item::Function(function) = item {
        statements(&function.body, &mut |one| {
            if let Statement::Local(local) = one {
                visit(local);
            }
        });
    }
}

/// Calls `visit` with every type that an item names, and what is in it.
pub fn item_types(item: &Item, visit: &mut dyn FnMut(&Type)) {
    match item {
        Item::Function(function) => {
            function.parameters.iter().for_each(|node| within(&node.body.ty, visit));
            function.result.iter().for_each(|field| within(&field.ty, visit));
            item_locals(item, &mut |local| {
                local.ty.iter().for_each(|ty| within(ty, visit));
            });
            block_expressions(&function.body, &mut |value| {
                if let ExpressionKind::Call { callee: Callee::Construct(ty), .. } = &value.kind {
                    within(ty, visit);
                }
            });
        }
        Item::Structure(structure) => {
            structure.members.iter().for_each(|node| within(&node.body.ty, visit));
        }
        Item::Constant(constant) => {
            constant.given.iter().for_each(|ty| within(ty, visit));
        }
        Item::Variable(variable) => within(&variable.ty, visit),
        Item::Alias(..) | Item::Assertion(_) => {}
    }
}

/// Calls `visit` with a type and what it is made of.
pub fn within(ty: &Type, visit: &mut dyn FnMut(&Type)) {
    visit(ty);
    match ty {
        Type::Array(inner, _) | Type::Pointer(_, inner) => within(inner, visit),
        _ => {}
    }
}
