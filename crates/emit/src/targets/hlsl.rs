//! HLSL of shader model 5.1, for Direct3D 12 (`fxc`, and `dxc` with 6.0 profiles).
//!
//! Registers: `space` is the author's group, the register number the author's binding, for
//! buffers and textures. Samplers follow naga's heap scheme: all live in one descriptor heap,
//! bound as `nagaSamplerHeap` (`s0, space0`) and `nagaComparisonSamplerHeap` (`s0, space1`); the
//! buffer `nagaGroupNSamplerIndexArray` (`tN, space255`) holds at `[binding]` the heap index of
//! the sampler of group N with that binding. Vertex attributes have the semantic `LOC` with the
//! author's location. All of it is in [`Native`].

use naga::valid::Capabilities;
use naga::back::hlsl::{
    BindTarget, Options, PipelineOptions, SamplerHeapBindTargets, SamplerIndexBufferKey,
    ShaderModel, Writer,
};

use crate::names::first_entry_name;
use crate::plain::{self, Needs};
use crate::reflect::{binding_kind, entry_inputs};
use crate::slots::{Numbering, UsedBinding, assign_slots, native_reflection};
use crate::text::BoundedText;
use crate::{EmitSource, Emitted, Overrides, TargetEntry, ValidatorRules, clip, ends, setters, zeros};
use crate::{columns, lacks, lists, located, rename, rows};
use lamplight_bundle::{BindingKind, HeapSampler, Native, Place, SamplerHeap, Semantic, Target};

/// The target, for the table of all.
pub const TARGET: TargetEntry = TargetEntry {
    target: Target::HLSL,
    extension: "hlsl",
    binary: false,
    about: "HLSL, shader model 5.1 (Direct3D 12)",
    glsl: None,
    capabilities: Capabilities::DUAL_SOURCE_BLENDING
        .union(Capabilities::PRIMITIVE_INDEX)
        .union(Capabilities::STORAGE_TEXTURE_16BIT_NORM_FORMATS)
        .union(TEXTURE_ARRAYS),
    header: &[],
    overrides: Overrides::Macros,
    immediates: false,
    validation: ValidatorRules { validator: "glslang", rules: &["hlsl"] },
    clip: &clip::SHARED,
    write,
};

/// Arrays of textures. naga does not write those of buffers, and it writes the clip distances of a
/// vertex as one number.
const TEXTURE_ARRAYS: Capabilities = Capabilities::TEXTURE_AND_SAMPLER_BINDING_ARRAY
    .union(Capabilities::TEXTURE_AND_SAMPLER_BINDING_ARRAY_NON_UNIFORM_INDEXING)
    .union(Capabilities::STORAGE_TEXTURE_BINDING_ARRAY)
    .union(Capabilities::STORAGE_TEXTURE_BINDING_ARRAY_NON_UNIFORM_INDEXING);

/// Elements of each heap, as naga declares them.
const HEAP_SIZE: u32 = 2048;
/// A size that stands for none while naga writes: it fails on an array of bindings without a size,
/// which the language has.
const UNBOUNDED: u32 = 1_999_999_973;
/// Register space of the buffers with places in the heaps; the register is the group.
const INDEX_SPACE: u8 = u8::MAX;

/// The heaps: name in the output, and the kind of sampler.
const HEAPS: [(&str, BindingKind); 2] = [
    ("nagaSamplerHeap", BindingKind::Sampler),
    ("nagaComparisonSamplerHeap", BindingKind::ComparisonSampler),
];

/// Reserved words of HLSL that naga does not avoid.
const WORDS: &[&str] = &[
    "SubpassInput",
    "SubpassInputMS",
    "layout",
    "sampler1D",
    "sampler2D",
    "sampler3D",
    "samplerCUBE",
];

/// How names begin that naga gives to functions and types of its own, and does not avoid. It does
/// avoid `naga_`.
const PREFIXES: &[&str] = &[
    "Construct",
    "GetMat",
    "Naga",
    "SetMat",
    "ZeroValue",
    "nagaComparison",
    "nagaGroup",
    "nagaSampler",
    "ret_",
];

fn is_taken(name: &str) -> bool {
    WORDS.contains(&name) || PREFIXES.iter().any(|prefix| name.starts_with(prefix))
}

fn write(source: &EmitSource<'_>) -> Result<Emitted, String> {
    if columns::taken_from_values(source.module, source.info).next().is_some() {
        return Err(columns::TAKEN.to_owned());
    }
    if !located::lost_gaps(source.module).is_empty() {
        return Err(located::LOCATED.to_owned());
    }
    if lacks::counts_groups(source.module) {
        return Err(lacks::GROUP_COUNT.to_owned());
    }
    // naga computes these without the lower bound of the result.
    let needs = Needs {
        clamped_bytes: true,
        clamped_words: true,
        enclosed_bytes: true,
        masked_shifts: true,
        ..Needs::default()
    };
    let counted = ends::with_counters(source)?;
    let source = &source.with_analysed(counted.as_ref());
    let plain = plain::with_plain_forms(source.module, source.info, needs)?;
    let source = &source.with_analysed(plain.as_ref());
    let options = writer_options(source)?;
    let unlike = rename::rename_types_like_members(source.module);
    let module = unlike.as_ref().unwrap_or(source.module);
    let changed = rename::rename_taken(module, &is_taken);
    let module = changed.as_ref().unwrap_or(module);
    let entry = module.entry_points.get(source.index).ok_or("there is no entry point")?;
    let pipeline = PipelineOptions { entry_point: Some((source.stage, entry.name.clone())) };
    let mut text = BoundedText::default();
    let written = Writer::new(&mut text, &options, &pipeline).write(module, source.info, None);
    let info = written.map_err(|error| text.explain(error))?;
    let name = first_entry_name(info.entry_point_names)?;
    let text = setters::by_reference(&lists::with_plain_constants(&text.0));
    let text = columns::without_casts(&zeros::without_casts(&text));
    let text = zeros::with_float_zeros(&text);
    let text = rows::with_major_rows(&setters::without_undeclared(&text));
    let text = text.replace(&format!("[{UNBOUNDED}] : register"), "[] : register");
    Ok(Emitted { bytes: text.into_bytes(), native: hlsl_reflection(source, &name, &options) })
}

fn writer_options(source: &EmitSource<'_>) -> Result<Options, String> {
    let mut options = Options {
        shader_model: ShaderModel::V5_1,
        fake_missing_bindings: false,
        restrict_indexing: source.is_restricted(),
        force_loop_bounding: false,
        ..Options::default()
    };
    for (UsedBinding { place: binding, kind, count }, _) in assign_slots(source, Numbering::Author) {
        let is_sampler = matches!(kind, BindingKind::Sampler | BindingKind::ComparisonSampler);
        if count.is_some() && is_sampler {
            return Err("arrays of samplers have no place in the heap of samplers".to_owned());
        }
        let space = u8::try_from(binding.group)
            .ok()
            .filter(|space| *space < INDEX_SPACE)
            .ok_or("groups above 254 have no register space")?;
        let group = SamplerIndexBufferKey { group: binding.group };
        options.binding_map.insert(
            binding,
            BindTarget {
                space,
                register: binding.binding,
                restrict_indexing: source.is_restricted(),
                binding_array_size: (count == Some(0)).then_some(UNBOUNDED),
                ..BindTarget::default()
            },
        );
        options.sampler_buffer_binding_map.insert(
            group,
            BindTarget { space: INDEX_SPACE, register: binding.group, ..BindTarget::default() },
        );
    }
    Ok(options)
}

fn hlsl_reflection(source: &EmitSource<'_>, entry: &str, options: &Options) -> Native {
    let mut native = native_reflection(source, entry, Numbering::Author);
    native.sampler_heaps = sampler_heaps(source, &options.sampler_heap_target);
    let in_heap = |group: u32, binding: u32| {
        native
            .sampler_heaps
            .iter()
            .flat_map(|heap| &heap.samplers)
            .any(|sampler| [sampler.group, sampler.binding] == [group, binding])
    };
    native.slots.retain(|slot| !in_heap(slot.group, slot.binding));
    for slot in &mut native.slots {
        slot.register = register_class(source, [slot.group, slot.binding]).map(str::to_owned);
    }
    native.semantics = vertex_semantics(source);
    native
}

/// The class of register that naga gives what is bound.
fn register_class(source: &EmitSource<'_>, place: Place) -> Option<&'static str> {
    let mut variables = source.module.global_variables.iter();
    let (_, variable) = variables
        .find(|(_, one)| one.binding.is_some_and(|one| [one.group, one.binding] == place))?;
    Some(match (binding_kind(source.module, variable)?, variable.space) {
        (BindingKind::Uniform | BindingKind::Immediate, _) => "b",
        (BindingKind::Storage, naga::AddressSpace::Storage { access })
            if access.contains(naga::StorageAccess::STORE) =>
        {
            "u"
        }
        (BindingKind::StorageTexture, _) => "u",
        _ => "t",
    })
}

/// The heaps that the entry point takes samplers from.
fn sampler_heaps(source: &EmitSource<'_>, targets: &SamplerHeapBindTargets) -> Vec<SamplerHeap> {
    let used = assign_slots(source, Numbering::Author);
    let heap = |(name, wanted): (&str, BindingKind)| {
        let samplers: Vec<HeapSampler> = used
            .iter()
            .filter(|(used, _)| used.kind == wanted)
            .map(|(UsedBinding { place, kind: _, count: _ }, _)| HeapSampler {
                group: place.group,
                binding: place.binding,
                buffer_register: place.group,
                buffer_space: INDEX_SPACE.into(),
                element: place.binding,
            })
            .collect();
        let comparison = wanted == BindingKind::ComparisonSampler;
        let target =
            if comparison { targets.comparison_samplers } else { targets.standard_samplers };
        (!samplers.is_empty()).then(|| SamplerHeap {
            name: name.to_owned(),
            register: target.register,
            space: target.space.into(),
            size: HEAP_SIZE,
            comparison,
            samplers,
        })
    };
    HEAPS.into_iter().filter_map(heap).collect()
}

/// What an input layout calls each attribute.
fn vertex_semantics(source: &EmitSource<'_>) -> Vec<Semantic> {
    if source.stage != naga::ShaderStage::Vertex {
        return Vec::new();
    }
    let function = &source.module.entry_points[source.index].function;
    let locations =
        entry_inputs(source.module, function).into_iter().filter_map(|input| input.location);
    locations
        .map(|location| Semantic { location, name: "LOC".to_owned(), index: location })
        .collect()
}
