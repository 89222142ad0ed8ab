//! Compiled permutations, as a directory or one file, and the loader an engine uses.
//!
//! The directory form is for reading and for version control: `manifest.json`, described by
//! [`SCHEMA`], and `blobs/` named by content. The single file is for shipping: see [`pack`].
//! Of the crate, this module uses the compression of the single file and nothing else.

mod contents;
mod diff;
mod directory;
mod error;
mod file;
mod key;
mod layout;
mod loader;
mod manifest;
mod merge;
mod pack;
mod reflection;
mod store;
mod target;
mod usage;

pub use contents::{Artifact, Axis, Contents, Digest, EntryContents, Hash, ProgramContents, Unit};
pub use diff::{Change, Difference, diff};
pub use directory::{BlobFile, DirectoryWriter, blob_files, write_directory};
pub use error::{Error, Miss};
pub use key::canonical;
pub use loader::{Bundle, Constant, Found, Program, Shader};
pub use manifest::SCHEMA;
pub use merge::{merge, merge_directory, patch_directory};
pub use pack::{pack, write_file};
pub use reflection::{Binding, Choice, Combined, Kind, Language, Member, Native, Override, Pair, Place, Reflection, Slot, Stage, Varying};
pub use target::Target;
pub use usage::Usage;

/// Version of both forms; a loader reads exactly one.
pub const VERSION: u32 = 1;
