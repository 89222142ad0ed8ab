//! Attributes where they do not belong.

use super::constants::check_untyped;
use super::names::{Module, stage_of};
use super::syntax::{Attribute, Declaration, DeclarationKind, ExprKind, Function, Tree};
use super::{Problem, Rule};

pub fn check(tree: &Tree<'_>, module: &Module<'_, '_>) -> Vec<Problem> {
    let mut problems = Vec::new();
    for declaration in &tree.declarations {
        problems.extend(misplaced_of_declaration(declaration));
    }
    for member in tree.structs.iter().flat_map(|structure| &structure.members) {
        let arguments = member.attributes.iter().flat_map(|attribute| &attribute.arguments);
        problems.extend(arguments.filter_map(|id| check_untyped(tree, *id)));
    }
    for function in &tree.functions {
        problems.extend(misplaced_of_function(function));
        problems.extend(mixed_sizes(tree, function));
        problems.extend(compute_input(module, function));
    }
    problems
}

fn misplaced(attributes: &[Attribute<'_>], allowed: &[&str], of: &str) -> Option<Problem> {
    let found = attributes.iter().find(|attribute| !allowed.contains(&attribute.name))?;
    let message = format!("`@{}` does not belong to {of}", found.name);
    Some(Problem::new(Rule::Attribute, found.place, message))
}

fn misplaced_of_declaration(declaration: &Declaration<'_>) -> Option<Problem> {
    let (allowed, of): (&[&str], &str) = match declaration.kind {
        DeclarationKind::Var => (&["group", "binding"], "a variable"),
        DeclarationKind::Override => (&["id"], "an override"),
        DeclarationKind::Const | DeclarationKind::Let => (&[], "a constant"),
    };
    misplaced(&declaration.attributes, allowed, of)
}

fn misplaced_of_function(function: &Function<'_>) -> Option<Problem> {
    const ENTRY: [&str; 5] = ["vertex", "fragment", "compute", "workgroup_size", "must_use"];
    let sizes = function.attributes.iter().find(|attribute| attribute.name == "workgroup_size");
    match sizes {
        Some(sizes) if stage_of(function) != Some("compute") => {
            let message = "`@workgroup_size` belongs to compute shaders".to_owned();
            Some(Problem::new(Rule::Attribute, sizes.place, message))
        }
        _ => misplaced(&function.attributes, &ENTRY, "a function"),
    }
}

/// A workgroup size with `i32` and `u32`.
fn mixed_sizes(tree: &Tree<'_>, function: &Function<'_>) -> Option<Problem> {
    let sizes = function.attributes.iter().find(|attribute| attribute.name == "workgroup_size")?;
    let ends_with = |suffix: char| {
        let is = |id: &u32| match tree.kind(*id) {
            ExprKind::Literal(text) => text.ends_with(suffix),
            _ => false,
        };
        sizes.arguments.iter().any(is)
    };
    let message = "the sizes of a workgroup must have one type".to_owned();
    (ends_with('i') && ends_with('u')).then(|| Problem::new(Rule::Attribute, sizes.place, message))
}

/// An input with a location of a compute shader.
fn compute_input(module: &Module<'_, '_>, function: &Function<'_>) -> Option<Problem> {
    (stage_of(function) == Some("compute")).then_some(())?;
    let own = |attributes: &[Attribute<'_>]| {
        attributes.iter().find(|attribute| attribute.name == "location").map(|found| found.place)
    };
    let direct = function
        .parameters
        .iter()
        .find_map(|parameter| own(&parameter.attributes))
        .or_else(|| own(&function.result_attributes));
    let types = function.parameters.iter().map(|parameter| parameter.of_type);
    let place = direct.or_else(|| {
        types.chain(function.result).find_map(|of_type| {
            let structure = module.structure(of_type)?;
            module.tree.structs[structure].members.iter().find_map(|member| own(&member.attributes))
        })
    })?;
    let message = "a compute shader has no inputs or outputs with `@location`".to_owned();
    Some(Problem::new(Rule::Attribute, place, message))
}
