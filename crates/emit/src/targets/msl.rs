//! Metal Shading Language 2.0.
//!
//! Buffers, textures and samplers each count from 0 in the order of group and binding, over what
//! the entry point uses; each stage has its own tables. Put vertex buffers above the uniforms.

use std::collections::BTreeMap;

use naga::valid::Capabilities;
use naga::back::msl::{
    BindSamplerTarget, BindTarget, EntryPointResources, Options, PipelineOptions, Writer,
};

use crate::names::first_entry_name;
use crate::slots::{Numbering, UsedBinding, assign_slots, native_reflection};
use crate::text::BoundedText;
use crate::{EmitSource, Emitted, Overrides, TargetEntry, ValidatorRules, clip, ends, fractions, gradients, invariants, packed, plain, rename};
use crate::plain::Needs;
use lamplight_validate::BINDING_ARRAYS;
use lamplight_bundle::{BindingKind, BufferSizes, Target};

/// The target, for the table of all.
pub const TARGET: TargetEntry = TargetEntry {
    target: Target::MSL,
    extension: "metal",
    binary: false,
    about: "Metal Shading Language 2.0 (macOS 10.13, iOS 11)",
    glsl: None,
    capabilities: Capabilities::SHADER_FLOAT16
        .union(Capabilities::CLIP_DISTANCES)
        .union(Capabilities::DUAL_SOURCE_BLENDING)
        .union(Capabilities::STORAGE_TEXTURE_16BIT_NORM_FORMATS)
        .union(BINDING_ARRAYS),
    header: &["#", "using "],
    overrides: Overrides::FunctionConstants,
    immediates: false,
    validation: ValidatorRules { validator: "clang", rules: &[] },
    clip: &clip::SHARED,
    write,
};

/// Metal does not know the length of a buffer, so naga reads it from a buffer of lengths. Here that
/// is the last of the 31.
const SIZES_BUFFER: u8 = 30;

fn write(source: &EmitSource<'_>) -> Result<Emitted, String> {
    let counted = ends::with_counters(source)?;
    let source = &source.with_analysed(counted.as_ref());
    let plainer = invariants::without_invariant_inputs(source.module, source.stage);
    let source = &EmitSource { module: plainer.as_ref().unwrap_or(source.module), ..*source };
    let needs = Needs {
        enclosed_bytes: true,
        unpacked_choices: true,
        masked_shifts: true,
        ..Needs::default()
    };
    let plain = plain::with_plain_forms(source.module, source.info, needs)?;
    let source = &source.with_analysed(plain.as_ref());
    let options = Options {
        lang_version: (2, 0),
        per_entry_point_map: BTreeMap::from([(source.entry.to_owned(), entry_resources(source)?)]),
        fake_missing_bindings: false,
        bounds_check_policies: source.bounds_policies(),
        force_loop_bounding: false,
        ..Options::default()
    };
    let pipeline = PipelineOptions {
        entry_point: Some((source.stage, source.entry.to_owned())),
        ..PipelineOptions::default()
    };
    let packed = packed::with_packed_vectors(source.module)?;
    let (module, info) =
        packed.as_ref().map_or((source.module, source.info), |(module, info)| (module, info));
    let unlike = rename::rename_types_like_members(module);
    let module = unlike.as_ref().unwrap_or(module);
    let mut text = BoundedText::default();
    let written = Writer::new(&mut text).write(module, info, &options, &pipeline);
    let info = written.map_err(|error| text.explain(error))?;
    let text = with_commas(&fractions::with_halves(&gradients::with_dimensions(&text.0)));
    let name = first_entry_name(info.entry_point_names)?;
    let mut native = native_reflection(source, &name, Numbering::PerKind);
    native.buffer_sizes = buffer_sizes(source, &text);
    Ok(Emitted { bytes: text.into_bytes(), native })
}

/// The text with a comma between the attributes of a source for blending, as the specification of
/// the language has it.
fn with_commas(text: &str) -> String {
    let one = |line: &str| match line.contains(" [[color(") {
        true => line.replace(") index(", "), index("),
        false => line.to_owned(),
    };
    text.split_inclusive('\n').map(one).collect()
}

/// The argument with sizes of buffers, if naga gave the entry point one. It has a member for each
/// buffer of the module that needs one, named after the index of its variable in the module.
fn buffer_sizes(source: &EmitSource<'_>, text: &str) -> Option<BufferSizes> {
    let argument = format!("[[buffer({SIZES_BUFFER})]]");
    text.lines().find(|line| line.contains("_mslBufferSizes&") && line.contains(&argument))?;
    let (_, members) = text.split_once("struct _mslBufferSizes {")?;
    let (members, _) = members.split_once('}')?;
    let place = |member: &str| {
        let number: usize = member.trim().strip_prefix("uint size")?.parse().ok()?;
        let (_, variable) = source.module.global_variables.iter().nth(number)?;
        variable.binding.map(|binding| [binding.group, binding.binding])
    };
    Some(BufferSizes {
        index: SIZES_BUFFER.into(),
        buffers: members.split(';').filter_map(place).collect(),
    })
}

fn entry_resources(source: &EmitSource<'_>) -> Result<EntryPointResources, String> {
    let mut resources = EntryPointResources::default();
    for (used, index) in assign_slots(source, Numbering::PerKind) {
        let slot = index
            .and_then(|index| u8::try_from(index).ok())
            .ok_or("more bindings than Metal has slots")?;
        resources.resources.insert(used.place, bind_target(used, slot));
    }
    resources.sizes_buffer = Some(SIZES_BUFFER);
    Ok(resources)
}

fn bind_target(used: UsedBinding, slot: u8) -> BindTarget {
    let mutable = matches!(used.kind, BindingKind::Storage | BindingKind::StorageTexture);
    match used.kind {
        // An argument buffer has the elements.
        _ if used.count.is_some() => {
            BindTarget { buffer: Some(slot), mutable, ..BindTarget::default() }
        }
        BindingKind::Uniform | BindingKind::Immediate => BindTarget { buffer: Some(slot), ..BindTarget::default() },
        BindingKind::Storage => {
            BindTarget { buffer: Some(slot), mutable: true, ..BindTarget::default() }
        }
        BindingKind::Texture => BindTarget { texture: Some(slot), ..BindTarget::default() },
        BindingKind::StorageTexture => {
            BindTarget { texture: Some(slot), mutable: true, ..BindTarget::default() }
        }
        BindingKind::Sampler | BindingKind::ComparisonSampler => {
            BindTarget { sampler: Some(BindSamplerTarget::Resource(slot)), ..BindTarget::default() }
        }
    }
}
