//! WGSL, for WebGPU: one self-contained entry point, as naga writes it.
//!
//! Group and binding are the author's; overrides stay overrides.

use naga::back::wgsl::{Writer, WriterFlags};

use crate::bundle::{Choice, Target};
use crate::emit::slots::{Numbering, native};
use crate::emit::text::Text;
use crate::emit::{Emitted, Entry, Judge, Source, clip};

/// The target, for the table of all.
pub const TARGET: Entry = Entry {
    target: Target::WGSL,
    extension: "wgsl",
    binary: false,
    about: "WGSL (WebGPU)",
    judge: Judge::NagaAndTint,
    clip: &clip::SHARED,
    write,
};

fn write(source: &Source<'_>) -> Result<Emitted, String> {
    let mut text = Text::default();
    let written = Writer::new(&mut text, WriterFlags::empty()).write(source.module, source.info);
    written.map_err(|error| text.explain(error))?;
    let text = text.0;
    let mut native = native(source, source.entry, Numbering::Author);
    let overrides = source.module.overrides.iter().map(|(_, constant)| constant);
    native.choices = overrides
        .filter_map(|constant| {
            Some(Choice {
                name: constant.name.clone()?,
                id: constant.id.map(u32::from),
                symbol: None,
            })
        })
        .collect();
    Ok(Emitted { bytes: text.into_bytes(), native })
}
