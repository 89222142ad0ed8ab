//! HLSL of shader model 5.1, for Direct3D 12 (`fxc`, and `dxc` with 6.0 profiles).
//!
//! Registers: `space` is the author's group, the register number the author's binding, for
//! buffers and textures. Samplers follow naga's heap scheme: all live in one descriptor heap,
//! bound as `nagaSamplerHeap` (`s0, space0`) and `nagaComparisonSamplerHeap` (`s0, space1`); the
//! buffer `nagaGroupNSamplerIndexArray` (`tN, space255`) holds at `[binding]` the heap index of
//! the sampler of group N with that binding. Vertex attributes have the semantic `LOC` with the
//! author's location. All of it is in [`Native`].

use naga::back::hlsl::{
    BindTarget, Options, PipelineOptions, SamplerHeapBindTargets, SamplerIndexBufferKey,
    ShaderModel, Writer,
};

use crate::bundle::{HeapSampler, Kind, Native, SamplerHeap, Semantic, Target};
use crate::emit::reflect::inputs;
use crate::emit::slots::{Numbering, assign, native};
use crate::emit::text::Text;
use crate::emit::{Emitted, Entry, Source};

/// The target, for the table of all.
pub const TARGET: Entry = Entry {
    target: Target::HLSL,
    extension: "hlsl",
    binary: false,
    about: "HLSL, shader model 5.1 (Direct3D 12)",
    write,
};

/// Elements of each heap, as naga declares them.
const HEAP_SIZE: u32 = 2048;
/// Register space of the buffers with places in the heaps; the register is the group.
const INDEX_SPACE: u8 = u8::MAX;

/// The heaps: name in the output, and the kind of sampler.
const HEAPS: [(&str, Kind); 2] =
    [("nagaSamplerHeap", Kind::Sampler), ("nagaComparisonSamplerHeap", Kind::ComparisonSampler)];

fn write(source: &Source<'_>) -> Result<Emitted, String> {
    let options = options(source)?;
    let pipeline = PipelineOptions { entry_point: Some((source.stage, source.entry.to_owned())) };
    let mut text = Text::default();
    let written = Writer::new(&mut text, &options, &pipeline).write(source.module, source.info, None);
    let info = written.map_err(|error| text.explain(error))?;
    let name = info
        .entry_point_names
        .into_iter()
        .next()
        .ok_or("no entry point was written")?
        .map_err(|error| error.to_string())?;
    let text = with_plain_zeros(&text.0);
    Ok(Emitted { bytes: text.into_bytes(), native: reflection(source, &name, &options) })
}

/// Elements up to which a zero array is written out.
const MAX_ELEMENTS: usize = 1024;

/// naga writes an array of zeros as `(float3[9])0`. fxc and dxc take that, glslang does not; all
/// of them take a list of elements, where a variable is declared.
fn with_plain_zeros(text: &str) -> String {
    let line = |line: &str| {
        declared_zeros(line).or_else(|| returned_zeros(line)).unwrap_or_else(|| line.to_owned())
    };
    if text.contains("])0;") {
        text.split_inclusive('\n').map(line).collect()
    } else {
        text.to_owned()
    }
}

/// `float3 a[2] = (float3[2])0;` with a list instead.
fn declared_zeros(line: &str) -> Option<String> {
    let (declaration, cast) = line.split_once(" = (")?;
    let (list, end) = zeros(cast)?;
    declaration.ends_with(']').then(|| format!("{declaration} = {list}{end}"))
}

/// `return (float3[2])0;` by way of a variable.
fn returned_zeros(line: &str) -> Option<String> {
    let (indent, cast) = line.split_once("return (")?;
    let (list, end) = zeros(cast)?;
    let (ty, _) = cast.split_once(")0;")?;
    let (element, sizes) = ty.split_at(ty.find('[')?);
    Some(format!("{indent}{element} zeros{sizes} = {list};\n{indent}return zeros{end}"))
}

/// The list for `float3[2])0;`, and what follows the cast from the semicolon on.
fn zeros(cast: &str) -> Option<(String, &str)> {
    let (ty, _) = cast.split_once(")0;")?;
    let (element, sizes) = ty.split_at(ty.find('[')?);
    let sizes = sizes.strip_prefix('[')?.strip_suffix(']')?.split("][");
    let sizes: Vec<usize> = sizes.map(|size| size.parse().ok()).collect::<Option<_>>()?;
    let count = sizes.iter().try_fold(1usize, |count, size| count.checked_mul(*size))?;
    if count > MAX_ELEMENTS {
        return None;
    }
    let list = sizes.iter().rev().fold(format!("({element})0"), |inner, size| {
        format!("{{ {} }}", vec![inner; *size].join(", "))
    });
    Some((list, &cast[ty.len() + 2..]))
}

fn options(source: &Source<'_>) -> Result<Options, String> {
    let mut options = Options {
        shader_model: ShaderModel::V5_1,
        fake_missing_bindings: false,
        restrict_indexing: false,
        force_loop_bounding: false,
        ..Options::default()
    };
    for (binding, _, _) in assign(source, Numbering::Author) {
        let space = u8::try_from(binding.group)
            .ok()
            .filter(|space| *space < INDEX_SPACE)
            .ok_or("groups above 254 have no register space")?;
        let group = SamplerIndexBufferKey { group: binding.group };
        options.binding_map.insert(
            binding,
            BindTarget { space, register: binding.binding, ..BindTarget::default() },
        );
        options.sampler_buffer_binding_map.insert(
            group,
            BindTarget { space: INDEX_SPACE, register: binding.group, ..BindTarget::default() },
        );
    }
    Ok(options)
}

fn reflection(source: &Source<'_>, entry: &str, options: &Options) -> Native {
    let mut native = native(source, entry, Numbering::Author);
    native.sampler_heaps = heaps(source, &options.sampler_heap_target);
    let in_heap = |group: u32, binding: u32| {
        native
            .sampler_heaps
            .iter()
            .flat_map(|heap| &heap.samplers)
            .any(|sampler| [sampler.group, sampler.binding] == [group, binding])
    };
    native.slots.retain(|slot| !in_heap(slot.group, slot.binding));
    native.semantics = semantics(source);
    native
}

/// The heaps that the entry point takes samplers from.
fn heaps(source: &Source<'_>, targets: &SamplerHeapBindTargets) -> Vec<SamplerHeap> {
    let used = assign(source, Numbering::Author);
    let heap = |(name, wanted): (&str, Kind)| {
        let samplers: Vec<HeapSampler> = used
            .iter()
            .filter(|(_, kind, _)| *kind == wanted)
            .map(|(place, ..)| HeapSampler {
                group: place.group,
                binding: place.binding,
                buffer_register: place.group,
                buffer_space: INDEX_SPACE.into(),
                element: place.binding,
            })
            .collect();
        let comparison = wanted == Kind::ComparisonSampler;
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
fn semantics(source: &Source<'_>) -> Vec<Semantic> {
    if source.stage != naga::ShaderStage::Vertex {
        return Vec::new();
    }
    let function = &source.module.entry_points[source.index].function;
    let locations = inputs(source.module, function).into_iter().filter_map(|input| input.location);
    locations
        .map(|location| Semantic { location, name: "LOC".to_owned(), index: location })
        .collect()
}
