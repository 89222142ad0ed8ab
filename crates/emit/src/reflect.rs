//! Reflection of one entry point.

use naga::proc::Layouter;
use naga::valid::{FunctionInfo, GlobalUse};
use naga::{
    AddressSpace, GlobalVariable, Handle, ImageClass, Module, StorageAccess, Type, TypeInner,
};

use super::immediates;
use super::names::{builtin_name, interpolation_name, sampling_name, type_name};
use super::shapes::{is_filtering, shape_of, texture_shape};
use super::specialise;
use lamplight_bundle::{Binding, BindingKind, Member, Override, Pair, Place, Reflection, Varying};
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_validate::{Validated, guard};

/// What an engine must know of the entry point, whatever the target.
///
/// # Errors
/// `unknown-entry-point`; `emit-failed` for stages that no target of the crate has.
pub fn reflect(validated: &Validated, entry: &str) -> Result<Reflection, Diagnostic> {
    let index = super::find_target(validated, entry)?;
    guard("", || entry_point(validated, index)).and_then(|result| result)
}

fn entry_point(validated: &Validated, index: usize) -> Result<Reflection, Diagnostic> {
    let module = &validated.module;
    let point = &module.entry_points[index];
    let info = validated.info.get_entry_point(index);
    let stage = super::known_stage(point.stage).ok_or_else(|| {
        Diagnostic::error(
            codes::EMIT_FAILED,
            format!("`{}` has a stage that no target has", point.name),
        )
    })?;
    let defaults = specialise::default_values(validated, index)?;
    let mut layouter = Layouter::default();
    layouter
        .update(module.to_ctx())
        .map_err(|error| Diagnostic::error(codes::NAGA_INTERNAL, error.to_string()))?;
    Ok(Reflection {
        stage,
        workgroup_size: (point.stage == naga::ShaderStage::Compute)
            .then_some(defaults.workgroup_size),
        inputs: entry_inputs(module, &point.function),
        outputs: entry_outputs(module, &point.function),
        bindings: used_bindings(module, info, &layouter),
        pairs: texture_pairs(module, info),
        overrides: module
            .overrides
            .iter()
            .filter(|(_, constant)| !specialise::is_length(constant))
            .map(|(handle, constant)| override_of(module, constant, defaults.values.get(&handle)))
            .collect(),
    })
}

/// The inputs of an entry point: locations in order, then built-ins.
pub fn entry_inputs(module: &Module, function: &naga::Function) -> Vec<Varying> {
    let arguments = function.arguments.iter();
    sorted_varyings(
        arguments
            .flat_map(|argument| {
                bound_varyings(
                    module,
                    argument.name.as_deref(),
                    argument.ty,
                    argument.binding.as_ref(),
                )
            })
            .collect(),
    )
}

fn entry_outputs(module: &Module, function: &naga::Function) -> Vec<Varying> {
    let result = function.result.iter();
    sorted_varyings(
        result
            .flat_map(|result| bound_varyings(module, None, result.ty, result.binding.as_ref()))
            .collect(),
    )
}

/// Locations first, by number; then built-ins, by name.
fn sorted_varyings(mut varyings: Vec<Varying>) -> Vec<Varying> {
    varyings.sort_by_key(|varying| {
        let Varying { location, builtin, blend_src, .. } = varying;
        (location.is_none(), *location, *blend_src, builtin.clone())
    });
    varyings
}

/// A bound value, or the bound members of a struct.
fn bound_varyings(
    module: &Module,
    name: Option<&str>,
    ty: Handle<Type>,
    binding: Option<&naga::Binding>,
) -> Vec<Varying> {
    match (binding, &module.types[ty].inner) {
        (Some(binding), _) => vec![make_varying(module, name, ty, binding)],
        (None, TypeInner::Struct { members, span: _ }) => members
            .iter()
            .flat_map(|member| {
                bound_varyings(module, member.name.as_deref(), member.ty, member.binding.as_ref())
            })
            .collect(),
        _ => Vec::new(),
    }
}

fn make_varying(
    module: &Module,
    name: Option<&str>,
    ty: Handle<Type>,
    binding: &naga::Binding,
) -> Varying {
    let blank = Varying {
        name: name.map(str::to_owned),
        location: None,
        builtin: None,
        ty: type_name(module, ty),
        shape: shape_of(module, ty),
        interpolation: None,
        sampling: None,
        blend_src: None,
    };
    match *binding {
        naga::Binding::BuiltIn(builtin) => {
            Varying { builtin: Some(builtin_name(builtin)), ..blank }
        }
        naga::Binding::Location {
            location,
            interpolation,
            sampling,
            blend_src,
            per_primitive: _,
        } => Varying {
            location: Some(location),
            interpolation: interpolation.map(interpolation_name),
            sampling: sampling.map(sampling_name),
            blend_src,
            ..blank
        },
    }
}

fn used_bindings(module: &Module, info: &FunctionInfo, layouter: &Layouter) -> Vec<Binding> {
    let is_filtered = |image| {
        let mut keys = info.sampling_set.iter();
        keys.any(|key| key.image == image && is_filtering(module, key.sampler))
    };
    let mut found: Vec<Binding> = used_globals(module, info)
        .filter_map(|(handle, variable)| {
            make_binding(module, (info[handle], is_filtered(handle)), variable, layouter)
        })
        .collect();
    found.sort_by_key(|binding| (binding.group, binding.binding));
    found
}

/// Globals the entry point uses, itself or through the functions it calls.
pub(super) fn used_globals<'a>(
    module: &'a Module,
    info: &'a FunctionInfo,
) -> impl Iterator<Item = (Handle<GlobalVariable>, &'a GlobalVariable)> + use<'a> {
    module.global_variables.iter().filter(|(handle, _)| !info[*handle].is_empty())
}

fn make_binding(
    module: &Module,
    (usage, is_filtered): (GlobalUse, bool),
    variable: &GlobalVariable,
    layouter: &Layouter,
) -> Option<Binding> {
    let place = immediates::place(variable)?;
    let kind = binding_kind(module, variable)?;
    let element = element_type(module, variable.ty);
    let ty = &module.types[element];
    let is_buffer = kind.is_buffer();
    Some(Binding {
        group: place.group,
        binding: place.binding,
        // A GLSL block without an instance name is known by the block's name.
        name: variable.name.clone().or_else(|| ty.name.clone()).unwrap_or_default(),
        kind,
        ty: type_name(module, variable.ty),
        count: binding_count(module, variable.ty),
        size: is_buffer.then(|| layouter[element].size),
        writable: usage.contains(GlobalUse::WRITE) || is_declared_writable(module, variable),
        shape: if is_buffer { shape_of(module, element) } else { None },
        texture: texture_shape(module, element, is_filtered),
        members: if is_buffer { struct_members(module, element, layouter) } else { Vec::new() },
    })
}

/// Whether a buffer or a storage texture is declared as one that may be written. Layouts of WebGPU need
/// that, whatever the entry point does with it.
fn is_declared_writable(module: &Module, variable: &GlobalVariable) -> bool {
    let access = match (variable.space, &module.types[element_type(module, variable.ty)].inner) {
        (AddressSpace::Storage { access }, _) => access,
        (
            _,
            TypeInner::Image {
                class: ImageClass::Storage { access, format: _ },
                dim: _,
                arrayed: _,
            },
        ) => *access,
        _ => return false,
    };
    access.contains(StorageAccess::STORE)
}

/// The type of what is bound, of one element where it is an array of bindings.
fn element_type(module: &Module, ty: Handle<Type>) -> Handle<Type> {
    match module.types[ty].inner {
        TypeInner::BindingArray { base, size: _ } => base,
        _ => ty,
    }
}

/// The number of bindings of an array of them; 0 if the host decides it.
pub(super) fn binding_count(module: &Module, ty: Handle<Type>) -> Option<u32> {
    match module.types[ty].inner {
        TypeInner::BindingArray { base: _, size } => Some(match size {
            naga::ArraySize::Constant(size) => size.get(),
            naga::ArraySize::Pending(_) | naga::ArraySize::Dynamic => 0,
        }),
        _ => None,
    }
}

pub(super) fn binding_kind(module: &Module, variable: &GlobalVariable) -> Option<BindingKind> {
    match (variable.space, &module.types[element_type(module, variable.ty)].inner) {
        (AddressSpace::Uniform, _) => Some(BindingKind::Uniform),
        (AddressSpace::Storage { access: _ }, _) => Some(BindingKind::Storage),
        (AddressSpace::Immediate, _) => Some(BindingKind::Immediate),
        (_, TypeInner::Sampler { comparison: true }) => Some(BindingKind::ComparisonSampler),
        (_, TypeInner::Sampler { comparison: false }) => Some(BindingKind::Sampler),
        (_, TypeInner::Image { class: ImageClass::Storage { format: _, access: _ }, .. }) => {
            Some(BindingKind::StorageTexture)
        }
        (_, TypeInner::Image { dim: _, arrayed: _, class: _ }) => Some(BindingKind::Texture),
        _ => None,
    }
}

/// Members of a struct, or of the elements of an array of structs.
fn struct_members(module: &Module, ty: Handle<Type>, layouter: &Layouter) -> Vec<Member> {
    match &module.types[ty].inner {
        TypeInner::Struct { members, span: _ } => {
            members.iter().map(|member| self::make_member(module, member, layouter)).collect()
        }
        TypeInner::Array { base, size: _, stride: _ } => {
            self::struct_members(module, *base, layouter)
        }
        _ => Vec::new(),
    }
}

fn make_member(module: &Module, member: &naga::StructMember, layouter: &Layouter) -> Member {
    let stride = match module.types[member.ty].inner {
        TypeInner::Array { stride, base: _, size: _ } => Some(stride),
        _ => None,
    };
    Member {
        name: member.name.clone().unwrap_or_default(),
        ty: type_name(module, member.ty),
        offset: member.offset,
        size: layouter[member.ty].size,
        stride,
        shape: shape_of(module, member.ty),
        members: struct_members(module, member.ty, layouter),
    }
}

/// The group and binding of a global that has them.
pub(super) fn place_of(module: &Module, handle: Handle<GlobalVariable>) -> Option<Place> {
    module.global_variables[handle].binding.map(|binding| [binding.group, binding.binding])
}

fn texture_pairs(module: &Module, info: &FunctionInfo) -> Vec<Pair> {
    let keys = info.sampling_set.iter();
    let mut pairs: Vec<Pair> = keys
        .filter_map(|key| {
            Some(Pair {
                texture: place_of(module, key.image)?,
                sampler: place_of(module, key.sampler)?,
            })
        })
        .collect();
    pairs.sort();
    pairs
}

fn override_of(
    module: &Module,
    constant: &naga::Override,
    default: Option<&naga::Literal>,
) -> Override {
    let naga::Override { name, id, ty, init: _ } = constant;
    Override {
        name: name.clone(),
        id: *id,
        ty: type_name(module, *ty),
        default: default.and_then(|default| literal_text(*default)),
    }
}

fn literal_text(literal: naga::Literal) -> Option<String> {
    Some(match literal {
        naga::Literal::F32(value) => format!("{value:?}"),
        naga::Literal::U32(value) => value.to_string(),
        naga::Literal::I32(value) => value.to_string(),
        naga::Literal::Bool(value) => value.to_string(),
        _ => return None,
    })
}
