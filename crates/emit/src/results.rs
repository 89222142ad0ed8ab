//! Variables that hold what `modf`, `frexp` or `atomicCompareExchangeWeak` returns, in WGSL.
//!
//! These structures have no name that a text could use, and naga declares the variable with their type.
//! It gets a structure of the same members here, which each value is put into.

use std::collections::BTreeMap;

use naga::valid::{FunctionInfo, ModuleInfo};
use naga::{
    Arena, Block, Expression, Function, Handle, LocalVariable, Module, Range, Span, SpecialTypes,
    Statement, Type,
};

use lamplight_validate::{info_unchecked, inner_blocks_mut};

/// The structure in the place of each that has no name.
type Named = BTreeMap<Handle<Type>, Handle<Type>>;

/// The module with such variables of structures that have names, and naga's analysis of it; `None` where
/// there are none.
///
/// # Errors
/// The message of naga, if it refuses the new module.
pub fn with_named_results(
    module: &Module,
    info: &ModuleInfo,
) -> Result<Option<(Module, ModuleInfo)>, String> {
    let unnamed = unnamed_types(module);
    let functions = module.functions.iter().map(|(_, function)| function);
    let mut all = functions.chain(module.entry_points.iter().map(|point| &point.function));
    let has_some = |function: &Function| {
        function.local_variables.iter().any(|(_, one)| unnamed.contains(&one.ty))
    };
    if unnamed.is_empty() || !all.any(has_some) {
        return Ok(None);
    }
    let mut made = module.clone();
    let named = unnamed.into_iter().map(|ty| (ty, named_type(&mut made, ty))).collect();
    for (handle, function) in made.functions.iter_mut() {
        name_results(function, &info[handle], &named);
    }
    for (index, point) in made.entry_points.iter_mut().enumerate() {
        name_results(&mut point.function, info.get_entry_point(index), &named);
    }
    let info = info_unchecked(&made)
        .map_err(|error| format!("a module with named results is not valid: {error}"))?;
    Ok(Some((made, info)))
}

/// The structures that built-in functions return.
fn unnamed_types(module: &Module) -> Vec<Handle<Type>> {
    let SpecialTypes {
        ray_desc: _,
        ray_intersection: _,
        ray_vertex_return: _,
        external_texture_params: _,
        external_texture_transfer_function: _,
        predeclared_types,
    } = &module.special_types;
    predeclared_types.values().copied().collect()
}

fn named_type(module: &mut Module, ty: Handle<Type>) -> Handle<Type> {
    let Type { name, inner } = module.types[ty].clone();
    let name = name.map(|name| name.trim_start_matches('_').to_owned());
    module.types.insert(Type { name, inner }, Span::UNDEFINED)
}

fn name_results(function: &mut Function, info: &FunctionInfo, named: &Named) {
    let mut found = BTreeMap::new();
    for (handle, LocalVariable { name: _, ty, init: _ }) in function.local_variables.iter_mut() {
        if let Some(new) = named.get(ty) {
            *ty = *new;
            found.insert(handle, *new);
        }
    }
    if found.is_empty() {
        return;
    }
    let expressions = &mut function.expressions;
    let stored = |expressions: &Arena<Expression>,
                  pointer: Handle<Expression>,
                  value: Handle<Expression>| {
        let Expression::LocalVariable(local) = expressions[pointer] else { return None };
        // What another such variable holds has the new type already.
        let is_unnamed = info[value].ty.handle().is_some_and(|ty| named.contains_key(&ty))
            && !matches!(expressions[value], Expression::Load { pointer: _ });
        found.get(&local).copied().filter(|_| is_unnamed)
    };
    put_into(&mut function.body, expressions, &stored);
}

type Stored<'s> =
    &'s dyn Fn(&Arena<Expression>, Handle<Expression>, Handle<Expression>) -> Option<Handle<Type>>;

/// Puts each value that is stored into the new structure.
fn put_into(block: &mut Block, expressions: &mut Arena<Expression>, stored: Stored<'_>) {
    let old = std::mem::take(block);
    for (mut statement, span) in old.span_into_iter() {
        if let Statement::Store { pointer, value } = &mut statement
            && let Some(ty) = stored(expressions, *pointer, *value)
        {
            let base = *value;
            let mut part =
                |index| expressions.append(Expression::AccessIndex { base, index }, span);
            let components = vec![part(0), part(1)];
            let first = components[0];
            *value = expressions.append(Expression::Compose { ty, components }, span);
            let added = Range::new_from_bounds(first, *value);
            block.push(Statement::Emit(added), span);
        }
        inner_blocks_mut(&mut statement)
            .into_iter()
            .for_each(|inner| put_into(inner, expressions, stored));
        block.push(statement, span);
    }
}
