//! Reads WGSL with naga's front end.

use naga::back::PipelineConstants;
use naga::back::pipeline_constants::process_overrides;
use naga::valid::ModuleInfo;
use naga::{
    AddressSpace, ArraySize, GlobalVariable, Handle, ImageClass, ImageDimension, Module, Override,
    Scalar, ScalarKind, ShaderStage, Type, TypeInner, VectorSize,
};

use lamplight_bundle::{Binding, BindingKind, BindingSlot, Stage, Varying};
use lamplight_emit::{keep_variables_only, reflect};
use lamplight_validate::{Validated, guard, info_for_some, info_unchecked, parse_wgsl};

use super::compare::{Differences, SlotRules, compare_reading};
use super::described::Described;
use super::reading::{MOST_LEVELS, ReadBinding, ReadMember, ReadType, Reading};
use super::unread;

/// What differs between a text and what a bundle says of it.
pub fn text_differences(text: &str, described: Described<'_>) -> Result<Vec<String>, String> {
    let read = || {
        let module = parse_wgsl(text).map_err(|error| error.emit_to_string(text))?;
        let info = info_for_some(&module).map_err(|error| error.emit_to_string(text))?;
        Ok(module_differences(module, info, described))
    };
    guard(text, read).map_err(|error| error.message)?
}

/// The same for a text that naga has read.
pub fn module_differences(
    module: Module,
    info: ModuleInfo,
    described: Described<'_>,
) -> Vec<String> {
    compare_module(module, info, described).unwrap_or_else(|reason| vec![unread(&reason)])
}

fn compare_module(
    module: Module,
    info: ModuleInfo,
    described: Described<'_>,
) -> Result<Vec<String>, String> {
    let reading = read_module(&module, &info)?;
    let is_at = |_: &Binding, slot: &BindingSlot, found: &ReadBinding| {
        (slot.space, slot.index) == (found.space, found.index)
    };
    let mut differences =
        compare_reading(&reading, described, &SlotRules { is_at, leaves_out: false });
    let validated = Validated { module, info, portable: true };
    differences.extend(interface_differences(&validated, described)?);
    Ok(differences)
}

/// What enters and leaves the stage, and which textures are sampled with which samplers. Only this is
/// compared by the function that makes reflections.
fn interface_differences(
    validated: &Validated,
    described: Described<'_>,
) -> Result<Vec<String>, String> {
    let Some(point) = validated.module.entry_points.first() else { return Ok(Vec::new()) };
    let found = reflect(validated, &point.name).map_err(|error| error.message)?;
    let mut differences = Differences::default();
    // Writers rename arguments, and number structures anew.
    let unnamed = |varyings: &[Varying]| -> Vec<Varying> {
        varyings
            .iter()
            .map(|one| Varying {
                name: None,
                ty: String::new(),
                sampling: written_sampling(one),
                ..one.clone()
            })
            .collect()
    };
    let reflected = described.reflection;
    differences.same("the inputs are", &unnamed(&found.inputs), &unnamed(&reflected.inputs));
    differences.same("the outputs are", &unnamed(&found.outputs), &unnamed(&reflected.outputs));
    differences.same("the pairs are", &found.pairs, &reflected.pairs);
    for reflected in &reflected.bindings {
        let place = (reflected.group, reflected.binding);
        let mut same = found.bindings.iter().filter(|one| (one.group, one.binding) == place);
        // `compare_reading` notes what one of both does not have.
        let Some(found) = same.next() else { continue };
        let what = format!("the texture `{}` is", reflected.name);
        differences.same(&what, &found.texture, &reflected.texture);
        differences.same(
            &format!("whether `{}` is written is", reflected.name),
            &found.writable,
            &reflected.writable,
        );
        differences.same(
            &format!("the kind of `{}` is", reflected.name),
            &found.kind,
            &reflected.kind,
        );
    }
    Ok(differences.0)
}

/// Where a varying is sampled. The centre need not be written.
fn written_sampling(varying: &Varying) -> Option<String> {
    let is_default = varying.interpolation.as_deref().is_some_and(|name| name != "flat");
    varying.sampling.clone().or_else(|| is_default.then(|| "center".to_owned()))
}

fn read_module(module: &Module, info: &ModuleInfo) -> Result<Reading, String> {
    let [point] = module.entry_points.as_slice() else {
        return Err(format!("it has {} entry points", module.entry_points.len()));
    };
    let stage = match point.stage {
        ShaderStage::Vertex => Stage::Vertex,
        ShaderStage::Fragment => Stage::Fragment,
        ShaderStage::Compute => Stage::Compute,
        _ => return Err("its stage is none of a bundle's".to_owned()),
    };
    let fixed = with_sizes(module, &point.name)?;
    let size = fixed.entry_points.first().map(|point| point.workgroup_size);
    // A text may have a function that its entry point does not call, and what only that one binds.
    let used = info.get_entry_point(0);
    let is_used = |one: &GlobalVariable| {
        let is_it =
            |other: &GlobalVariable| (other.binding, other.space) == (one.binding, one.space);
        let same = module.global_variables.iter().filter(|(_, other)| is_it(other));
        same.into_iter().any(|(handle, _)| !used[handle].is_empty())
    };
    let bound = fixed.global_variables.iter().filter(|(_, one)| is_used(one));
    let bindings = bound.map(|(_, one)| read_global(&fixed, one));
    Ok(Reading {
        entry: Some(point.name.clone()),
        stage: Some(stage),
        workgroup_size: size.filter(|_| stage == Stage::Compute),
        bindings: bindings.collect::<Result<Vec<_>, String>>()?.into_iter().flatten().collect(),
    })
}

/// The declarations of a module with numbers for the overrides in sizes. What functions compute from
/// overrides has no part in that.
fn with_sizes(module: &Module, entry: &str) -> Result<Module, String> {
    let mut bare = module.clone();
    keep_variables_only(&mut bare);
    let info = info_unchecked(&bare).map_err(|error| error.to_string())?;
    let chosen = Some((ShaderStage::Compute, entry));
    let (fixed, _) = process_overrides(&bare, &info, chosen, &assumed_values(module))
        .map_err(|error| error.to_string())?;
    Ok(fixed.into_owned())
}

/// Values for the overrides that have none: naga computes nothing while one is missing.
fn assumed_values(module: &Module) -> PipelineConstants {
    let open = module.overrides.iter().filter(|(_, one)| one.init.is_none());
    let key = |one: &Override| match (one.id, &one.name) {
        (Some(id), _) => id.to_string(),
        (None, name) => name.clone().unwrap_or_default(),
    };
    open.map(|(_, one)| (key(one), 1.0)).collect()
}

fn read_global(module: &Module, variable: &GlobalVariable) -> Result<Option<ReadBinding>, String> {
    let GlobalVariable { name, space, binding, ty, init: _, memory_decorations: _ } = variable;
    if binding.is_none() && *space != AddressSpace::Immediate {
        return Ok(None);
    }
    let (bound, count) = match module.types[*ty].inner {
        TypeInner::BindingArray { base, size } => (base, Some(array_count(size))),
        _ => (*ty, None),
    };
    let is_buffer = matches!(
        space,
        AddressSpace::Uniform | AddressSpace::Immediate | AddressSpace::Storage { access: _ }
    );
    let ty = is_buffer.then(|| read_type(module, bound, MOST_LEVELS)).transpose()?;
    let (kind, dimension) = read_kind(module, *space, bound);
    Ok(Some(ReadBinding {
        space: binding.map(|place| place.group),
        index: binding.map(|place| place.binding),
        register: None,
        name: name.clone(),
        kind,
        count,
        ty,
        dimension,
    }))
}

fn read_kind(
    module: &Module,
    space: AddressSpace,
    bound: Handle<Type>,
) -> (Option<BindingKind>, Option<String>) {
    match (space, &module.types[bound].inner) {
        (AddressSpace::Uniform, _) => (Some(BindingKind::Uniform), None),
        (AddressSpace::Immediate, _) => (Some(BindingKind::Immediate), None),
        (AddressSpace::Storage { access: _ }, _) => (Some(BindingKind::Storage), None),
        (_, TypeInner::Sampler { comparison: false }) => (Some(BindingKind::Sampler), None),
        (_, TypeInner::Sampler { comparison: true }) => {
            (Some(BindingKind::ComparisonSampler), None)
        }
        (_, TypeInner::Image { dim, arrayed, class }) => {
            let kind = match class {
                ImageClass::Storage { format: _, access: _ } => BindingKind::StorageTexture,
                ImageClass::Sampled { kind: _, multi: _ }
                | ImageClass::Depth { multi: _ }
                | ImageClass::External => BindingKind::Texture,
            };
            let name = match dim {
                ImageDimension::D1 => "1d",
                ImageDimension::D2 => "2d",
                ImageDimension::D3 => "3d",
                ImageDimension::Cube => "cube",
            };
            let array = if *arrayed { "_array" } else { "" };
            (Some(kind), Some(format!("{name}{array}")))
        }
        _ => (None, None),
    }
}

fn array_count(size: ArraySize) -> u32 {
    match size {
        ArraySize::Constant(count) => count.get(),
        ArraySize::Pending(_) | ArraySize::Dynamic => 0,
    }
}

fn read_type(module: &Module, ty: Handle<Type>, levels: usize) -> Result<ReadType, String> {
    let levels = levels.checked_sub(1).ok_or("its types are nested too deep")?;
    match &module.types[ty].inner {
        TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) => number(*scalar, None, None),
        TypeInner::Vector { size, scalar } => number(*scalar, Some(*size), None),
        TypeInner::Matrix { columns, rows, scalar } => number(*scalar, Some(*rows), Some(*columns)),
        TypeInner::Array { base, size, stride } => Ok(ReadType::Array {
            element: Box::new(read_type(module, *base, levels)?),
            count: array_count(*size),
            stride: Some(*stride),
        }),
        TypeInner::Struct { members, span } => {
            let member = |member: &naga::StructMember| {
                let naga::StructMember { name: _, ty, binding: _, offset } = member;
                let ty = read_type(module, *ty, levels)?;
                Ok(ReadMember { offset: Some(*offset), ty })
            };
            let members = members.iter().map(member).collect::<Result<_, String>>()?;
            Ok(ReadType::Struct { members, size: Some(*span) })
        }
        other => Err(format!("a buffer holds {other:?}")),
    }
}

/// WGSL's table of alignments: a column of three takes the room of four.
fn number(
    scalar: Scalar,
    rows: Option<VectorSize>,
    columns: Option<VectorSize>,
) -> Result<ReadType, String> {
    let Scalar { kind, width } = scalar;
    let letter = match kind {
        ScalarKind::Float => "f",
        ScalarKind::Sint => "i",
        ScalarKind::Uint => "u",
        ScalarKind::Bool | ScalarKind::AbstractInt | ScalarKind::AbstractFloat => {
            return Err(format!("a buffer holds {kind:?}"));
        }
    };
    let width = u32::from(width);
    let room = rows.map_or(1, |rows| (rows as u32).next_power_of_two());
    Ok(ReadType::Number {
        scalar: format!("{letter}{}", width * 8),
        width,
        rows: rows.map(|rows| rows as u32),
        columns: columns.map(|columns| (columns as u32, Some(width * room))),
    })
}
