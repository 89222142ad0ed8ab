//! Names that are macros: those of the axes and of their values.

use std::collections::BTreeMap;

use lamplight_diagnostic::source::Span;
use lamplight_diagnostic::{Diagnostic, Diagnostics};

use super::visit::{block_expressions, item_locals, statements};
use super::words::macro_name;
use crate::condition::{AxisValue, Condition};
use crate::tree::{Branch, Count, ExpressionKind, Item, Module, Node, Statement, Type};
use crate::wesl::untranslated;

/// The names that are macros.
pub fn macros_of(modules: &[Module]) -> Macros {
    let mut macros = BTreeMap::new();
    for module in modules {
        for import in &module.imports {
            import.condition.iter().for_each(|condition| add(condition, &mut macros));
        }
        branches(&module.items, &mut macros);
        for node in &module.items {
            item_macros(&node.body, &mut macros);
        }
    }
    macros
}

/// The errors for declarations whose names the preprocessor would replace.
pub fn check_names(modules: &[Module], macros: &Macros) -> Diagnostics {
    let mut errors = Vec::new();
    for module in modules {
        for node in &module.items {
            let mut check = |name: &str, span: Span| {
                errors.extend(macros.get(name).map(|axis| collision(name, axis, span)));
            };
            check(node.body.name(), node.span);
            if let Item::Function(function) = &node.body {
                function.parameters.iter().for_each(|one| check(&one.body.name, one.body.span));
            }
            if let Item::Structure(structure) = &node.body {
                structure.members.iter().for_each(|one| check(&one.body.name, one.body.span));
            }
            item_locals(&node.body, &mut |local| check(&local.name, local.span));
        }
    }
    errors
}

fn collision(name: &str, axis: &str, span: Span) -> Diagnostic {
    untranslated(span, format!("the name `{name}`, which is a macro of the axis `{axis}`"))
        .note("help: give it another name: GLSL would put the value of the axis there")
}

/// By macro, the axis that it belongs to.
pub type Macros = BTreeMap<String, String>;

fn add(condition: &Condition, macros: &mut Macros) {
    match condition {
        Condition::Literal(_) => {}
        Condition::Flag(axis) => drop(macros.insert(macro_name(axis), axis.clone())),
        Condition::Compare { axis, value, operator: _ } => {
            macros.insert(macro_name(axis), axis.clone());
            if let AxisValue::Name(value) = value {
                let name = format!("{}_{}", macro_name(axis), macro_name(value));
                macros.insert(name, axis.clone());
            }
        }
        Condition::Not(inner) => add(inner, macros),
        Condition::All(parts) | Condition::Any(parts) => {
            parts.iter().for_each(|one| add(one, macros));
        }
    }
}

fn branches<T>(nodes: &[Node<T>], macros: &mut Macros) {
    for node in nodes {
        if let Some(Branch::If(condition) | Branch::Elif(condition)) = &node.branch {
            add(condition, macros);
        }
    }
}

fn item_macros(item: &Item, macros: &mut Macros) {
    super::visit::item_types(item, &mut |ty| {
        if let Type::Array(_, Count::Axis(axis)) = ty {
            macros.insert(macro_name(axis), axis.clone());
        }
    });
    match item {
        Item::Structure(structure) => branches(&structure.members, macros),
        Item::Function(function) => {
            branches(&function.parameters, macros);
            branches(&function.body.nodes, macros);
            statements(&function.body, &mut |one| statement_branches(one, macros));
            block_expressions(&function.body, &mut |value| {
                if let ExpressionKind::Axis(axis) = &value.kind {
                    macros.insert(macro_name(axis), axis.clone());
                }
            });
        }
        Item::Constant(constant) => constant.value.walk(&mut |value| {
            if let ExpressionKind::Axis(axis) = &value.kind {
                macros.insert(macro_name(axis), axis.clone());
            }
        }),
        _ => {}
    }
}

fn statement_branches(statement: &Statement, macros: &mut Macros) {
    match statement {
        Statement::If { accept, .. } => branches(&accept.nodes, macros),
        Statement::Block(block)
        | Statement::Group(block)
        | Statement::For { body: block, .. }
        | Statement::While { body: block, .. } => branches(&block.nodes, macros),
        Statement::Loop { body, continuing, break_if: _ } => {
            branches(&body.nodes, macros);
            continuing.iter().for_each(|block| branches(&block.nodes, macros));
        }
        Statement::Switch { cases, .. } => {
            branches(cases, macros);
            cases.iter().for_each(|node| branches(&node.body.body.nodes, macros));
        }
        _ => {}
    }
}
