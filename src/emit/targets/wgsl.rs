//! WGSL, for WebGPU: one self-contained entry point, as naga writes it.
//!
//! Group and binding are the author's; overrides stay overrides.

use naga::back::wgsl::{WriterFlags, write_string};

use crate::bundle::Target;
use crate::emit::slots::{Numbering, native};
use crate::emit::{Emitted, Entry, Source};

pub const TARGET: Entry = Entry { target: Target::WGSL, extension: "wgsl", binary: false, about: "WGSL (WebGPU)", write };

fn write(source: &Source<'_>) -> Result<Emitted, String> {
    let text = write_string(source.module, source.info, WriterFlags::empty()).map_err(|error| error.to_string())?;
    Ok(Emitted { bytes: text.into_bytes(), native: native(source, source.entry, Numbering::Author) })
}
