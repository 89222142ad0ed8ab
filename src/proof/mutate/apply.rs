//! Puts a mistake into a function.

use naga::{Block, Expression, Function, Handle, Range, Statement, TypeInner};

use super::site::{Edit, Site, same};

/// Changes the function; `false` where the site is not in it.
pub fn apply(
    function: &mut Function,
    site: &Site,
    inner: impl Fn(Handle<Expression>) -> Option<TypeInner>,
) -> bool {
    match &site.edit {
        Edit::Expression { at, with, .. } => replace(function, *at, with.clone()),
        Edit::Negated { statement, .. } => change(&mut function.body, *statement, &mut |found| {
            if let Statement::If { accept, reject, .. } = found {
                std::mem::swap(accept, reject);
            }
        }),
        Edit::NoExit { statement, .. } => change(&mut function.body, *statement, &mut |found| {
            if let Statement::If { reject, .. } = found {
                *found = Statement::Block(std::mem::take(reject));
            }
        }),
        Edit::NoStore { statement } => change(&mut function.body, *statement, &mut |found| {
            *found = Statement::Block(Block::new())
        }),
        Edit::Argument { statement, result, argument } => {
            let Some(with) = inner(*argument).and_then(|inner| same(&inner, *argument)) else {
                return false;
            };
            let emit = Statement::Emit(Range::new_from_bounds(*result, *result));
            replace(function, *result, with)
                && change(&mut function.body, *statement, &mut |found| *found = emit.clone())
        }
    }
}

fn replace(function: &mut Function, at: Handle<Expression>, with: Expression) -> bool {
    let there = at.index() < function.expressions.len();
    if there {
        function.expressions[at] = with;
    }
    there
}

/// Changes the statement of that number, in the order of the text.
fn change(block: &mut Block, wanted: usize, edit: &mut dyn FnMut(&mut Statement)) -> bool {
    let mut left = wanted;
    walk(block, &mut left, edit)
}

fn walk(block: &mut Block, left: &mut usize, edit: &mut dyn FnMut(&mut Statement)) -> bool {
    for statement in block.iter_mut() {
        if *left == 0 {
            edit(statement);
            return true;
        }
        *left -= 1;
        let found = match statement {
            Statement::Block(block) => walk(block, left, edit),
            Statement::If { accept, reject, .. } => {
                walk(accept, left, edit) || walk(reject, left, edit)
            }
            Statement::Switch { cases, .. } => {
                cases.iter_mut().any(|case| walk(&mut case.body, left, edit))
            }
            Statement::Loop { body, continuing, .. } => {
                walk(body, left, edit) || walk(continuing, left, edit)
            }
            _ => false,
        };
        if found {
            return true;
        }
    }
    false
}
