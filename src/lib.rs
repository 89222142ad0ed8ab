//! Lamplight: lighting and shadow functions in WGSL and GLSL, composed, compiled and proven.
//!
//! The crate has three uses. The shaders themselves are in `shaderlib/` and need none of it. The
//! [site] shows each function with plots and pictures, draws every permutation of the programs, and
//! has a playground and the guide. All of it is computed in the browser, by this crate.
//!
//! [site]: https://lamplight-shaders.github.io/lamplight/
//!
//! # In an engine
//!
//! [`bundle`] opens what was generated and finds a permutation by its key. It needs no feature of
//! the crate, and neither naga nor wgpu.
//!
//! ```
//! # fn generated() -> Result<lamplight::bundle::Contents, String> {
//! #     let mut sources = lamplight::source::SourceSet::default();
//! #     let folder = std::path::Path::new("examples/build_script/shaders");
//! #     let made = lamplight::project::read_manifest(&folder.join("lamplight.toml"), &mut sources);
//! #     let made = made.and_then(|manifest| {
//! #         let packages = lamplight::project::packages(folder, &mut sources)?;
//! #         let request = lamplight::generate::Request::default();
//! #         lamplight::generate::in_memory(&mut sources, &packages, &manifest, &request, &|_| {})
//! #     });
//! #     made.map(|made| made.contents).map_err(|problems| format!("{problems:?}"))
//! # }
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let bytes = lamplight::bundle::pack(&generated()?)?;
//! use lamplight::bundle::{Bundle, Target};
//!
//! let bundle = Bundle::from_bytes(bytes)?; // or Bundle::open("shaders.lamplight")
//! let shader = bundle.program("lamp")?.shader("fs_main")?;
//! let found = shader.get("cone=exponent,specular", Target::WGSL)?;
//! assert_eq!(found.native.entry_name, "fs_main");
//! assert!(std::str::from_utf8(&found.bytes)?.contains("fn fs_main("));
//! # Ok(())
//! # }
//! ```
//!
//! # In a build script
//!
//! [`project`] reads a package and its manifest from the disk, and [`generate`] compiles every
//! permutation that the manifest declares. What goes wrong comes back as [`diagnostic`]s with
//! places in the author's text.
//!
//! ```
//! use std::path::Path;
//!
//! use lamplight::bundle::pack;
//! use lamplight::diagnostic::Diagnostics;
//! use lamplight::diagnostic::render::{Form, render};
//! use lamplight::generate::{Generated, Request, in_memory};
//! use lamplight::project;
//! use lamplight::source::SourceSet;
//!
//! fn generated(package: &Path, sources: &mut SourceSet) -> Result<Generated, Diagnostics> {
//!     let manifest = project::read_manifest(&package.join(project::MANIFEST), sources)?;
//!     let packages = project::packages(package, sources)?;
//!     in_memory(sources, &packages, &manifest, &Request::default(), &|_| {})
//! }
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let mut sources = SourceSet::default();
//! let made = generated(Path::new("examples/build_script/shaders"), &mut sources)
//!     .map_err(|problems| render(&sources, &problems, Form::Human))?;
//! let bytes = pack(&made.contents)?;
//! # assert!(!bytes.is_empty() && made.warnings.is_empty());
//! # Ok(())
//! # }
//! ```
//!
//! # In a tool
//!
//! Each step is a function from one value to the next: [`source`] holds texts, [`resolve`] finds
//! what they import, [`compose`] writes one text for the settings of one permutation, [`validate`]
//! hands it to naga, and [`emit`] writes one target. [`permute`] knows the space of permutations,
//! [`keys`] writes typed keys, [`cache`] and [`store`] keep results, [`eval`] runs functions on the
//! CPU, and [`scene`] has the mathematics of the host.
//!
//! ```
//! use lamplight::bundle::{Language, Target};
//! use lamplight::diagnostic::Diagnostics;
//! use lamplight::permute::Settings;
//! use lamplight::resolve::{self, Packages};
//! use lamplight::source::SourceSet;
//! use lamplight::{compose, emit, project, validate};
//!
//! fn lit() -> Result<Vec<u8>, Diagnostics> {
//!     let text = "
//!         import lamplight::brdf::diffuse::lambert;
//!         @fragment fn fs_main(@location(0) n: vec3f) -> @location(0) vec4f {
//!             return vec4f(lambert(n, vec3f(0.0, 1.0, 0.0)));
//!         }";
//!     let mut packages = Packages::of_text("lit.wesl", text.to_owned());
//!     packages.dependencies.push(project::library_package());
//!     let mut sources = SourceSet::default();
//!     let graph = resolve::load(&mut sources, &packages, "lit.wesl", Language::Wesl)?;
//!     let composed = compose::compose(&graph, &Settings::default(), &Default::default())?;
//!     let validated = validate::validate(&composed)?;
//!     let emitted = emit::emit(&validated, "fs_main", Target::MSL).map_err(|error| vec![error])?;
//!     Ok(emitted.bytes)
//! }
//!
//! # fn main() -> Result<(), String> {
//! let metal = lit().map_err(|problems| format!("{problems:?}"))?;
//! assert!(String::from_utf8_lossy(&metal).contains("float lambert("));
//! # Ok(())
//! # }
//! ```
//!
//! Modules that are not listed here serve the command line and may change with any version.

#![warn(missing_docs)]
// A page has no devices, files or programs: what only those use is not called there.
#![cfg_attr(target_family = "wasm", allow(dead_code, unused_imports))]

pub mod bundle;
#[doc(hidden)]
pub mod input;
#[doc(hidden)]
pub mod limits;
#[doc(hidden)]
pub mod output;
#[cfg(feature = "single-file")]
#[path = "packing/zstd.rs"]
mod packing;
#[cfg(not(feature = "single-file"))]
#[path = "packing/absent.rs"]
mod packing;
#[doc(hidden)]
pub mod quadrature;
#[cfg(all(feature = "compile", target_os = "linux"))]
#[path = "syncing/system.rs"]
mod syncing;
#[cfg(not(all(feature = "compile", target_os = "linux")))]
#[path = "syncing/each.rs"]
mod syncing;

#[cfg(feature = "compile")]
pub mod cache;
#[cfg(feature = "compile")]
pub mod compose;
#[cfg(feature = "compile")]
pub mod diagnostic;
#[cfg(feature = "compile")]
pub mod emit;
#[cfg(feature = "eval")]
pub mod eval;
#[cfg(feature = "compile")]
pub mod generate;
#[cfg(feature = "compile")]
pub mod judge;
#[cfg(feature = "compile")]
pub mod keys;
#[cfg(feature = "compile")]
#[doc(hidden)]
pub mod link;
#[cfg(feature = "compile")]
pub mod lint;
#[cfg(feature = "compile")]
#[doc(hidden)]
pub mod metal;
#[cfg(feature = "migrate")]
#[doc(hidden)]
pub mod migrate;
#[cfg(feature = "compile")]
#[doc(hidden)]
pub mod parse;
#[cfg(feature = "compile")]
pub mod permute;
#[cfg(feature = "compile")]
pub mod project;
#[cfg(feature = "compile")]
#[doc(hidden)]
pub mod rehearse;
#[cfg(feature = "compile")]
pub mod resolve;
#[cfg(feature = "compile")]
pub mod source;
#[cfg(feature = "store")]
pub mod store;
#[cfg(all(feature = "compile", not(feature = "store")))]
#[path = "store/absent.rs"]
pub mod store;
#[cfg(feature = "compile")]
#[doc(hidden)]
pub mod tools;
#[cfg(feature = "compile")]
pub mod validate;

#[cfg(all(feature = "harness", not(target_family = "wasm")))]
#[doc(hidden)]
pub mod browser;
#[cfg(feature = "harness")]
#[doc(hidden)]
pub mod catalogue;
#[cfg(all(feature = "harness", not(target_family = "wasm")))]
#[doc(hidden)]
pub mod cost;
#[cfg(feature = "harness")]
#[doc(hidden)]
pub mod execute;
#[cfg(feature = "harness")]
#[doc(hidden)]
pub mod lsp;
#[cfg(all(feature = "harness", not(target_family = "wasm")))]
#[doc(hidden)]
pub mod model;
#[cfg(feature = "harness")]
#[doc(hidden)]
pub mod picture;
#[cfg(feature = "harness")]
#[doc(hidden)]
pub mod proof;
#[cfg(feature = "harness")]
#[doc(hidden)]
pub mod report;
#[cfg(feature = "harness")]
pub mod scene;

#[cfg(feature = "cli")]
#[doc(hidden)]
pub mod cli;
