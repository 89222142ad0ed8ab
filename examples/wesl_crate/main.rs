//! Links a shader of one's own with the library by the `wesl` crate.
//!
//! ```text
//! cargo run --example wesl_crate
//! ```
//!
//! The library is read from its folder here. Its published form, the crate `lamplight_wgsl`, takes
//! one line in place of the router: `compiler.add_package(&lamplight_wgsl::lamplight::PACKAGE)`.

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::path::Path;

use wesl::syntax::{ModulePath, PathOrigin};
use wesl::{FileResolver, Router, Wesl};

pub fn main() -> Result<(), Box<dyn Error>> {
    println!("{}", link()?);
    Ok(())
}

/// The shader with what it imports, as WGSL.
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
