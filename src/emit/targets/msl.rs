//! Metal Shading Language 2.0.
//!
//! Buffers, textures and samplers each count from 0 in the order of group and binding, over what
//! the entry point uses; each stage has its own tables. Put vertex buffers above the uniforms.

use std::collections::BTreeMap;

use naga::back::msl::{BindSamplerTarget, BindTarget, EntryPointResources, Options, PipelineOptions, write_string};

use crate::bundle::{Kind, Target};
use crate::emit::slots::{Numbering, assign, native};
use crate::emit::{Emitted, Entry, Source};

pub const TARGET: Entry =
    Entry { target: Target::MSL, extension: "metal", binary: false, about: "Metal Shading Language 2.0 (macOS 10.13, iOS 11)", write };

fn write(source: &Source<'_>) -> Result<Emitted, String> {
    let options = Options {
        lang_version: (2, 0),
        per_entry_point_map: BTreeMap::from([(source.entry.to_owned(), resources(source)?)]),
        fake_missing_bindings: false,
        force_loop_bounding: false,
        ..Options::default()
    };
    let pipeline = PipelineOptions { entry_point: Some((source.stage, source.entry.to_owned())), ..PipelineOptions::default() };
    let (text, info) = write_string(source.module, source.info, &options, &pipeline).map_err(|error| error.to_string())?;
    let name = info.entry_point_names.into_iter().next().ok_or("no entry point was written")?.map_err(|error| error.to_string())?;
    Ok(Emitted { bytes: text.into_bytes(), native: native(source, &name, Numbering::PerKind) })
}

fn resources(source: &Source<'_>) -> Result<EntryPointResources, String> {
    let mut resources = EntryPointResources::default();
    for (binding, kind, index) in assign(source, Numbering::PerKind) {
        let slot = index.and_then(|index| u8::try_from(index).ok()).ok_or("more bindings than Metal has slots")?;
        resources.resources.insert(binding, target(kind, slot));
    }
    // Metal cannot tell the length of a buffer: naga asks for it in a buffer of lengths, here
    // the last of the 31.
    resources.sizes_buffer = Some(30);
    Ok(resources)
}

fn target(kind: Kind, slot: u8) -> BindTarget {
    match kind {
        Kind::Uniform => BindTarget { buffer: Some(slot), ..BindTarget::default() },
        Kind::Storage => BindTarget { buffer: Some(slot), mutable: true, ..BindTarget::default() },
        Kind::Texture => BindTarget { texture: Some(slot), ..BindTarget::default() },
        Kind::StorageTexture => BindTarget { texture: Some(slot), mutable: true, ..BindTarget::default() },
        Kind::Sampler | Kind::ComparisonSampler => BindTarget { sampler: Some(BindSamplerTarget::Resource(slot)), ..BindTarget::default() },
    }
}
