//! Links a shader of your own with the library, using the `wesl` crate.
//!
//! ```text
//! cargo run --example wesl_crate
//! ```
//!
//! This example reads the library from its folder. If you use its published form, the crate
//! `lamplight_wgsl`, one line replaces the router:
//! `compiler.add_package(&lamplight_wgsl::lamplight::PACKAGE)`.

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::path::Path;

use wesl::syntax::{ModulePath, PathOrigin};
use wesl::{FileResolver, Router, Wesl};

pub fn main() -> Result<(), Box<dyn Error>> {
    println!("{}", link()?);
    Ok(())
}

/// The shader with everything that it imports, as WGSL.
pub fn link() -> Result<String, Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = Router::new();
    let library = ModulePath::new(PathOrigin::Package("lamplight".into()), Vec::new());
    files.mount_resolver(library, FileResolver::new(root.join("shaderlib")));
    files.mount_fallback_resolver(FileResolver::new(root.join("examples/wesl_crate/shaders")));
    let compiler = Wesl::new(root).set_custom_resolver(files);
    let module = ModulePath::new(PathOrigin::Absolute, vec!["spot".into()]);
    Ok(compiler.compile(&module).map_err(|error| error.to_string())?.to_string())
}
