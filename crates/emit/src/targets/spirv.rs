//! SPIR-V 1.0, for every version of Vulkan.
//!
//! Descriptor set and binding are the author's group and binding. Names are kept for debuggers;
//! no source text and no path is. Loops and indices are as written, unless
//! [`BoundsChecks::Restrict`](lamplight_bundle::BoundsChecks) is asked for.

use naga::valid::Capabilities;
use naga::back::spv::{Options, PipelineOptions, WriterFlags, write_vec};

use crate::slots::{Numbering, native_reflection};
use crate::spirv::{HEADER_WORDS, SpirvInstruction, bytes, instructions, op};
use crate::plain::{self, Needs};
use crate::{EmitSource, Emitted, Overrides, TargetEntry, ValidatorRules, clip, descriptors, ends, lacks, sample_mask, short_storage, workgroups};
use lamplight_validate::BINDING_ARRAYS;
use lamplight_bundle::Target;

/// The target, for the table of all.
pub const TARGET: TargetEntry = TargetEntry {
    target: Target::SPIRV,
    extension: "spv",
    binary: true,
    about: "SPIR-V 1.0 (Vulkan 1.0), little-endian words",
    glsl: None,
    capabilities: Capabilities::SHADER_FLOAT16
        .union(Capabilities::FLOAT64)
        .union(Capabilities::SHADER_INT64)
        .union(Capabilities::CLIP_DISTANCES)
        .union(Capabilities::DUAL_SOURCE_BLENDING)
        .union(Capabilities::PRIMITIVE_INDEX)
        .union(Capabilities::STORAGE_TEXTURE_16BIT_NORM_FORMATS)
        .union(BINDING_ARRAYS),
    header: &[],
    overrides: Overrides::Specialised,
    immediates: true,
    validation: ValidatorRules { validator: "spirv_val", rules: &["vulkan1.0", "vulkan1.1"] },
    clip: &clip::VULKAN,
    write,
};

fn write(source: &EmitSource<'_>) -> Result<Emitted, String> {
    if let Some(reason) = lacks::spirv_lack(source.module) {
        return Err(reason);
    }
    let counted = ends::with_counters(source)?;
    let source = &source.with_analysed(counted.as_ref());
    let needs = Needs { masked_shifts: true, ..Needs::default() };
    let plain = plain::with_plain_forms(source.module, source.info, needs)?;
    let source = &source.with_analysed(plain.as_ref());
    let options = Options {
        lang_version: (1, 0),
        flags: WriterFlags::DEBUG | WriterFlags::LABEL_VARYINGS,
        bounds_check_policies: source.bounds_policies(),
        force_loop_bounding: false,
        ..Options::default()
    };
    let pipeline =
        PipelineOptions { shader_stage: source.stage, entry_point: source.entry.to_owned() };
    let words = write_vec(source.module, source.info, &options, Some(&pipeline))
        .map_err(|error| error.to_string())?;
    let words = sample_mask::with_storage_queries(&order_variables(&words));
    let words = short_storage::with_extension(descriptors::with_capabilities(&words));
    let words = workgroups::without_layouts(&sample_mask::as_arrays(&words)?)?;
    let bytes = bytes(&words);
    Ok(Emitted { bytes, native: native_reflection(source, source.entry, Numbering::Author) })
}

/// The module with the variables of each function in the order of their ids, which is the author's.
/// naga writes them in the order of a hash map, which differs between processors.
fn order_variables(words: &[u32]) -> Vec<u32> {
    const FUNCTION: u32 = 7;
    let is_local = |found: &SpirvInstruction<'_>| {
        found.op == op::VARIABLE && found.words.get(3) == Some(&FUNCTION)
    };
    let mut made = words.get(..HEADER_WORDS).unwrap_or_default().to_vec();
    let mut run: Vec<&[u32]> = Vec::new();
    // The `None` stands for the end, so that the last run is written too.
    for instruction in instructions(words).map(Some).chain([None]) {
        if let Some(local) = instruction.filter(is_local) {
            run.push(local.words);
            continue;
        }
        run.sort_by_key(|variable| variable[2]);
        made.extend(run.drain(..).flatten());
        made.extend(instruction.map_or(&[][..], |instruction| instruction.words));
    }
    made
}
