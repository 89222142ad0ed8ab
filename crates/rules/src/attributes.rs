//! Attributes where they do not belong.

use super::constants::{Constants, Kind, check_untyped};
use super::names::{Global, Module, stage_of};
use super::syntax::{
    Attribute, Declaration, DeclarationKind, ExprId, ExprKind, Function, Severity, Tree,
};
use super::{Problem, Rule};

pub fn check(tree: &Tree<'_>, module: &Module<'_, '_>) -> Vec<Problem> {
    let (mut problems, constants) = (Vec::new(), Constants::of(module));
    for declaration in &tree.declarations {
        problems.extend(misplaced_of_declaration(declaration));
    }
    for member in tree.structs.iter().flat_map(|structure| &structure.members) {
        let arguments = member.attributes.iter().flat_map(|attribute| &attribute.arguments);
        problems.extend(arguments.filter_map(|id| check_untyped(&constants, *id)));
    }
    for function in &tree.functions {
        problems.extend(misplaced_of_function(function));
        problems.extend(mixed_sizes(module, function));
        problems.extend(compute_input(module, function));
        problems.extend(high_locations(module, function));
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
fn mixed_sizes(module: &Module<'_, '_>, function: &Function<'_>) -> Option<Problem> {
    let sizes = function.attributes.iter().find(|attribute| attribute.name == "workgroup_size")?;
    let constants = Constants::of(module);
    let kinds: Vec<Kind> =
        sizes.arguments.iter().filter_map(|id| kind_of_size(&constants, *id)).collect();
    let message = "the sizes of a workgroup must have one type, `i32` or `u32`".to_owned();
    (kinds.contains(&Kind::I32) && kinds.contains(&Kind::U32))
        .then(|| Problem::new(Rule::Attribute, sizes.place, message))
}

/// The type of a size, which may be computed from overrides.
fn kind_of_size(constants: &Constants<'_, '_, '_>, id: ExprId) -> Option<Kind> {
    let tree = constants.module.tree;
    let id = tree.inner(id);
    if let Some(kind) = constants.kind(id) {
        return Some(kind);
    }
    match tree.kind(id) {
        ExprKind::Name { name, template: _, local: None } => {
            let Some(Global::Constant(at)) = constants.module.find(name) else { return None };
            let Declaration { of_type, value, .. } = &tree.declarations[at];
            match of_type {
                Some(of_type) => constants.type_at(*of_type).map(|(kind, _)| kind),
                // A number without a suffix is an `i32` in an override.
                None => Some(match constants.kind((*value)?)? {
                    Kind::AbstractInt => Kind::I32,
                    kind => kind,
                }),
            }
        }
        ExprKind::Unary { operator: _, operand } => kind_of_size(constants, *operand),
        ExprKind::Binary { operator: _, left, right } => {
            let kinds = [*left, *right].map(|side| kind_of_size(constants, side));
            kinds.into_iter().flatten().find(|kind| *kind != Kind::AbstractInt)
        }
        _ => None,
    }
}

/// How many locations every device has for the inputs and the outputs of a stage, by the limits that
/// WebGPU gives without a request: `maxVertexAttributes`, `maxInterStageShaderVariables` and
/// `maxColorAttachments`.
fn locations_of(stage: &str) -> (u64, u64) {
    match stage {
        "fragment" => (16, 8),
        _ => (16, 16),
    }
}

/// Locations that a device has only where more were asked for.
fn high_locations(module: &Module<'_, '_>, function: &Function<'_>) -> Vec<Problem> {
    let Some(stage @ ("vertex" | "fragment")) = stage_of(function) else { return Vec::new() };
    let (inputs, outputs) = locations_of(stage);
    let parameters = function.parameters.iter();
    let read = parameters.map(|one| (inputs, &one.attributes[..], Some(one.of_type)));
    let written = (outputs, &function.result_attributes[..], function.result);
    let mut problems = Vec::new();
    for (most, attributes, of_type) in read.chain([written]) {
        let structure = of_type.and_then(|of_type| module.structure(of_type));
        let members = structure.map_or(&[][..], |at| &module.tree.structs[at].members);
        let within = members.iter().flat_map(|member| &member.attributes);
        for attribute in attributes.iter().chain(within) {
            problems.extend(high_location(module.tree, attribute, most));
        }
    }
    problems
}

fn high_location(tree: &Tree<'_>, attribute: &Attribute<'_>, most: u64) -> Option<Problem> {
    let ("location", [argument]) = (attribute.name, &attribute.arguments[..]) else { return None };
    let ExprKind::Literal(text) = tree.kind(tree.inner(*argument)) else { return None };
    let number: u64 = text.trim_end_matches(['i', 'u']).parse().ok().filter(|at| *at >= most)?;
    let message = format!(
        "a device has the locations 0 to {} here, and {number} only where more were asked for",
        most - 1
    );
    let severity = Severity::Warning;
    Some(Problem { severity, ..Problem::new(Rule::Attribute, attribute.place, message) })
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
