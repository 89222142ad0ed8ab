//! Walks over statements, and `continue` past a declaration that `continuing` needs.

use std::collections::BTreeSet;

use super::constants::check_untyped;
use super::syntax::{Block, DeclarationKind, ExprKind, LocalId, Statement, StatementKind, Tree};
use super::{Place, Problem, Rule};

/// The blocks right within a statement.
pub fn inner_blocks<'b, 't>(statement: &'b Statement<'t>) -> Vec<&'b Block<'t>> {
    match &statement.kind {
        StatementKind::Block(block) => vec![block],
        StatementKind::If { condition: _, accept, reject } => {
            let reject = reject.iter().flat_map(|reject| inner_blocks(reject));
            std::iter::once(accept).chain(reject).collect()
        }
        StatementKind::Switch { selector: _, filters: _, clauses } => clauses.iter().collect(),
        StatementKind::Loop { body, continuing } => {
            std::iter::once(body).chain(continuing).collect()
        }
        StatementKind::For(parts) => vec![&parts.body],
        StatementKind::While { condition: _, body } => vec![body],
        StatementKind::Empty
        | StatementKind::Declare(..)
        | StatementKind::Assign { .. }
        | StatementKind::Count { .. }
        | StatementKind::Call(_)
        | StatementKind::Return(_)
        | StatementKind::Break
        | StatementKind::BreakIf(_)
        | StatementKind::Continue
        | StatementKind::Discard
        | StatementKind::Assert => Vec::new(),
    }
}

/// Loops with a `continue` past a declaration that their `continuing` block uses, and variables
/// whose values do not fit.
pub fn check(tree: &Tree<'_>) -> Vec<Problem> {
    let mut problems = Vec::new();
    for function in &tree.functions {
        check_block(tree, &function.body, &mut problems);
    }
    problems
}

fn check_block(tree: &Tree<'_>, block: &Block<'_>, problems: &mut Vec<Problem>) {
    for statement in &block.statements {
        if let StatementKind::Loop { body, continuing: Some(continuing) } = &statement.kind {
            problems.extend(passed_declaration(tree, body, continuing));
        }
        if let StatementKind::Declare(_, own) = &statement.kind
            && own.kind != DeclarationKind::Const
            && own.of_type.is_none()
        {
            problems.extend(own.value.and_then(|value| check_untyped(tree, value)));
        }
        inner_blocks(statement).into_iter().for_each(|inner| check_block(tree, inner, problems));
    }
}

fn passed_declaration(
    tree: &Tree<'_>,
    body: &Block<'_>,
    continuing: &Block<'_>,
) -> Option<Problem> {
    let from = body.statements.iter().find_map(first_continue)?;
    let mut passed = body.statements.iter().filter_map(|statement| match &statement.kind {
        StatementKind::Declare(id, own)
            if own.kind != DeclarationKind::Const && own.place.start > from.start =>
        {
            Some((*id, own))
        }
        _ => None,
    });
    let used: BTreeSet<LocalId> = tree
        .within(continuing.place)
        .filter_map(|one| match &one.kind {
            ExprKind::Name { name: _, template: _, local } => *local,
            _ => None,
        })
        .collect();
    let (_, found) = passed.find(|(id, _)| used.contains(id))?;
    let message = format!("this `continue` passes the declaration of `{}`", found.name);
    let mut problem = Problem::new(Rule::Behaviour, from, message);
    problem.notes.push((found.place, "`continuing` uses this".to_owned()));
    Some(problem)
}

/// The first `continue` of the loop that a statement is in.
fn first_continue(statement: &Statement<'_>) -> Option<Place> {
    match statement.kind {
        StatementKind::Continue => Some(statement.place),
        StatementKind::Loop { .. } | StatementKind::For(_) | StatementKind::While { .. } => None,
        _ => inner_blocks(statement)
            .into_iter()
            .flat_map(|block| &block.statements)
            .find_map(first_continue),
    }
}
