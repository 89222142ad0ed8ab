//! The variable of a stage that is what it returns: its members are the outputs of the stage.

use lamplight_diagnostic::Diagnostic;

use super::expression::Writer;
use super::facts::StageField;
use super::lines::Indented;
use super::visit::{own_expressions, statements, within_statement};
use crate::condition::Condition;
use crate::tree::{Block, Expression, ExpressionKind, Field, Function, Meaning, Node};
use crate::tree::{Statement, kept_siblings, whole_conditions};
use crate::wesl::untranslated;

/// The variable, if a stage has one.
pub fn output_variable(function: &Function) -> Result<Option<u32>, Diagnostic> {
    let wanted = function.result.as_ref().map(|field| &field.ty);
    let mut found = Vec::new();
    statements(&function.body, &mut |one| {
        let Statement::Local(local) = one else { return };
        if local.ty.as_ref() == wanted {
            found.push(local);
        }
    });
    match found.as_slice() {
        [] => Ok(None),
        [one] if one.is_variable && one.value.is_none() => Ok(Some(one.span.start)),
        [one] => Err(untranslated(one.span, "a copy of what a stage takes or returns")),
        [_, second, ..] => {
            Err(untranslated(second.span, "a second variable of what a stage returns"))
        }
    }
}

/// Writes zeros to the outputs that the stage may leave as they are, or read before it writes them.
pub fn write_zeros(
    writer: &Writer<'_>,
    fields: &[StageField],
    unset: &[Node<Field>],
    out: &mut Indented,
) -> Result<(), Diagnostic> {
    for chain in super::condition::chains_of(unset) {
        super::item::write_chain(&chain, out, |node, out| {
            let field = fields.iter().find(|field| field.name == node.body.name);
            let zero = writer.zero(&node.body.ty, node.body.span)?;
            let variable = field.map_or("", |field| field.variable.as_str());
            out.line(&format!("{variable} = {zero};"));
            Ok(())
        })?;
    }
    Ok(())
}

/// The members that may be read or returned before they are written.
pub fn unset_members(body: &Block, number: u32, members: &[Node<Field>]) -> Vec<Node<Field>> {
    let conditions = whole_conditions(members);
    let is_unset = |node: &Node<Field>| {
        let at = members.iter().position(|one| std::ptr::eq(one, node)).unwrap_or_default();
        !is_set(body, number, &node.body.name, &conditions[at])
    };
    kept_siblings(members, is_unset)
}

/// Whether the statements of a function surely write a member before anything else needs it. Only
/// those outside of branches and loops count.
fn is_set(body: &Block, number: u32, member: &str, condition: &Condition) -> bool {
    let mut written = Vec::new();
    let mut is_declared = false;
    for (statement, own) in in_sequence(body, &Condition::Literal(true)) {
        if let Statement::Local(local) = statement
            && local.span.start == number
        {
            is_declared = true;
            continue;
        }
        if !is_declared {
            continue;
        }
        if let Statement::Assign { target, operator: None, value } = statement
            && is_member(target, number, member)
            && !reads(value, number, member)
        {
            written.push(own);
            if condition.implies(&Condition::any(written.clone())) {
                return true;
            }
        } else if needs(statement, number, member) {
            return false;
        }
    }
    false
}

/// The statements of a block in their order, and under which conditions each exists.
fn in_sequence<'a>(block: &'a Block, outer: &Condition) -> Vec<(&'a Statement, Condition)> {
    let mut found = Vec::new();
    for (node, own) in block.nodes.iter().zip(whole_conditions(&block.nodes)) {
        let condition = outer.clone().and(own);
        match &node.body {
            Statement::Group(inner) => found.extend(in_sequence(inner, &condition)),
            statement => found.push((statement, condition)),
        }
    }
    found
}

fn is_member(value: &Expression, number: u32, member: &str) -> bool {
    match &value.bare().kind {
        ExpressionKind::Member(object, name) => {
            name == member && object.bare().kind_is_local(number)
        }
        _ => false,
    }
}

fn reads(value: &Expression, number: u32, member: &str) -> bool {
    let mut found = false;
    value.walk(&mut |part| found |= is_member(part, number, member));
    found
}

/// Whether a statement may return, or has something to do with the member.
fn needs(statement: &Statement, number: u32, member: &str) -> bool {
    let mut found = false;
    within_statement(statement, &mut |one| {
        found |= matches!(one, Statement::Return(_));
        let values = own_expressions(one);
        found |= values.into_iter().any(|value| reads(value, number, member));
    });
    found
}

/// Whether an expression reads what the stage returns.
pub fn reads_outputs(value: &Expression, writer: &Writer<'_>) -> bool {
    let mut found = false;
    value.walk(&mut |part| {
        if let ExpressionKind::Name(_, Meaning::Local(numbers)) = &part.kind {
            let role = writer.role(numbers);
            found |= matches!(role, Some(super::expression::LocalRole::Outputs(_)));
        }
    });
    found
}
