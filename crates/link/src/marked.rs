//! A module in which the author's names are marks.

use std::collections::BTreeSet;

use naga::{ArraySize, Module, Scalar, ScalarKind, Type, TypeInner};

use super::canonical::{IDLE, Recipe, UnitId};
use super::mark::{self, SCRATCH};
use super::outline::Outline;
use super::reason::Reason;
use lamplight_emit::type_name;

/// The module with marks for names, and the names by number.
pub fn mark_module(
    outline: &Outline<'_>,
    recipe: &Recipe<'_>,
    module: &Module,
) -> Result<(Module, Vec<String>), Reason> {
    let mut marked = module.clone();
    let mut names = MarkedNames(vec![String::new()]);
    let is_function = matches!(recipe.unit, UnitId::Function(_));
    mark_types(&mut marked, module, &mut names)?;
    mark_values(&mut marked, &mut names);
    mark_functions(outline, recipe, &mut marked, &mut names);
    if is_function {
        marked.entry_points.iter_mut().for_each(|point| point.name = mark::write_mark(SCRATCH));
    }
    Ok((marked, names.0))
}

/// The author's names by the number of their mark.
struct MarkedNames(Vec<String>);

impl MarkedNames {
    /// The mark of the next name.
    fn mark(&mut self, name: &str) -> String {
        self.0.push(name.to_owned());
        mark::write_mark(self.0.len() as u32 - 1)
    }
}

fn mark_types(marked: &mut Module, module: &Module, names: &mut MarkedNames) -> Result<(), Reason> {
    let predeclared: BTreeSet<_> =
        module.special_types.predeclared_types.values().copied().collect();
    for (handle, found) in module.types.iter() {
        let name = match (&found.name, &found.inner) {
            _ if predeclared.contains(&handle) => continue,
            (Some(name), TypeInner::Struct { members: _, span: _ }) => Some(names.mark(name)),
            (_, TypeInner::Array { base: _, size: _, stride: _ }) => {
                Some(array_name(marked, found).ok_or(Reason::Declaration)?)
            }
            (Some(_), _) => None,
            _ => continue,
        };
        let inner = found.inner.clone();
        // The same type has two names: the text has an alias that could not be expanded.
        if marked.types.get(&Type { name: name.clone(), inner: inner.clone() }).is_some() {
            return Err(Reason::Declaration);
        }
        marked.types.replace(handle, Type { name, inner });
    }
    Ok(())
}

/// Marks variables and constants.
fn mark_values(marked: &mut Module, names: &mut MarkedNames) {
    for (_, variable) in marked.global_variables.iter_mut() {
        match &variable.name {
            Some(name) if name == IDLE => variable.name = Some(mark::write_mark(SCRATCH)),
            Some(name) => variable.name = Some(names.mark(name)),
            None => {}
        }
    }
    for (_, constant) in marked.constants.iter_mut() {
        if let Some(name) = &constant.name {
            constant.name = Some(names.mark(name));
        }
    }
}

/// Replaces the names of functions by marks. No output keeps the body of a stub, so its local
/// variables all get the scratch mark, and its arguments get no name.
fn mark_functions(
    outline: &Outline<'_>,
    recipe: &Recipe<'_>,
    marked: &mut Module,
    names: &mut MarkedNames,
) {
    let stubs: BTreeSet<&str> =
        recipe.stubs.iter().map(|(stub, _)| outline.declarations[*stub].name()).collect();
    for (_, function) in marked.functions.iter_mut() {
        let Some(name) = function.name.clone() else { continue };
        function.name = Some(names.mark(&name));
        if stubs.contains(&*name) {
            function.arguments.iter_mut().for_each(|argument| argument.name = None);
            function.local_variables.iter_mut().for_each(|(_, local)| {
                local.name = Some(mark::write_mark(SCRATCH));
            });
        }
    }
}

/// Some languages have no arrays by value, so writers give each array type a name. This name says
/// what the array holds.
fn array_name(module: &Module, found: &Type) -> Option<String> {
    let TypeInner::Array { base, size, stride } = found.inner else { return None };
    let size = match size {
        ArraySize::Constant(size) => size.to_string(),
        _ => return None,
    };
    let element = &module.types[base];
    let held = match &element.name {
        Some(name) => name.clone(),
        None => plain_name(module, &element.inner)
            .unwrap_or_else(|| type_name(module, base).replace(['<', '>', ',', ' '], "_")),
    };
    Some(format!("array{size}_{held}_stride{stride}b"))
}

fn plain_name(_: &Module, inner: &TypeInner) -> Option<String> {
    let scalar = |scalar: Scalar| match scalar.kind {
        ScalarKind::Float => "float",
        ScalarKind::Sint => "int",
        ScalarKind::Uint => "uint",
        _ => "bool",
    };
    match *inner {
        TypeInner::Scalar(found) => Some(scalar(found).to_owned()),
        TypeInner::Vector { size, scalar: found } => {
            Some(format!("{}{}v", scalar(found), size as u8))
        }
        TypeInner::Matrix { columns, rows, scalar: found } => {
            Some(format!("{}{}x{}m", scalar(found), columns as u8, rows as u8))
        }
        _ => None,
    }
}
