//! Compiled permutations, as a directory or one file, and the loader an engine uses.
//!
//! The directory form is for reading and for version control: `manifest.json`, described by
//! [`SCHEMA`], the same tables in `index.bin`, which the loader opens, and `blobs/` named by content. The single file is for shipping: see [`pack`].
//! Of the rest of the crate, this module uses only what reads, writes and compresses files, and the
//! limits on them.

pub mod contents;
mod conventions;
mod diff;
mod digest;
mod directory;
mod directory_writer;
mod error;
mod file;
pub mod key;
mod layout;
mod loader;
mod manifest;
mod merge;
mod names;
mod pack;
#[cfg(feature = "single-file")]
#[path = "packing/zstd.rs"]
mod packing;
#[cfg(not(feature = "single-file"))]
#[path = "packing/absent.rs"]
mod packing;
mod pieces;
mod program_layout;
mod reflection;
mod reload;
mod shard;
mod staging;
mod store;
mod target;
mod tree;
mod usage;

pub use contents::{Artifact, Axis, Contents, EntryContents, Hash, ProgramContents, Unit};
pub use conventions::{
    BoundsChecks, ClipConvention, Convention, Conventions, RequestedConventions, SourceClip,
    SpirvForm,
};
pub use diff::{Change, Difference, diff};
pub use digest::{Digest, Digester};
pub use directory::{BlobFile, blob_files};
pub use directory_writer::{DirectoryWriter, write_directory};
pub use error::{Error, Miss};
pub use key::canonical;
pub use loader::{Bundle, Constant, Found, Program, Shader, constants};
pub use manifest::SCHEMA;
pub use merge::{merge, merge_into, patch_directory};
pub use names::{Language, Stage};
pub use pack::{pack, replace_file, replace_packed, write_file};
pub use program_layout::LayoutBinding;
pub use reflection::{
    Access, Binding, BindingKind, BindingSlot, BufferSizes, ClipSpace, Combined, FrontFace,
    HeapSampler, Member, Native, Override, OverrideChoice, Pair, Place, Reflection, RowOrder,
    SampleType, SamplerHeap, Semantic, Shape, TextureShape, Varying, Viewport, YAxis,
};
pub use shard::{ShardMismatch, ShardOrigin};
pub use staging::stage_blobs;
pub use target::Target;
pub use usage::Usage;
#[doc(hidden)]
pub use usage::usage_lines;

/// Version of both forms. It changes only when an older reader would misread a bundle: members of
/// records may be added without a new version.
pub const VERSION: u32 = 3;
