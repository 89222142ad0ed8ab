//! HLSL of shader model 5.1, for Direct3D 12 (`fxc`, and `dxc` with 6.0 profiles).
//!
//! Registers: `space` is the author's group, the register number the author's binding, for
//! buffers and textures. Samplers follow naga's heap scheme: all live in one descriptor heap,
//! bound as `nagaSamplerHeap` (`s0, space0`) and `nagaComparisonSamplerHeap` (`s0, space1`); the
//! buffer `nagaGroupNSamplerIndexArray` (`tN, space255`) holds at `[binding]` the heap index of
//! the sampler of group N with that binding.

use naga::back::hlsl::{BindTarget, Options, PipelineOptions, SamplerIndexBufferKey, ShaderModel, Writer};

use crate::bundle::Target;
use crate::emit::slots::{Numbering, assign, native};
use crate::emit::{Emitted, Entry, Source};

pub const TARGET: Entry =
    Entry { target: Target::HLSL, extension: "hlsl", binary: false, about: "HLSL, shader model 5.1 (Direct3D 12)", write };

fn write(source: &Source<'_>) -> Result<Emitted, String> {
    let options = options(source)?;
    let pipeline = PipelineOptions { entry_point: Some((source.stage, source.entry.to_owned())) };
    let mut text = String::new();
    let info = Writer::new(&mut text, &options, &pipeline).write(source.module, source.info, None).map_err(|error| error.to_string())?;
    let name = info.entry_point_names.into_iter().next().ok_or("no entry point was written")?.map_err(|error| error.to_string())?;
    Ok(Emitted { bytes: text.into_bytes(), native: native(source, &name, Numbering::Author) })
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
        let space = u8::try_from(binding.group).ok().filter(|space| *space < u8::MAX).ok_or("groups above 254 have no register space")?;
        let group = SamplerIndexBufferKey { group: binding.group };
        options.binding_map.insert(binding, BindTarget { space, register: binding.binding, ..BindTarget::default() });
        options.sampler_buffer_binding_map.insert(group, BindTarget { space: u8::MAX, register: binding.group, ..BindTarget::default() });
    }
    Ok(options)
}
