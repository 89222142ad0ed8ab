//! Puts a mistake into a function.

use naga::{Block, Expression, Function, Handle, Range, Statement, TypeInner};

use super::site::{Mutation, Site, equal_value};
use lamplight_emit::blocks::inner_blocks_mut;

/// Puts the mistake into the function; `false` if the function does not have its site.
pub fn apply_mutation(
    function: &mut Function,
    site: &Site,
    inner: impl Fn(Handle<Expression>) -> Option<TypeInner>,
) -> bool {
    match &site.edit {
        Mutation::Expression { at, with, .. } => replace_expression(function, *at, with.clone()),
        Mutation::Negated { statement, .. } => {
            change_statement(&mut function.body, *statement, &mut |found| {
                if let Statement::If { accept, reject, .. } = found {
                    std::mem::swap(accept, reject);
                }
            })
        }
        Mutation::NoExit { statement, .. } => {
            change_statement(&mut function.body, *statement, &mut |found| {
                if let Statement::If { reject, .. } = found {
                    *found = Statement::Block(std::mem::take(reject));
                }
            })
        }
        Mutation::Decided { statement, holds, .. } => {
            change_statement(&mut function.body, *statement, &mut |found| {
                keep_branch(found, *holds)
            })
        }
        Mutation::Exchanged { statement, first, .. } => {
            change_statement(&mut function.body, *statement, &mut |found| {
                if let Statement::Call { arguments, .. } = found {
                    arguments.swap(*first, *first + 1);
                }
            })
        }
        Mutation::NoStore { statement } => {
            change_statement(&mut function.body, *statement, &mut remove_statement)
        }
        Mutation::Argument { statement, result, argument } => {
            let Some(with) = inner(*argument).and_then(|inner| equal_value(&inner, *argument))
            else {
                return false;
            };
            let emit = Statement::Emit(Range::new_from_bounds(*result, *result));
            replace_expression(function, *result, with)
                && change_statement(&mut function.body, *statement, &mut |found| {
                    *found = emit.clone()
                })
        }
    }
}

fn remove_statement(found: &mut Statement) {
    *found = Statement::Block(Block::new());
}

/// Only one branch of an `if` remains.
fn keep_branch(found: &mut Statement, holds: bool) {
    if let Statement::If { accept, reject, .. } = found {
        let kept = if holds { accept } else { reject };
        *found = Statement::Block(std::mem::take(kept));
    }
}

fn replace_expression(function: &mut Function, at: Handle<Expression>, with: Expression) -> bool {
    let there = at.index() < function.expressions.len();
    if there {
        function.expressions[at] = with;
    }
    there
}

/// Applies `edit` to the statement of the number `wanted`, in the order of the text; `false` if
/// there is none.
fn change_statement(
    block: &mut Block,
    wanted: usize,
    edit: &mut dyn FnMut(&mut Statement),
) -> bool {
    let mut left = wanted;
    walk_statements(block, &mut left, edit)
}

fn walk_statements(
    block: &mut Block,
    left: &mut usize,
    edit: &mut dyn FnMut(&mut Statement),
) -> bool {
    for statement in block.iter_mut() {
        if *left == 0 {
            edit(statement);
            return true;
        }
        *left -= 1;
        if inner_blocks_mut(statement).into_iter().any(|inner| walk_statements(inner, left, edit)) {
            return true;
        }
    }
    false
}
