//! `cargo xtask gen`: the library's bundle, and what the external validators say of it.

use std::io::{IsTerminal, Write, stderr};
use std::path::{Path, PathBuf};

use lamplight::diagnostic::Diagnostics;
use lamplight::diagnostic::render::{Form, render};
use lamplight::generate::{Generated, Progress, Request, in_memory};
use lamplight::source::SourceSet;
use lamplight::{bundle, project};

use crate::validate::{Earlier, validate};
use crate::{Failure, Outcome};

/// Where the library's bundle goes.
pub fn bundle() -> PathBuf {
    root().join("target/bundles/lamplight")
}

/// The workspace's root.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Generates, prints the summary, and validates what is new.
pub fn run(arguments: &[String]) -> Outcome {
    if !arguments.is_empty() {
        return Err(Failure::usage("usage: cargo xtask gen (for other manifests: lamplight gen)"));
    }
    let mut sources = SourceSet::default();
    let generated = library(&mut sources);
    let Generated { contents, summary, warnings } =
        generated.map_err(|diagnostics| Failure::input(render(&sources, &diagnostics, Form::Human)))?;
    eprint!("{}", render(&sources, &warnings, Form::Human));
    bundle::write_directory(&contents, bundle()).map_err(|error| Failure::environment(error.to_string()))?;
    print!("{summary}");
    println!("written to target/bundles/lamplight");
    validate(&bundle(), Earlier::Trust)
}

fn library(sources: &mut SourceSet) -> Result<Generated, Diagnostics> {
    let folder = root().join("shaderlib");
    let manifest = project::read_manifest(&folder.join(project::MANIFEST), sources)?;
    let packages = project::packages(&folder, sources)?;
    in_memory(sources, &packages, &manifest, &Request::default(), &show)
}

fn show(progress: Progress) {
    if stderr().is_terminal() {
        let end = if progress.done == progress.total { "\n" } else { "" };
        let _ = write!(stderr(), "\r{}: {} of {}{end}", progress.stage, progress.done, progress.total);
    }
}
