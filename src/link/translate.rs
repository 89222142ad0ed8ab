//! One unit in every target: naga writes its canonical text, and what is its own is cut out.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use naga::front::{glsl, wgsl};
use naga::valid::{ModuleInfo, ValidationFlags, Validator};
use naga::{
    AddressSpace, ArraySize, Block, Expression, Function, GlobalVariable, Handle, LocalVariable,
    Module, ResourceBinding, Scalar, ScalarKind, Span, Statement, Type, TypeInner,
};

use super::canonical::{BUILT_INS, IDLE, Recipe, Unit};
use super::cut::{self, Cut, Fragment};
use super::mark::{self, SCRATCH};
use super::outline::Outline;
use super::reason::Reason;
use super::summary::{Summary, globals, name_of, summarise};
use crate::bundle::Language;
use crate::bundle::{Clip, Native, Reflection, Target};
use crate::compose::Composed;
use crate::emit::{self, type_name};
use crate::validate::{CAPABILITIES, Validated, guard, is_bounded, is_calm, on_large_stack};

/// A unit in every target.
pub struct Translated {
    pub summary: Summary,
    /// In the order of the targets; a target that cannot be cut stays whole, and no other.
    pub targets: Vec<Result<Written, Reason>>,
    /// Of an entry point.
    pub reflection: Option<Arc<Reflection>>,
}

/// A unit in one target.
pub enum Written {
    /// The author's names are references; what the output calls things is JSON.
    Text { cut: Cut, native: Option<Fragment> },
    /// A SPIR-V module with names as they are.
    Words { words: Vec<u32>, native: Native },
}

/// The declarations of a canonical text, as naga knows them.
struct Parsed {
    validated: Validated,
    entry: String,
    /// The author's names by the number of their mark.
    names: Vec<String>,
    marked: Validated,
}

/// Translates a unit for some targets.
///
/// # Errors
/// The reason why texts with the unit are compiled as a whole.
pub fn translate(
    outline: &Outline<'_>,
    recipe: &Recipe<'_>,
    targets: &[Target],
    clip: Clip,
) -> Result<Translated, Reason> {
    let text = recipe.text(outline)?;
    let stage = Some(match outline.stage {
        naga::ShaderStage::Vertex => crate::bundle::Stage::Vertex,
        _ => crate::bundle::Stage::Fragment,
    });
    let composed = Composed::of_text(outline.language, stage, text);
    if !is_calm(&composed).map_err(|_| Reason::Refused)? {
        return Err(Reason::Large);
    }
    on_large_stack(|| guard(&composed.text, || inner(outline, recipe, &composed, targets, clip)))
        .unwrap_or(Err(Reason::Refused))
}

fn inner(
    outline: &Outline<'_>,
    recipe: &Recipe<'_>,
    composed: &Composed,
    targets: &[Target],
    clip: Clip,
) -> Result<Translated, Reason> {
    let mut module = parse(outline, &composed.text)?;
    if !is_bounded(&module) {
        return Err(Reason::Refused);
    }
    show_stubs(outline, recipe, &mut module)?;
    call_function(outline, recipe, &mut module)?;
    let info = Validator::new(ValidationFlags::all(), CAPABILITIES)
        .validate(&module)
        .map_err(|_| Reason::Refused)?;
    let summary = summary(outline, recipe, &module, &info)?;
    let is_entry = recipe.unit == Unit::Entry;
    if is_entry && !summary.is_for(outline.stage) {
        return Err(Reason::Stage);
    }
    let entry = module.entry_points.first().ok_or(Reason::EntryPoint)?.name.clone();
    let (marked, names) = mark_module(outline, recipe, &module)?;
    let marked = Validated { language: outline.language, module: marked, info: info.clone() };
    let validated = Validated { language: outline.language, module, info };
    let reflection = is_entry.then(|| emit::reflect(&validated, &entry).map(Arc::new));
    let reflection = reflection.transpose().map_err(|_| Reason::Refused)?;
    let parsed = Parsed { validated, entry, names, marked };
    let targets = targets.iter().map(|target| write(outline, recipe, &parsed, *target, clip));
    Ok(Translated { summary, targets: targets.collect(), reflection })
}

fn parse(outline: &Outline<'_>, text: &str) -> Result<Module, Reason> {
    match outline.language {
        Language::Wesl => wgsl::parse_str(text).map_err(|_| Reason::Refused),
        Language::Glsl => glsl::Frontend::default()
            .parse(&glsl::Options::from(outline.stage), text)
            .map_err(|_| Reason::Refused),
    }
}

/// Makes stubs use the variables that their functions use: a named expression is a use of which
/// nothing is written.
fn show_stubs(
    outline: &Outline<'_>,
    recipe: &Recipe<'_>,
    module: &mut Module,
) -> Result<(), Reason> {
    let variables: BTreeMap<String, _> = module
        .global_variables
        .iter()
        .map(|(handle, variable)| Some((name_of(module, variable)?, handle)))
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

/// Makes the idle entry point call the function: writers leave out what an entry point does not
/// reach. GLSL's `main` is called already.
fn call_function(
    outline: &Outline<'_>,
    recipe: &Recipe<'_>,
    module: &mut Module,
) -> Result<(), Reason> {
    let Unit::Function(index) = recipe.unit else { return Ok(()) };
    let name = outline.declarations[index].name();
    if outline.language == Language::Glsl && name == "main" {
        return Ok(());
    }
    let found = module.functions.iter().find(|(_, found)| found.name.as_deref() == Some(name));
    let (handle, function) = found.ok_or(Reason::Refused)?;
    let types: Vec<_> = function.arguments.iter().map(|argument| argument.ty).collect();
    let has_result = function.result.is_some();
    let mut point = module.entry_points.pop().ok_or(Reason::EntryPoint)?;
    let span = Span::UNDEFINED;
    let mut pointers = Vec::with_capacity(types.len());
    for ty in types {
        let (argument, is_value) = argument(module, &mut point.function, ty)?;
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

/// Something to pass for a parameter, and whether it has to be loaded: what it is does not matter.
fn argument(
    module: &mut Module,
    point: &mut Function,
    ty: Handle<Type>,
) -> Result<(Expression, bool), Reason> {
    let (space, base, is_value) = match module.types[ty].inner {
        TypeInner::Pointer { base, space } => (space, base, false),
        TypeInner::Image { .. } | TypeInner::Sampler { .. } => (AddressSpace::Handle, ty, false),
        TypeInner::BindingArray { .. } | TypeInner::ValuePointer { .. } => {
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

/// A binding that every target can number.
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

/// The summary of the unit, once every stub shows what its function does.
fn summary(
    outline: &Outline<'_>,
    recipe: &Recipe<'_>,
    module: &Module,
    info: &ModuleInfo,
) -> Result<Summary, Reason> {
    let mut stubs = BTreeMap::new();
    for (handle, function) in module.functions.iter() {
        let name = function.name.as_deref();
        let is_it =
            |(stub, _): &&(usize, &Summary)| name == Some(outline.declarations[*stub].name());
        if let Some((_, summary)) = recipe.stubs.iter().find(is_it) {
            if globals(module, &info[handle]).as_ref() != Some(&summary.globals) {
                return Err(Reason::Stub);
            }
            stubs.insert(handle, *summary);
        }
    }
    let callee = |handle| stubs.get(&handle).copied();
    let found = match (recipe.unit, recipe.function) {
        (Unit::Function(index), _) => {
            let name = Some(outline.declarations[index].name());
            let mut functions = module.functions.iter();
            let found = functions.find(|(_, function)| function.name.as_deref() == name);
            let (handle, function) = found.ok_or(Reason::Refused)?;
            summarise(module, &info[handle], function, &callee)
        }
        (Unit::Entry, _) => {
            let point = module.entry_points.first().ok_or(Reason::EntryPoint)?;
            summarise(module, info.get_entry_point(0), &point.function, &callee)
        }
    };
    found.ok_or(Reason::Sampling)
}

/// The module with marks for names, and the names by number.
fn mark_module(
    outline: &Outline<'_>,
    recipe: &Recipe<'_>,
    module: &Module,
) -> Result<(Module, Vec<String>), Reason> {
    let mut marked = module.clone();
    let mut names = vec![String::new()];
    let mut new = |name: &str| {
        names.push(name.to_owned());
        Some(mark::mark(names.len() as u32 - 1))
    };
    let is_function = matches!(recipe.unit, Unit::Function(_));
    let predeclared: BTreeSet<_> =
        module.special_types.predeclared_types.values().copied().collect();
    for (handle, found) in module.types.iter() {
        let name = match (&found.name, &found.inner) {
            _ if predeclared.contains(&handle) => continue,
            (Some(name), TypeInner::Struct { .. }) => new(name),
            // The result of the entry point that naga makes of a GLSL `main`.
            (None, TypeInner::Struct { .. }) if is_function => Some(mark::mark(SCRATCH)),
            (_, TypeInner::Array { .. }) => {
                Some(array_name(&marked, found).ok_or(Reason::Declaration)?)
            }
            (Some(_), _) => None,
            _ => continue,
        };
        let inner = found.inner.clone();
        // Two names of one type: the text has an alias that could not be replaced.
        if marked.types.get(&Type { name: name.clone(), inner: inner.clone() }).is_some() {
            return Err(Reason::Declaration);
        }
        marked.types.replace(handle, Type { name, inner });
    }
    for (_, variable) in marked.global_variables.iter_mut() {
        match &variable.name {
            Some(name) if name == IDLE => variable.name = Some(mark::mark(SCRATCH)),
            Some(name) => variable.name = new(name),
            None => {}
        }
    }
    for (_, constant) in marked.constants.iter_mut() {
        if let Some(name) = &constant.name {
            constant.name = new(name);
        }
    }
    let stubs: BTreeSet<&str> =
        recipe.stubs.iter().map(|(stub, _)| outline.declarations[*stub].name()).collect();
    for (_, function) in marked.functions.iter_mut() {
        let Some(name) = function.name.clone() else { continue };
        if name == BUILT_INS {
            function.name = Some(mark::mark(SCRATCH));
            continue;
        }
        function.name = new(&name);
        if stubs.contains(&*name) {
            function.arguments.iter_mut().for_each(|argument| argument.name = None);
            function.local_variables.iter_mut().for_each(|(_, local)| {
                local.name = Some(mark::mark(SCRATCH));
            });
        }
    }
    if is_function {
        marked.entry_points.iter_mut().for_each(|point| point.name = mark::mark(SCRATCH));
    }
    Ok((marked, names))
}

/// Languages without arrays by value need a name for each: it tells what the array holds.
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

fn write(
    outline: &Outline<'_>,
    recipe: &Recipe<'_>,
    parsed: &Parsed,
    target: Target,
    clip: Clip,
) -> Result<Written, Reason> {
    if target == Target::SPIRV {
        let emitted = emit::emit_for(&parsed.validated, &parsed.entry, target, clip);
        let emitted = emitted.map_err(|_| Reason::Refused)?;
        let words = emitted.bytes.as_chunks::<4>().0;
        let words = words.iter().map(|word| u32::from_le_bytes(*word)).collect();
        return Ok(Written::Words { words, native: emitted.native });
    }
    let entry = parsed.marked.module.entry_points.first().map_or(IDLE, |point| &point.name);
    let emitted = emit::emit_for(&parsed.marked, entry, target, clip);
    let emitted = emitted.map_err(|_| Reason::Refused)?;
    let text = String::from_utf8(emitted.bytes).map_err(|_| Reason::Shape)?;
    let function = match recipe.unit {
        Unit::Function(index) => Some(outline.declarations[index].name()),
        Unit::Entry => None,
    };
    let wanted = cut::Wanted { function, entry: &emitted.native.entry_name, names: &parsed.names };
    let mut cut = cut::cut(&text, &wanted)?;
    cut.add_locals(&locals(recipe, &parsed.validated.module, function), wanted.entry);
    let native = match recipe.unit {
        Unit::Function(_) => None,
        Unit::Entry => {
            let native = serde_json::to_string(&emitted.native).map_err(|_| Reason::Shape)?;
            Some(Fragment::read(&native, &parsed.names)?)
        }
    };
    Ok(Written::Text { cut, native })
}

/// Names that the author gave within the unit's function: naga may number them.
fn locals<'m>(recipe: &Recipe<'_>, module: &'m Module, name: Option<&str>) -> BTreeSet<&'m str> {
    let function = match recipe.unit {
        Unit::Entry => module.entry_points.first().map(|point| &point.function),
        Unit::Function(_) => {
            let mut functions = module.functions.iter().map(|(_, function)| function);
            functions.find(|function| function.name.as_deref() == name)
        }
    };
    let of = |function: &'m Function| {
        let arguments = function.arguments.iter().filter_map(|argument| argument.name.as_deref());
        let variables =
            function.local_variables.iter().filter_map(|(_, local)| local.name.as_deref());
        let values = function.named_expressions.values().map(String::as_str);
        arguments.chain(variables).chain(values)
    };
    function.into_iter().flat_map(of).map(|name| name.trim_end_matches('_')).collect()
}
