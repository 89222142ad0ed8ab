//! Names of locals that GLSL would take for something else.

use std::collections::BTreeMap;

use super::expression::LocalRole;
use super::words::glsl_name;
use crate::tree::{Block, Function, Local, Node, Statement};

/// The names of parameters and locals, by where they are declared. The body of a loop is not a scope
/// beside that of the loop's variable in GLSL.
pub fn local_names(function: &Function) -> BTreeMap<u32, LocalRole> {
    let mut names = BTreeMap::new();
    for node in &function.parameters {
        let name = glsl_name(&node.body.name);
        names.insert(node.body.span.start, LocalRole::Named(name));
    }
    block_names(&function.body, None, &mut names);
    names
}

fn block_names(block: &Block, taken: Option<&str>, names: &mut BTreeMap<u32, LocalRole>) {
    block.nodes.iter().for_each(|node| statement_names(&node.body, taken, names));
}

fn statement_names(
    statement: &Statement,
    taken: Option<&str>,
    names: &mut BTreeMap<u32, LocalRole>,
) {
    match statement {
        Statement::Local(local) => declare(local, taken, names),
        Statement::If { accept, reject, condition: _ } => {
            block_names(accept, None, names);
            if let Some(Node { body, .. }) = reject.as_deref() {
                statement_names(body, None, names);
            }
        }
        Statement::Group(block) => block_names(block, taken, names),
        Statement::Block(block) | Statement::While { body: block, condition: _ } => {
            block_names(block, None, names);
        }
        Statement::For { first, body, .. } => {
            if let Some(Statement::Local(local)) = first.as_deref() {
                declare(local, None, names);
                block_names(body, Some(&local.name), names);
            } else {
                block_names(body, None, names);
            }
        }
        Statement::Loop { body, continuing, break_if: _ } => {
            block_names(body, None, names);
            if let Some(continuing) = continuing {
                block_names(continuing, None, names);
            }
        }
        Statement::Switch { cases, .. } => {
            cases.iter().for_each(|node| block_names(&node.body.body, None, names));
        }
        _ => {}
    }
}

fn declare(local: &Local, taken: Option<&str>, names: &mut BTreeMap<u32, LocalRole>) {
    let mut name = glsl_name(&local.name);
    if taken == Some(local.name.as_str()) {
        name = format!("{}_inner", name.trim_end_matches('_'));
    }
    names.insert(local.span.start, LocalRole::Named(name));
}
