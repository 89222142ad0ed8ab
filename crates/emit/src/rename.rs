//! Renames declarations whose names a writer uses for something else.

use naga::{Function, Module, StructMember, Type, TypeInner};

/// The module with other names for those that are taken; `None` where none is. The entry point's
/// name is changed too.
pub fn rename_taken(module: &Module, is_taken: &dyn Fn(&str) -> bool) -> Option<Module> {
    // naga drops underscores at the end, and all but one of several in a row.
    let is_taken = |name: &str| is_taken(name) || is_taken(&plain_name(name));
    if !names_of(module).any(is_taken) {
        return None;
    }
    let mut module = module.clone();
    let change = |name: &mut String| {
        if is_taken(name) {
            // naga puts `gen_` before the names that it knows to be taken. Unlike naga, this makes
            // no two underscores in a row.
            name.insert_str(0, if name.starts_with('_') { "gen" } else { "gen_" });
        }
    };
    let new = |name: &mut Option<String>| name.iter_mut().for_each(change);
    let types: Vec<_> = module.types.iter().map(|(handle, ty)| (handle, ty.clone())).collect();
    for (handle, Type { mut name, mut inner }) in types {
        new(&mut name);
        if let TypeInner::Struct { members, span: _ } = &mut inner {
            members.iter_mut().for_each(|member| new(&mut member.name));
        }
        let changed = Type { name, inner };
        // `replace` refuses a type that equals the one it replaces.
        if module.types[handle] != changed {
            module.types.replace(handle, changed);
        }
    }
    module.constants.iter_mut().for_each(|(_, constant)| new(&mut constant.name));
    module.global_variables.iter_mut().for_each(|(_, variable)| new(&mut variable.name));
    let change_function = |function: &mut Function| {
        new(&mut function.name);
        function.arguments.iter_mut().for_each(|argument| new(&mut argument.name));
        function.local_variables.iter_mut().for_each(|(_, local)| new(&mut local.name));
        function.named_expressions.values_mut().for_each(change);
    };
    module.functions.iter_mut().for_each(|(_, function)| change_function(function));
    for point in &mut module.entry_points {
        change(&mut point.name);
        change_function(&mut point.function);
    }
    Some(module)
}

/// The module with other names for structures that have the name of a member of some structure;
/// `None` where none has. In C++ and HLSL, the name means the member in all that follows within the
/// structure.
pub fn rename_types_like_members(module: &Module) -> Option<Module> {
    let alike: Vec<_> = module.types.iter().filter(|(_, ty)| is_like_member(module, ty)).collect();
    if alike.is_empty() {
        return None;
    }
    let mut changed = module.clone();
    for (handle, ty) in alike {
        let mut ty = ty.clone();
        while is_like_member(module, &ty) {
            ty.name.get_or_insert_default().push_str("_type");
        }
        changed.types.replace(handle, ty);
    }
    Some(changed)
}

fn is_like_member(module: &Module, ty: &Type) -> bool {
    let (TypeInner::Struct { members: _, span: _ }, Some(name)) = (&ty.inner, &ty.name) else {
        return false;
    };
    // naga drops underscores at the end.
    let is_it = |member: &str| member.trim_end_matches('_') == name.trim_end_matches('_');
    members_of(module).filter_map(|member| member.name.as_deref()).any(is_it)
}

fn members_of(module: &Module) -> impl Iterator<Item = &StructMember> {
    module.types.iter().flat_map(|(_, ty)| match &ty.inner {
        TypeInner::Struct { members, span: _ } => members.as_slice(),
        _ => &[],
    })
}

/// A name as naga writes it, without the number that it may append.
fn plain_name(name: &str) -> String {
    let mut plain = String::with_capacity(name.len());
    for letter in name.trim_end_matches('_').chars() {
        if letter != '_' || !plain.ends_with('_') {
            plain.push(letter);
        }
    }
    plain
}

/// Every name of a module.
fn names_of(module: &Module) -> impl Iterator<Item = &str> {
    let types = module.types.iter().map(|(_, ty)| &ty.name);
    let constants = module.constants.iter().map(|(_, constant)| &constant.name);
    let variables = module.global_variables.iter().map(|(_, variable)| &variable.name);
    let points = module.entry_points.iter();
    let functions = module.functions.iter().map(|(_, function)| function);
    let functions = functions.chain(points.clone().map(|point| &point.function));
    let declared = types.chain(members_of(module).map(|member| &member.name)).chain(constants);
    let declared = declared.chain(variables).filter_map(Option::as_deref);
    declared.chain(functions.flat_map(of_function)).chain(points.map(|point| point.name.as_str()))
}

fn of_function(function: &Function) -> impl Iterator<Item = &str> {
    let arguments = function.arguments.iter().map(|argument| &argument.name);
    let locals = function.local_variables.iter().map(|(_, local)| &local.name);
    let declared = std::iter::once(&function.name).chain(arguments).chain(locals);
    let values = function.named_expressions.values().map(String::as_str);
    declared.filter_map(Option::as_deref).chain(values)
}
