//! Types in statements.

use lamplight_diagnostic::{Diagnostic, Diagnostics};

use super::constant::{convert, default_type};
use super::global::Globals;
use super::scope::Scope;
use crate::condition::Condition;
use crate::tree::{Block, Function, Item, Local, Module, Node, Statement, Type, whole_conditions};
use crate::wesl::untranslated;

/// Types everything in a module.
pub fn check_module(globals: &Globals, module: &mut Module, errors: &mut Diagnostics) {
    let conditions = whole_conditions(&module.items);
    let path = module.path.clone();
    for (node, condition) in module.items.iter_mut().zip(conditions) {
        let mut scope = Scope::new(globals, &path);
        scope.condition = condition;
        let found = match &mut node.body {
            Item::Function(function) => check_function(&mut scope, function),
            Item::Constant(constant) => {
                let ty = constant.given.clone();
                scope.expression(&mut constant.value).and_then(|()| {
                    let ty = ty.unwrap_or_else(|| default_type(&constant.value.ty));
                    constant.given = Some(ty.clone());
                    scope.fit(&mut constant.value, &ty)
                })
            }
            Item::Variable(variable) => match &mut variable.value {
                None => Ok(()),
                Some(value) if variable.ty == Type::Unknown => {
                    let found = scope.sized(value);
                    variable.ty = value.ty.clone();
                    found
                }
                Some(value) => scope.expected(value, &variable.ty),
            },
            Item::Structure(_) | Item::Alias(..) | Item::Assertion(_) => Ok(()),
        };
        errors.extend(found.err());
    }
}

fn check_function(scope: &mut Scope<'_>, function: &mut Function) -> Result<(), Diagnostic> {
    scope.enter();
    for value in &mut function.workgroup {
        scope.sized(value)?;
    }
    let outer = scope.condition.clone();
    let conditions = whole_conditions(&function.parameters);
    for (node, condition) in function.parameters.iter().zip(conditions) {
        scope.condition = outer.clone().and(condition);
        scope.declare(&node.body.name, node.body.ty.clone(), node.body.span);
    }
    scope.condition = outer;
    let result = function.result.as_ref().map_or(Type::Nothing, |field| field.ty.clone());
    check_nodes(scope, &mut function.body.nodes, &result)?;
    scope.leave();
    Ok(())
}

fn check_block(scope: &mut Scope<'_>, block: &mut Block, result: &Type) -> Result<(), Diagnostic> {
    scope.enter();
    check_nodes(scope, &mut block.nodes, result)?;
    scope.leave();
    Ok(())
}

/// Statements in the scope that is open.
fn check_nodes(
    scope: &mut Scope<'_>,
    nodes: &mut [Node<Statement>],
    result: &Type,
) -> Result<(), Diagnostic> {
    let conditions: Vec<Condition> = whole_conditions(nodes);
    let outer = scope.condition.clone();
    for (node, condition) in nodes.iter_mut().zip(conditions) {
        scope.condition = outer.clone().and(condition);
        let found = check_statement(scope, &mut node.body, result);
        // Which of several declarations is meant has no answer where nothing is reached.
        let is_reached = || !scope.condition.excludes(&scope.condition);
        found.map_err(|error| match is_reached() {
            true => error,
            false => untranslated(node.span, "a statement whose conditions contradict each other"),
        })?;
    }
    scope.condition = outer;
    Ok(())
}

fn check_statement(
    scope: &mut Scope<'_>,
    statement: &mut Statement,
    result: &Type,
) -> Result<(), Diagnostic> {
    match statement {
        Statement::Local(local) => check_local(scope, local),
        Statement::Assign { target, operator, value } => {
            scope.sized(target)?;
            scope.expression(value)?;
            let (span, ty) = (target.span, target.ty.clone());
            match operator {
                None => scope.fit(value, &ty),
                Some(operator) => scope.binary(*operator, target, value, span).map(drop),
            }
        }
        Statement::Step { target, is_up: _ } => scope.sized(target),
        Statement::Call(value) => scope.sized(value),
        Statement::Return(value) => match value {
            Some(value) => scope.expected(value, result),
            None => Ok(()),
        },
        Statement::If { condition, accept, reject } => {
            scope.expected(condition, &Type::BOOL)?;
            check_block(scope, accept, result)?;
            match reject {
                Some(node) => check_statement(scope, &mut node.body, result),
                None => Ok(()),
            }
        }
        Statement::Block(block) => check_block(scope, block, result),
        Statement::Group(block) => check_nodes(scope, &mut block.nodes, result),
        Statement::For { .. } | Statement::While { .. } | Statement::Loop { .. } => {
            scope.enter();
            check_loop(scope, statement, result)?;
            scope.leave();
            Ok(())
        }
        Statement::Switch { selector, cases, end: _ } => {
            check_switch(scope, selector, cases, result)
        }
        Statement::Break
        | Statement::Continue
        | Statement::Discard
        | Statement::Assertion(_)
        | Statement::Empty => Ok(()),
    }
}

fn check_local(scope: &mut Scope<'_>, local: &mut Local) -> Result<(), Diagnostic> {
    if let Some(ty) = &mut local.ty {
        scope.globals.resolve(scope.module, ty, local.span, 0)?;
    }
    match (&local.ty, &mut local.value) {
        (Some(ty), Some(value)) => scope.expected(value, ty)?,
        (None, Some(value)) => {
            scope.expression(value)?;
            let ty = default_type(&value.ty);
            convert(value, &ty, scope.globals)?;
            local.ty = Some(ty);
        }
        _ => {}
    }
    let ty = local.ty.clone().unwrap_or(Type::Unknown);
    scope.declare(&local.name, ty, local.span);
    Ok(())
}

fn check_loop(
    scope: &mut Scope<'_>,
    statement: &mut Statement,
    result: &Type,
) -> Result<(), Diagnostic> {
    match statement {
        Statement::For { first, condition, step, body } => {
            if let Some(first) = first {
                check_statement(scope, first, result)?;
            }
            if let Some(condition) = condition {
                scope.expected(condition, &Type::BOOL)?;
            }
            if let Some(step) = step {
                check_statement(scope, step, result)?;
            }
            check_block(scope, body, result)
        }
        Statement::While { condition, body } => {
            scope.expected(condition, &Type::BOOL)?;
            check_block(scope, body, result)
        }
        Statement::Loop { body, continuing, break_if } => {
            // What the body declares is in scope in the `continuing` block, and what that declares
            // in its last condition.
            scope.enter();
            check_nodes(scope, &mut body.nodes, result)?;
            if let Some(continuing) = continuing {
                check_nodes(scope, &mut continuing.nodes, result)?;
            }
            if let Some(condition) = break_if {
                scope.expected(condition, &Type::BOOL)?;
            }
            scope.leave();
            Ok(())
        }
        _ => Ok(()),
    }
}

fn check_switch(
    scope: &mut Scope<'_>,
    selector: &mut crate::tree::Expression,
    cases: &mut [Node<crate::tree::Case>],
    result: &Type,
) -> Result<(), Diagnostic> {
    scope.expression(selector)?;
    // A selector without a size gets that of the cases.
    let mut ty = default_type(&selector.ty);
    if selector.ty.is_abstract() {
        for selector in cases.iter_mut().flat_map(|node| &mut node.body.selectors) {
            scope.expression(selector)?;
            if !selector.ty.is_abstract() {
                ty = selector.ty.clone();
            }
        }
    }
    scope.fit(selector, &ty)?;
    let conditions = whole_conditions(cases);
    let outer = scope.condition.clone();
    for (node, condition) in cases.iter_mut().zip(conditions) {
        scope.condition = outer.clone().and(condition);
        for selector in &mut node.body.selectors {
            scope.expected(selector, &ty)?;
        }
        check_block(scope, &mut node.body.body, result)?;
    }
    scope.condition = outer;
    Ok(())
}
