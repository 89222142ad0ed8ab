//! Adds uses to a module: naga leaves out what nothing uses. Stubs are made to use what their
//! functions use, and the entry point to call the unit's function.

use std::collections::{BTreeMap, BTreeSet};

use naga::{
    AddressSpace, Block, Expression, Function, GlobalVariable, Handle, LocalVariable, Module,
    ResourceBinding, Span, Statement, Type, TypeInner,
};

use super::canonical::{IDLE, Recipe, UnitId};
use super::outline::Outline;
use super::reason::Reason;

/// Makes each stub use the variables that its function uses. A named expression counts as a use,
/// and writers write nothing for it.
pub fn show_stubs(
    outline: &Outline<'_>,
    recipe: &Recipe<'_>,
    module: &mut Module,
) -> Result<(), Reason> {
    let variables: BTreeMap<String, _> = module
        .global_variables
        .iter()
        .map(|(handle, variable)| Some((variable.name.clone()?, handle)))
        .collect::<Option<_>>()
        .ok_or(Reason::Declaration)?;
    let shown = |function: &mut Function, name: &str| {
        let variable = *variables.get(name).ok_or(Reason::Stub)?;
        let span = naga::Span::UNDEFINED;
        let used = function.expressions.append(Expression::GlobalVariable(variable), span);
        function.named_expressions.insert(used, "shown".to_owned());
        Ok(())
    };
    for (_, function) in module.functions.iter_mut() {
        let stub = recipe
            .stubs
            .iter()
            .find(|(stub, _)| function.name.as_deref() == Some(outline.declarations[*stub].name()));
        for name in stub.iter().flat_map(|(_, summary)| &summary.globals) {
            shown(function, name)?;
        }
    }
    Ok(())
}

/// Makes the entry point that does nothing call the function, since writers leave out what no entry
/// point reaches.
pub fn call_function(
    outline: &Outline<'_>,
    recipe: &Recipe<'_>,
    module: &mut Module,
) -> Result<(), Reason> {
    let UnitId::Function(index) = recipe.unit else { return Ok(()) };
    let name = outline.declarations[index].name();
    let found = module.functions.iter().find(|(_, found)| found.name.as_deref() == Some(name));
    let (handle, function) = found.ok_or(Reason::Refused)?;
    let types: Vec<_> = function.arguments.iter().map(|argument| argument.ty).collect();
    let has_result = function.result.is_some();
    let mut point = module.entry_points.pop().ok_or(Reason::EntryPoint)?;
    let span = Span::UNDEFINED;
    let mut pointers = Vec::with_capacity(types.len());
    for ty in types {
        let (argument, is_value) = argument_for(module, &mut point.function, ty)?;
        pointers.push((point.function.expressions.append(argument, span), is_value));
    }
    let expressions = &mut point.function.expressions;
    let loads = expressions.len();
    let mut arguments = Vec::with_capacity(pointers.len());
    for (pointer, is_value) in pointers {
        let load = Expression::Load { pointer };
        arguments.push(if is_value { expressions.append(load, span) } else { pointer });
    }
    let mut body = Block::new();
    body.push(Statement::Emit(expressions.range_from(loads)), span);
    let result = has_result.then(|| expressions.append(Expression::CallResult(handle), span));
    body.push(Statement::Call { function: handle, arguments, result }, span);
    body.extend_block(std::mem::take(&mut point.function.body));
    point.function.body = body;
    module.entry_points.push(point);
    Ok(())
}

/// An expression to pass for a parameter, and whether it has to be loaded first. Its value does not
/// matter.
fn argument_for(
    module: &mut Module,
    point: &mut Function,
    ty: Handle<Type>,
) -> Result<(Expression, bool), Reason> {
    let (space, base, is_value) = match module.types[ty].inner {
        TypeInner::Pointer { base, space } => (space, base, false),
        TypeInner::Image { dim: _, arrayed: _, class: _ }
        | TypeInner::Sampler { comparison: _ } => (AddressSpace::Handle, ty, false),
        TypeInner::BindingArray { base: _, size: _ }
        | TypeInner::ValuePointer { size: _, scalar: _, space: _ } => {
            return Err(Reason::BindingArray);
        }
        _ => (AddressSpace::Function, ty, true),
    };
    let name = Some(IDLE.to_owned());
    match space {
        AddressSpace::Function => {
            let local = LocalVariable { name, ty: base, init: None };
            let local = point.local_variables.append(local, Span::UNDEFINED);
            Ok((Expression::LocalVariable(local), is_value))
        }
        AddressSpace::Private | AddressSpace::Handle => {
            let binding = match space {
                AddressSpace::Handle => Some(free_binding(module).ok_or(Reason::Stub)?),
                _ => None,
            };
            let memory_decorations = naga::MemoryDecorations::empty();
            let variable =
                GlobalVariable { name, space, binding, ty: base, init: None, memory_decorations };
            let variable = module.global_variables.append(variable, Span::UNDEFINED);
            Ok((Expression::GlobalVariable(variable), false))
        }
        _ => Err(Reason::StorageBuffer),
    }
}

/// A binding that is free, and that every target can number.
fn free_binding(module: &Module) -> Option<ResourceBinding> {
    let taken: BTreeSet<_> = module
        .global_variables
        .iter()
        .filter_map(|(_, variable)| Some((variable.binding?.group, variable.binding?.binding)))
        .collect();
    let mut all = (0..16).flat_map(|group| (0..16).map(move |binding| (group, binding)));
    let (group, binding) = all.find(|place| !taken.contains(place))?;
    Some(ResourceBinding { group, binding })
}
