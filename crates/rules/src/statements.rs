//! Walks over statements, and `continue` past a declaration that `continuing` needs.

use std::collections::BTreeSet;

use super::constants::{Constants, check_untyped};
use super::names::Module;
use super::syntax::{
    Block, Declaration, DeclarationKind, ExprId, ExprKind, LocalId, Statement, StatementKind, Tree,
};
use super::{Place, Problem, Rule};

/// The blocks right within a statement.
pub fn inner_blocks<'b, 't>(statement: &'b Statement<'t>) -> Vec<&'b Block<'t>> {
    match &statement.kind {
        StatementKind::Block(block) => vec![block],
        StatementKind::If { condition: _, accept, reject } => {
            let reject = reject.iter().flat_map(|reject| inner_blocks(reject));
            std::iter::once(accept).chain(reject).collect()
        }
        StatementKind::Switch { selector: _, filters: _, values: _, clauses } => {
            clauses.iter().collect()
        }
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

/// Loops with a `continue` past a declaration that their `continuing` block uses, variables whose values
/// do not fit, and cases whose values are not constant.
pub fn check(module: &Module<'_, '_>) -> Vec<Problem> {
    let constants = Constants::of(module);
    let own = module.tree.declarations.iter();
    let mut problems: Vec<Problem> = own.filter_map(|own| check_type(&constants, own)).collect();
    for function in &module.tree.functions {
        check_block(&constants, &function.body, &mut problems);
    }
    problems
}

/// The value of something that gets its type from it.
fn check_type(constants: &Constants<'_, '_, '_>, own: &Declaration<'_>) -> Option<Problem> {
    let gets_type = own.kind != DeclarationKind::Const && own.of_type.is_none();
    own.value.filter(|_| gets_type).and_then(|value| check_untyped(constants, value))
}

fn check_block(constants: &Constants<'_, '_, '_>, block: &Block<'_>, problems: &mut Vec<Problem>) {
    let tree = constants.module.tree;
    for statement in &block.statements {
        if let StatementKind::Loop { body, continuing: Some(continuing) } = &statement.kind {
            problems.extend(passed_declaration(tree, body, continuing));
        }
        if let StatementKind::Switch { selector: _, filters: _, values, clauses: _ } =
            &statement.kind
        {
            problems.extend(values.iter().filter_map(|value| computed_case(tree, *value)));
        }
        if let StatementKind::Declare(_, own) = &statement.kind {
            problems.extend(check_type(constants, own));
        }
        inner_blocks(statement)
            .into_iter()
            .for_each(|inner| check_block(constants, inner, problems));
    }
}

/// A case whose value names something that has its value only as the shader runs. naga takes a `let` for
/// a constant.
fn computed_case(tree: &Tree<'_>, value: ExprId) -> Option<Problem> {
    tree.within(tree.place(value)).find_map(|one| {
        let ExprKind::Name { name, template: _, local: Some(local) } = &one.kind else {
            return None;
        };
        let message = format!("`{name}` is no constant, and the value of a `case` has to be one");
        let is_computed = tree.locals[*local as usize].constant.is_none();
        is_computed.then(|| Problem::new(Rule::Constant, one.place, message))
    })
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
