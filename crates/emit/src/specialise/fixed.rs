//! Overrides that decide a size, the default of another override, or the initial value of a variable.
//!
//! In WGSL the host may choose them too. The other languages, as naga writes them, have a number
//! for the size of a workgroup and for the length of an array, and a number for the default of
//! each override. So there these overrides are constants, with their defaults.

use std::collections::{BTreeMap, BTreeSet};

use naga::back::PipelineConstants;
use naga::back::pipeline_constants::{PipelineConstantError, process_overrides};
use naga::compact::{KeepUnused, compact};
use naga::valid::{ModuleInfo, TypeError, ValidationError};
use naga::{
    AddressSpace, Arena, ArraySize, EntryPoint, Expression, Function, GlobalVariable, Handle,
    Literal, Module, Override, Range, ShaderStage, Span, Statement, StructMember, Type, TypeInner,
};

use super::computed::compute_in_statements;
use super::{isolate, literal_of};
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_validate::{Validated, info_unchecked, operands};

type Overrides = BTreeSet<Handle<Override>>;

/// What sizes and defaults are where no override is set.
pub struct DefaultValues {
    /// The values of all overrides that the entry point needs.
    pub values: BTreeMap<Handle<Override>, Literal>,
    pub workgroup_size: [u32; 3],
}

/// Whether nobody wrote the override: it stands for the length of an array that depends on others.
pub fn is_length(found: &Override) -> bool {
    let Override { name, id, ty: _, init: _ } = found;
    name.is_none() && id.is_none()
}

/// The overrides that decide a size, or the default of another override; and those others.
pub fn deciding(module: &Module) -> Overrides {
    let mut found = Overrides::new();
    for point in &module.entry_points {
        found.append(&mut deciding_size(module, point));
    }
    for (_, ty) in module.types.iter() {
        found.extend(pending_length(&ty.inner));
    }
    let computed = module.overrides.iter().filter(|(_, one)| is_computed(module, one));
    found.extend(computed.map(|(handle, _)| handle));
    let values = module.global_variables.iter().filter_map(|(_, variable)| variable.init);
    values.for_each(|value| collect_named(module, value, &mut found));
    with_named(module, found)
}

/// The overrides that decide the size of an entry point's workgroups.
pub fn deciding_size(module: &Module, point: &EntryPoint) -> Overrides {
    let mut found = Overrides::new();
    let sizes = point.workgroup_size_overrides.iter().flatten().flatten();
    sizes.for_each(|size| collect_named(module, *size, &mut found));
    with_named(module, found)
}

/// These overrides, and those that their defaults name.
fn with_named(module: &Module, mut found: Overrides) -> Overrides {
    let mut open: Vec<_> = found.iter().copied().collect();
    while let Some(handle) = open.pop() {
        let mut named = Overrides::new();
        if let Some(init) = module.overrides[handle].init {
            collect_named(module, init, &mut named);
        }
        open.extend(named.difference(&found));
        found.append(&mut named);
    }
    found
}

/// Whether the default is computed from other overrides.
pub fn is_computed(module: &Module, found: &Override) -> bool {
    found.init.is_some_and(|init| literal_of(module, init).is_none())
}

/// The override that is the length of an array.
pub fn pending_length(inner: &TypeInner) -> Option<Handle<Override>> {
    match inner {
        TypeInner::Array { base: _, size: ArraySize::Pending(length), stride: _ }
        | TypeInner::BindingArray { base: _, size: ArraySize::Pending(length) } => Some(*length),
        _ => None,
    }
}

/// Adds the overrides that a constant expression names.
fn collect_named(module: &Module, expression: Handle<Expression>, found: &mut Overrides) {
    let mut open = vec![expression];
    while let Some(expression) = open.pop() {
        match &module.global_expressions[expression] {
            Expression::Override(handle) => {
                found.insert(*handle);
            }
            other => open.extend(operands(other)),
        }
    }
}

/// The error about an override that has no value where one is needed.
pub fn missing_value(name: &str, needed: &str) -> Diagnostic {
    let message = format!("the override `{name}` has no value, which {needed} needs");
    Diagnostic::error(codes::OVERRIDE_WITHOUT_VALUE, message).note(format!(
        "help: give it a default, or a value from outside: `--constant {name}=VALUE`"
    ))
}

/// The name of an override, for people.
pub fn shown_name(module: &Module, handle: Handle<Override>) -> &str {
    module.overrides[handle].name.as_deref().unwrap_or("without a name")
}

/// Computes sizes and defaults. An override without a value is left out, unless the size of a
/// workgroup needs it.
///
/// # Errors
/// `override-without-value`; `emit-failed` where the computation fails or a size is 0.
pub fn default_values(validated: &Validated, index: usize) -> Result<DefaultValues, Diagnostic> {
    let module = &validated.module;
    let point = &module.entry_points[index];
    if deciding(module).is_empty() {
        let literal = |one: &Override| one.init.and_then(|init| literal_of(module, init));
        let all = module.overrides.iter();
        let values = all.filter_map(|(handle, one)| Some((handle, literal(one)?))).collect();
        return Ok(DefaultValues { values, workgroup_size: point.workgroup_size });
    }
    Ok(values_in(validated, index)?.1)
}

/// As [`default_values`], together with the module that naga computed them in.
fn values_in(validated: &Validated, index: usize) -> Result<(Module, DefaultValues), Diagnostic> {
    let module = &validated.module;
    let point = &module.entry_points[index];
    let without = without_value(module);
    let needed = deciding_size(module, point);
    if let Some(missing) = needed.intersection(&without).next() {
        return Err(missing_value(shown_name(module, *missing), "the size of a workgroup"));
    }
    let made = module_of_defaults(validated, point, &without)?;
    let computed: BTreeMap<&str, Literal> = made
        .overrides
        .iter()
        .filter_map(|(_, one)| Some((one.name.as_deref()?, literal_of(&made, one.init?)?)))
        .collect();
    let is_known = |handle| with_named(module, Overrides::from([handle])).is_disjoint(&without);
    let values = module.overrides.iter().filter(|(handle, _)| is_known(*handle));
    let values = values
        .filter_map(|(handle, _)| Some((handle, *computed.get(number_name(handle).as_str())?)));
    let workgroup_size = match made.entry_points.first() {
        Some(made) if point.stage == ShaderStage::Compute => made.workgroup_size,
        _ => point.workgroup_size,
    };
    let values = values.collect();
    Ok((made, DefaultValues { values, workgroup_size }))
}

/// The overrides that have a value only if the host gives it.
fn without_value(module: &Module) -> Overrides {
    let all = module.overrides.iter().filter(|(_, one)| one.init.is_none());
    all.map(|(handle, _)| handle).collect()
}

/// The module of an entry point with the values of all overrides. Those without a value are 1: naga
/// computes nothing while one is missing.
fn module_of_defaults(
    validated: &Validated,
    point: &EntryPoint,
    without: &Overrides,
) -> Result<Module, Diagnostic> {
    let mut named = validated.module.clone();
    for (handle, found) in named.overrides.iter_mut() {
        (found.name, found.id) = (Some(number_name(handle)), None);
    }
    for (handle, found) in named.global_variables.iter_mut() {
        found.name = Some(variable_name(handle));
    }
    named.entry_points.retain(|one| one.stage == point.stage && one.name == point.name);
    compact(&mut named, KeepUnused::No);
    keep_names_only(&mut named);
    let is_there =
        |name: &String| named.overrides.iter().any(|(_, one)| one.name.as_ref() == Some(name));
    let names = without.iter().map(|handle| number_name(*handle)).filter(is_there);
    let assumed: PipelineConstants = names.map(|name| (name, 1.0)).collect();
    let entry = Some((ShaderStage::Compute, point.name.as_str()));
    let (made, _) = process_overrides(&named, &validated.info, entry, &assumed)
        .map_err(|error| Diagnostic::error(codes::EMIT_FAILED, reason(&error)))?;
    Ok(made.into_owned())
}

/// Leaves of entry points only that they need the overrides and variables. naga computes constants
/// of functions together with overrides, and makes a module that is not valid of some: an element
/// of a constant array is emitted once more.
fn keep_names_only(module: &mut Module) {
    let overrides = module.overrides.iter().map(|(handle, _)| Expression::Override(handle));
    keep_only(module, overrides.collect());
}

/// The same for the variables alone, and what their sizes need.
pub fn keep_variables_only(module: &mut Module) {
    keep_only(module, Vec::new());
}

/// Every stage is a compute stage then, since others must have results.
fn keep_only(module: &mut Module, mut needed: Vec<Expression>) {
    let variables = || module.global_variables.iter();
    needed.extend(variables().map(|(handle, _)| Expression::GlobalVariable(handle)));
    let mut kept = Function::default();
    for expression in needed {
        let value = kept.expressions.append(expression, Span::UNDEFINED);
        kept.named_expressions.insert(value, format!("lamplight_kept_{}", value.index()));
    }
    // A pointer to an immediate is only valid where it is read.
    for (handle, _) in variables().filter(|(_, one)| one.space == AddressSpace::Immediate) {
        let pointer = kept.expressions.append(Expression::GlobalVariable(handle), Span::UNDEFINED);
        let value = kept.expressions.append(Expression::Load { pointer }, Span::UNDEFINED);
        kept.body.push(Statement::Emit(Range::new_from_bounds(value, value)), Span::UNDEFINED);
    }
    for point in &mut module.entry_points {
        if point.stage != ShaderStage::Compute {
            (point.stage, point.workgroup_size) = (ShaderStage::Compute, [1; 3]);
        }
        point.function = kept.clone();
    }
    module.functions = Arena::new();
}

/// A name that leads back to the variable.
fn variable_name(handle: Handle<GlobalVariable>) -> String {
    format!("lamplight_variable_{}", handle.index())
}

/// Gives the variables whose initial values name overrides those values. `made` is the module that
/// naga computed them in.
fn put_initial_values(
    original: &Module,
    made: &Module,
    module: &mut Module,
) -> Result<(), Diagnostic> {
    let without = without_value(original);
    for (handle, variable) in original.global_variables.iter() {
        let mut named = Overrides::new();
        if let Some(init) = variable.init {
            collect_named(original, init, &mut named);
        }
        let named = with_named(original, named);
        if named.is_empty() {
            continue;
        }
        if let Some(missing) = named.intersection(&without).next() {
            let name = shown_name(original, *missing);
            return Err(missing_value(name, "the initial value of a variable"));
        }
        let name = variable_name(handle);
        // naga leaves out the variables that the entry point does not use.
        let found = made.global_variables.iter().find(|(_, one)| one.name.as_ref() == Some(&name));
        module.global_variables[handle].init = match found.and_then(|(_, one)| one.init) {
            Some(init) => Some(copied_value(made, init, module)?),
            None => None,
        };
    }
    Ok(())
}

/// A value of another module.
fn copied_value(
    made: &Module,
    value: Handle<Expression>,
    module: &mut Module,
) -> Result<Handle<Expression>, Diagnostic> {
    let copy = match &made.global_expressions[value] {
        Expression::Literal(literal) => Expression::Literal(*literal),
        Expression::Constant(constant) => {
            return copied_value(made, made.constants[*constant].init, module);
        }
        Expression::ZeroValue(ty) => Expression::ZeroValue(copied_type(made, *ty, module)?),
        Expression::Compose { ty, components } => {
            let ty = copied_type(made, *ty, module)?;
            let parts = components.iter().map(|part| copied_value(made, *part, module));
            Expression::Compose { ty, components: parts.collect::<Result<_, _>>()? }
        }
        Expression::Splat { size, value } => {
            Expression::Splat { size: *size, value: copied_value(made, *value, module)? }
        }
        _ => return Err(not_copied()),
    };
    Ok(module.global_expressions.append(copy, Span::UNDEFINED))
}

fn not_copied() -> Diagnostic {
    let message = "the initial value of a variable is computed from overrides in a way that is \
                   not known";
    Diagnostic::error(codes::EMIT_FAILED, message)
}

/// A type of another module, which differs from the own one in what it leaves out.
fn copied_type(
    made: &Module,
    ty: Handle<Type>,
    module: &mut Module,
) -> Result<Handle<Type>, Diagnostic> {
    let Type { name, inner } = &made.types[ty];
    let inner = match inner {
        TypeInner::Scalar(_)
        | TypeInner::Vector { size: _, scalar: _ }
        | TypeInner::Matrix { columns: _, rows: _, scalar: _ } => inner.clone(),
        TypeInner::Array { base, size, stride } => {
            let base = copied_type(made, *base, module)?;
            TypeInner::Array { base, size: *size, stride: *stride }
        }
        TypeInner::Struct { members, span } => {
            let copied = |member: &StructMember| {
                Ok(StructMember { ty: copied_type(made, member.ty, module)?, ..member.clone() })
            };
            let members = members.iter().map(copied).collect::<Result<_, Diagnostic>>()?;
            TypeInner::Struct { members, span: *span }
        }
        _ => return Err(not_copied()),
    };
    Ok(module.types.insert(Type { name: name.clone(), inner }, Span::UNDEFINED))
}

/// Why naga could not compute a size or a default.
fn reason(error: &PipelineConstantError) -> String {
    match error {
        PipelineConstantError::NegativeWorkgroupSize => {
            "the size of a workgroup, which an override decides, is below 1".to_owned()
        }
        PipelineConstantError::ValidationError(error) if is_empty_array(error.as_inner()) => {
            "the length of an array, which an override decides, is below 1".to_owned()
        }
        error => error.to_string(),
    }
}

fn is_empty_array(error: &ValidationError) -> bool {
    let ValidationError::Type { handle: _, name: _, source } = error else { return false };
    matches!(source, TypeError::InvalidArraySize(_))
}

/// A name that leads back to the override after naga has left some of them out.
fn number_name(handle: Handle<Override>) -> String {
    format!("lamplight_{}", handle.index())
}

/// The module of one entry point, in which the overrides that decide something are constants; `None`
/// where there are none.
///
/// # Errors
/// `override-without-value`, and those of [`default_values`].
pub fn with_constants(
    validated: &Validated,
    index: usize,
) -> Result<Option<(Module, ModuleInfo)>, Diagnostic> {
    match deciding(&validated.module).is_empty() {
        true => Ok(None),
        false => fixed_module(validated, index, deciding).map(Some),
    }
}

/// The module of one entry point, in which all overrides are constants.
///
/// # Errors
/// As those of [`with_constants`].
pub fn with_defaults(
    validated: &Validated,
    index: usize,
) -> Result<(Module, ModuleInfo), Diagnostic> {
    let all = |module: &Module| module.overrides.iter().map(|(handle, _)| handle).collect();
    let (module, info) = fixed_module(validated, index, all)?;
    let open = module.overrides.iter().map(|(handle, _)| handle).next();
    match open {
        None => Ok((module, info)),
        Some(handle) => Err(missing_value(shown_name(&module, handle), "an output")),
    }
}

/// What the entry point does not need is left out first: its lengths and defaults may have no value.
fn fixed_module(
    validated: &Validated,
    index: usize,
    chosen: impl Fn(&Module) -> Overrides,
) -> Result<(Module, ModuleInfo), Diagnostic> {
    let validated = &isolate::keep_entry(validated, index)?;
    let (made, defaults) = values_in(validated, 0)?;
    let DefaultValues { values, workgroup_size } = defaults;
    let mut module = validated.module.clone();
    let chosen = chosen(&module);
    let fixed: BTreeMap<Handle<Override>, Literal> =
        values.into_iter().filter(|(handle, _)| chosen.contains(handle)).collect();
    for (_, expression) in module.global_expressions.iter_mut() {
        put_literal(expression, &fixed);
    }
    for (_, function) in module.functions.iter_mut() {
        put_literals(function, &fixed);
    }
    for point in &mut module.entry_points {
        put_literals(&mut point.function, &fixed);
        (point.workgroup_size, point.workgroup_size_overrides) = (workgroup_size, None);
    }
    put_lengths(&mut module, &fixed)?;
    put_initial_values(&validated.module, &made, &mut module)?;
    // Whatever still names an override without a value keeps it, and the caller refuses it.
    for (handle, value) in &fixed {
        let init = Expression::Literal(*value);
        let init = module.global_expressions.append(init, Span::UNDEFINED);
        module.overrides[*handle].init = Some(init);
    }
    compact(&mut module, KeepUnused::No);
    let info = info_unchecked(&module).map_err(|error| {
        let message = format!("a module with constants for overrides is not valid: {error}");
        Diagnostic::error(codes::NAGA_INTERNAL, message)
    })?;
    Ok((module, info))
}

fn put_literals(function: &mut Function, fixed: &BTreeMap<Handle<Override>, Literal>) {
    let names_one = |(_, expression): (_, &Expression)| matches!(expression, Expression::Override(handle) if fixed.contains_key(handle));
    if function.expressions.iter().any(names_one) {
        function.expressions.iter_mut().for_each(|(_, expression)| put_literal(expression, fixed));
        compute_in_statements(function);
    }
}

fn put_literal(expression: &mut Expression, fixed: &BTreeMap<Handle<Override>, Literal>) {
    if let Expression::Override(handle) = expression
        && let Some(value) = fixed.get(handle)
    {
        *expression = Expression::Literal(*value);
    }
}

/// Gives arrays their lengths.
fn put_lengths(
    module: &mut Module,
    fixed: &BTreeMap<Handle<Override>, Literal>,
) -> Result<(), Diagnostic> {
    let pending: Vec<_> = module
        .types
        .iter()
        .filter_map(|(handle, ty)| Some((handle, pending_length(&ty.inner)?)))
        .collect();
    for (handle, length) in pending {
        let needed = deciding_length(module, length);
        let value = match fixed.get(&length) {
            Some(Literal::U32(value)) => std::num::NonZeroU32::new(*value),
            Some(Literal::I32(value)) => {
                u32::try_from(*value).ok().and_then(std::num::NonZeroU32::new)
            }
            _ => return Err(missing_value(shown_name(module, needed), "the length of an array")),
        };
        let value = value.ok_or_else(|| {
            let name = shown_name(module, needed);
            let message = format!("the length of an array, which `{name}` decides, is below 1");
            Diagnostic::error(codes::EMIT_FAILED, message)
        })?;
        let Type { mut name, mut inner } = module.types[handle].clone();
        if let TypeInner::Array { base: _, size, stride: _ }
        | TypeInner::BindingArray { base: _, size } = &mut inner
        {
            *size = ArraySize::Constant(value);
        }
        // The module may have the same type already, with a length that is written as a number.
        while module.types.get(&Type { name: name.clone(), inner: inner.clone() }).is_some() {
            name.get_or_insert_default().push_str("sized");
        }
        module.types.replace(handle, Type { name, inner });
    }
    Ok(())
}

/// The first override with a name that decides a length.
fn deciding_length(module: &Module, length: Handle<Override>) -> Handle<Override> {
    let all = with_named(module, Overrides::from([length]));
    all.into_iter().find(|handle| !is_length(&module.overrides[*handle])).unwrap_or(length)
}
