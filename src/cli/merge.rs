//! `lamplight merge`: one bundle of several.

use std::collections::BTreeSet;
use std::io::{Write, stdout};
use std::path::PathBuf;

use clap::Args;

use super::failure::Failure;
use super::work::is_file;
use crate::bundle::{self, Bundle, Error};
use crate::project;
use crate::source::SourceSet;

/// Merge the bundles of shards, in any order, into what one run would have written.
#[derive(Args)]
pub struct Arguments {
    /// The bundle to write: a folder, or a single file that ends in `.lamplight`.
    out: PathBuf,
    /// Bundles to read, every byte of them verified.
    #[arg(required = true)]
    inputs: Vec<PathBuf>,
    /// Fail unless every permutation of this manifest is there.
    #[arg(long, value_name = "FILE")]
    manifest: Option<PathBuf>,
}

pub fn run(arguments: Arguments) -> Result<(), Failure> {
    let inputs =
        arguments.inputs.iter().map(|path| Bundle::open(path).map_err(|error| Failure::input(format!("`{}`: {error}", path.display()))));
    let inputs = inputs.collect::<Result<Vec<_>, _>>()?;
    let failed = |error| match error {
        Error::Conflict(_) | Error::Corrupt { .. } => Failure::check(error.to_string()),
        error => Failure::environment(format!("cannot write `{}`: {error}", arguments.out.display())),
    };
    if is_file(&arguments.out) {
        bundle::merge(&inputs).and_then(|contents| bundle::write_file(&contents, &arguments.out)).map_err(failed)?;
    } else {
        bundle::merge_directory(&inputs, &arguments.out).map_err(failed)?;
    }
    let merged = Bundle::open(&arguments.out).map_err(failed)?;
    complete(&arguments, &merged)?;
    Ok(writeln!(stdout(), "{}: {} bundles merged", arguments.out.display(), inputs.len())?)
}

/// Every permutation of the manifest is in every entry point of its program.
fn complete(arguments: &Arguments, merged: &Bundle) -> Result<(), Failure> {
    let Some(path) = &arguments.manifest else { return Ok(()) };
    let mut sources = SourceSet::default();
    let manifest = project::read_manifest(path, &mut sources).map_err(|diagnostics| Failure::Input(sources, diagnostics))?;
    for program in &manifest.programs {
        let wrong = |error: Error| Failure::check(format!("program `{}`: {error}", program.name));
        let found = merged.program(&program.name).map_err(wrong)?;
        let keys = program.space.enumerate();
        for (language, entry) in found.entries() {
            let found: BTreeSet<String> =
                found.entry(language, entry).and_then(|shader| shader.keys()).map_err(wrong)?.into_iter().collect();
            let missing = keys.iter().map(|point| program.space.key(point)).find(|key| !found.contains(key.as_str()));
            if let Some(key) = missing {
                return Err(Failure::check(format!(
                    "`{entry}` of program `{}` has no permutation `{key}`: a shard is missing",
                    program.name
                )));
            }
        }
    }
    Ok(())
}
