//! Atomics that are read or assigned as other variables are, by themselves or in a whole array or
//! structure.

use super::memory::has_atomic;
use super::names::Module;
use super::syntax::{ExprId, ExprKind, Tree};
use super::{Problem, Rule};

/// How deep the expressions go whose type is looked for.
const DEEPEST: usize = 64;

pub fn check(tree: &Tree<'_>, module: &Module<'_, '_>) -> Vec<Problem> {
    let has_any = |kind: &ExprKind<'_>| matches!(kind, ExprKind::Name { name: "atomic", .. });
    if !tree.expressions.iter().any(|expression| has_any(&expression.kind)) {
        return Vec::new();
    }
    let places = only_places(tree);
    let mut problems = Vec::new();
    for (id, expression) in tree.expressions.iter().enumerate() {
        let is_value = !places[id] && tree.enclosing(expression.place).is_some();
        let of_type = is_value.then(|| type_at(module, id as ExprId, 0)).flatten();
        if of_type.is_some_and(|of_type| has_atomic(module, of_type, 0)) {
            let message = "only atomic functions read and write atomics".to_owned();
            problems.push(Problem::new(Rule::Memory, expression.place, message));
        }
    }
    problems
}

/// By expression, whether it only says where something is: a part of it is taken, or its address.
fn only_places(tree: &Tree<'_>) -> Vec<bool> {
    let mut places = vec![false; tree.expressions.len()];
    for expression in &tree.expressions {
        match &expression.kind {
            ExprKind::Member { base, name: _ } | ExprKind::Index { base, index: _ } => {
                places[*base as usize] = true;
            }
            ExprKind::AddressOf(operand) => places[*operand as usize] = true,
            // What is within brackets is reported at the brackets.
            ExprKind::Parenthesized(inner) => places[*inner as usize] = true,
            ExprKind::Literal(_)
            | ExprKind::Name { .. }
            | ExprKind::Call { .. }
            | ExprKind::Unary { .. }
            | ExprKind::Indirection(_)
            | ExprKind::Binary { .. } => {}
        }
    }
    places
}

/// The type of memory that an expression names, where declarations say it.
fn type_at(module: &Module<'_, '_>, id: ExprId, depth: usize) -> Option<ExprId> {
    if depth > DEEPEST {
        return None;
    }
    let behind = |base: ExprId| {
        let of_type = type_at(module, base, depth + 1)?;
        match module.type_of(of_type)? {
            ("ptr", template) => template.get(1).copied(),
            _ => Some(of_type),
        }
    };
    match module.tree.kind(id) {
        ExprKind::Name { name: _, template, local: _ } if template.is_empty() => {
            module.declared_type(id)
        }
        ExprKind::Parenthesized(inner) => type_at(module, *inner, depth + 1),
        ExprKind::Indirection(operand) => behind(*operand),
        ExprKind::Index { base, index: _ } => match module.type_of(behind(*base)?)? {
            ("array", template) => template.first().copied(),
            _ => None,
        },
        ExprKind::Member { base, name } => {
            let structure = module.structure(behind(*base)?)?;
            let mut members = module.tree.structs[structure].members.iter();
            members.find(|member| member.name == *name).map(|member| member.of_type)
        }
        ExprKind::Name { .. }
        | ExprKind::Literal(_)
        | ExprKind::Call { .. }
        | ExprKind::Unary { .. }
        | ExprKind::AddressOf(_)
        | ExprKind::Binary { .. } => None,
    }
}
