//! Lamplight: lighting and shadow functions in WGSL and GLSL, composed, compiled and proven.
//!
//! The crate has three uses. The shaders themselves are in `shaderlib/` and need none of it. The
//! [site] shows each function with plots and pictures, draws every permutation of the programs, and
//! has a playground and the guide. All of it is computed in the browser, by this crate.
//!
//! [site]: https://lamplight-shaders.github.io/lamplight/
//!
//! # Compose
//!
//! [`resolve`] finds what a module imports, and [`compose`] writes one text for the settings of one
//! permutation.
//!
//! ```
//! use lamplight::bundle::Language;
//! use lamplight::{compose, permute::Settings, project, resolve, source::SourceSet};
//!
//! let text = "import lamplight::brdf::diffuse::lambert;
//!     fn lit(n: vec3f, l: vec3f) -> f32 { return lambert(n, l); }";
//! let mut packages = resolve::Packages::of_text("lit.wesl", text.to_owned());
//! packages.add(project::library_package());
//! let graph = resolve::load(&mut SourceSet::default(), &packages, "lit.wesl", Language::Wesl)?;
//! let composed = compose::compose(&graph, &Settings::default(), &Default::default())?;
//! assert!(composed.text.contains("fn lambert("));
//! # Ok::<(), lamplight::diagnostic::Diagnostics>(())
//! ```
//!
//! # Compile
//!
//! [`validate`] hands a composed text to naga, and [`emit`] writes one target.
//!
//! ```
//! use lamplight::bundle::{Language, Target};
//! use lamplight::{compose, emit, permute::Settings, resolve, source::SourceSet, validate};
//!
//! let text = "@fragment fn fs_main() -> @location(0) vec4f { return vec4f(0.5); }";
//! let packages = resolve::Packages::of_text("grey.wesl", text.to_owned());
//! let graph = resolve::load(&mut SourceSet::default(), &packages, "grey.wesl", Language::Wesl)?;
//! let composed = compose::compose(&graph, &Settings::default(), &Default::default())?;
//! let validated = validate::validate(&composed)?;
//! let metal = emit::emit(&validated, "fs_main", Target::MSL).map_err(|error| vec![error])?;
//! assert!(String::from_utf8_lossy(&metal.bytes).contains("fragment "));
//! # Ok::<(), lamplight::diagnostic::Diagnostics>(())
//! ```
//!
//! # Load, in an engine
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
//! # Diagnose, in an editor
//!
//! [`lint`] looks at all modules of a package. Each [`diagnostic`] has a code, a message and places
//! in the author's text.
//!
//! ```
//! use lamplight::{lint, permute::Settings, resolve::Packages, source::SourceSet};
//!
//! let text = "fn half(x: f32) -> f32 {\n    return 0.5 * y;\n}\n";
//! let packages = Packages::of_text("half.wesl", text.to_owned());
//! let (paths, settings) = (["half.wesl".to_owned()], Settings::default());
//! let request =
//!     lint::Request { packages: &packages, manifest: None, settings: &settings, paths: &paths };
//! let mut sources = SourceSet::default();
//! let found = lint::lint(&mut sources, &request).diagnostics;
//! let place = found[0].labels[0].span;
//! assert_eq!(sources.position(place.source, place.start as usize), (2, 18));
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
//! [`permute`] knows the space of permutations, [`keys`] writes typed keys, [`cache`] and [`store`]
//! keep results, [`eval`] runs functions on the CPU, and [`scene`] has the mathematics of the host.
//!
//! Modules that are not listed here serve the command line and may change with any version.

#![warn(missing_docs)]

pub mod project;

pub use lamplight_bundle as bundle;
pub use lamplight_compose as compose;
pub use lamplight_compose::resolve;
pub use lamplight_diagnostic as diagnostic;
pub use lamplight_diagnostic::source;
pub use lamplight_emit as emit;
pub use lamplight_eval as eval;
#[doc(hidden)]
pub use lamplight_files::{input, limits, output, sandbox};
pub use lamplight_generate as generate;
pub use lamplight_generate::{cache, store};
pub use lamplight_glsl as glsl;
pub use lamplight_keys as keys;
#[doc(hidden)]
pub use lamplight_link as link;
pub use lamplight_lint as lint;
pub use lamplight_permute as permute;
#[doc(hidden)]
pub use lamplight_syntax as parse;
pub use lamplight_validate as validate;

/// The identity of this build, for [`cache::Cache::new`]. It changes with the sources of this crate
/// and of those that it is made of, with the versions of their dependencies, and with the system
/// that it is built for.
pub const BUILD: &str = env!("LAMPLIGHT_BUILD");

/// The same for every system that this crate is built for, with the version in front. Parts of one
/// bundle have it in common ([`generate::Tools::tool`]).
pub const TOOL: &str = env!("LAMPLIGHT_TOOL");

/// The files of the shader library, which this crate carries.
pub const LIBRARY_FILES: source::Embedded =
    source::Embedded { texts: lamplight_shaderlib::FILES, tables: lamplight_shaderlib::TABLES };

#[cfg(feature = "cli")]
#[doc(hidden)]
pub mod spirv_opt;

#[cfg(feature = "cli")]
#[doc(hidden)]
pub use whole::*;

/// What the command uses besides the stages above.
#[cfg(feature = "cli")]
mod whole {
    pub use lamplight_catalogue as catalogue;
    pub use lamplight_check as check;
    pub use lamplight_check::report;
    pub use lamplight_cost as cost;
    pub use lamplight_dap as dap;
    pub use lamplight_debug as debug;
    pub use lamplight_execute as execute;
    pub use lamplight_format as format;
    pub use lamplight_lsp as lsp;
    pub use lamplight_migrate as migrate;
    pub use lamplight_mutate as mutate;
    pub use lamplight_picture as picture;
    pub use lamplight_scene::quadrature;
    pub use lamplight_scenes::model;
    pub use lamplight_tools as tools;
    pub use lamplight_tools::{browser, metal};
    pub use lamplight_validators as validators;
}

/// The mathematics of lighting for the host, and what pictures show.
#[cfg(feature = "cli")]
pub mod scene {
    pub use lamplight_scene::*;
    pub use lamplight_scenes::*;
}

#[cfg(feature = "cli")]
#[doc(hidden)]
pub mod cli;
