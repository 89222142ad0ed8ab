//! Compiles every permutation of `shaders/lamplight.toml` into one file, which the program embeds.

use std::error::Error;
use std::path::Path;

use lamplight::diagnostic::Diagnostics;
use lamplight::diagnostic::render::{Form, render};
use lamplight::generate::{Generated, Request, in_memory};
use lamplight::source::SourceSet;
use lamplight::{bundle, project};

pub fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=shaders");
    let out = std::env::var("OUT_DIR")?;
    compile(Path::new("shaders"), &Path::new(&out).join("shaders.lamplight"))
}

/// Writes the bundle of a package that has a manifest. If the package does not compile, the error
/// contains the diagnostics as text.
pub fn compile(package: &Path, bundle: &Path) -> Result<(), Box<dyn Error>> {
    let mut sources = SourceSet::default();
    let generated = generated(package, &mut sources)
        .map_err(|problems| render(&sources, &problems, Form::Human))?;
    Ok(bundle::write_file(&generated.contents, bundle)?)
}

fn generated(package: &Path, sources: &mut SourceSet) -> Result<Generated, Diagnostics> {
    let (manifest, packages) = project::declared(&package.join(project::MANIFEST), sources)?;
    in_memory(sources, &packages, &manifest, &Request::default(), &|_| {})
}
