//! Arrays in HLSL: a list where one is declared, and a named type where a function returns one.

use std::collections::BTreeMap;

use lamplight_diagnostic::Diagnostic;

use super::super::expression::{Writer, listed_in};
use super::super::names::Names;
use crate::tree::{Callee, Expression, ExpressionKind, Function, Item, Node, Type};

/// The arguments of an expression that makes an array.
pub fn made_array(value: &Expression) -> Option<&[crate::tree::Argument]> {
    match &value.bare().kind {
        ExpressionKind::Call { callee: Callee::Construct(Type::Array(..)), arguments, .. }
            if !arguments.is_empty() =>
        {
            Some(arguments)
        }
        _ => None,
    }
}

impl Writer<'_> {
    /// An array as the list of its elements.
    pub fn array_list(
        &self,
        ty: &Type,
        arguments: &[crate::tree::Argument],
        is_broken: bool,
        indent: usize,
    ) -> Result<String, Diagnostic> {
        let is_broken = is_broken && arguments.iter().any(|one| one.is_on_new_line);
        let texts = self.parts(ty, arguments, is_broken, indent)?;
        Ok(listed_in("", "{}", &texts, is_broken, indent))
    }
}

/// The types of arrays that functions return, by name.
pub fn array_types(
    items: &[Node<Item>],
    names: &Names,
) -> Result<BTreeMap<String, String>, Diagnostic> {
    let mut found = BTreeMap::new();
    for node in items {
        let Item::Function(Function { result: Some(field), .. }) = &node.body else { continue };
        if matches!(field.ty, Type::Array(..)) {
            let (element, lengths) = names.declared_type(&field.ty, field.span)?;
            let name = names.returned_type(&field.ty, field.span)?;
            found.insert(name.clone(), format!("typedef {element} {name}{lengths};"));
        }
    }
    Ok(found)
}
