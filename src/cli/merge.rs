//! `lamplight merge`: one bundle of several.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Write;
use std::path::PathBuf;

use clap::Args;

use super::failure::Failure;
use super::overwrite::{Overwrite, Patience, write_failure};
use super::terminal::stdout;
use super::work::is_file;
use crate::bundle::{self, Bundle, DirectoryWriter, Error, Language, ShardMismatch, ShardOrigin};
use crate::project;
use crate::source::SourceSet;

/// Merge the bundles of shards into the bundle that one run would have written.
#[derive(Args)]
pub struct Arguments {
    /// The bundle to write: a folder, or a single file whose name ends in `.lamplight`.
    out: PathBuf,
    /// The bundles of all shards, in any order; every byte of them is verified.
    #[arg(required = true)]
    inputs: Vec<PathBuf>,
    /// Fail if a permutation of this manifest is missing.
    #[arg(long, value_name = "FILE")]
    manifest: Option<PathBuf>,
    /// Merge the shards that are there, though others are missing. They can be added later.
    #[arg(long, conflicts_with = "manifest")]
    partial: bool,
    #[command(flatten)]
    overwrite: Overwrite,
    #[command(flatten)]
    patience: Patience,
}

pub fn run_merge(arguments: Arguments) -> Result<(), Failure> {
    let inputs = arguments.inputs.iter().map(|path| {
        Bundle::open(path).map_err(|error| Failure::input(format!("`{}`: {error}", path.display())))
    });
    let inputs = inputs.collect::<Result<Vec<_>, _>>()?;
    // Everything is checked before anything is written.
    check_origins(&arguments, &inputs)?;
    check_complete(&arguments, &inputs)?;
    for (path, bundle) in arguments.inputs.iter().zip(&inputs) {
        bundle
            .verify()
            .map_err(|error| Failure::check(format!("`{}`: {error}", path.display())))?;
    }
    let failed = |error| match error {
        Error::Conflict(_) | Error::Corrupt { .. } => Failure::check(error.to_string()),
        error => write_failure(&arguments.out, error),
    };
    let replace = arguments.overwrite.replace();
    if is_file(&arguments.out) {
        bundle::merge(&inputs)
            .and_then(|contents| bundle::replace_file(&contents, &arguments.out, replace))
            .map_err(failed)?;
    } else {
        let out = &arguments.out;
        arguments
            .patience
            .with_turns(out, |turns| DirectoryWriter::take_over(out, replace, turns))
            .and_then(|writer| bundle::merge_into(&inputs, writer))
            .map_err(failed)?;
    }
    Ok(writeln!(stdout(), "{}: {} bundles merged", arguments.out.display(), inputs.len())?)
}

/// All shards are parts of one bundle, and none is missing.
fn check_origins(arguments: &Arguments, inputs: &[Bundle]) -> Result<(), Failure> {
    let mut named = arguments.inputs.iter().zip(inputs);
    let Some((first, bundle)) = named.next() else { return Ok(()) };
    for (path, other) in named {
        if let Some(mismatch) = ShardMismatch::between(bundle.shard(), other.shard()) {
            let (first, path, reason) = (first.display(), path.display(), mismatch.message());
            let mut message = format!("`{first}` and `{path}` {reason}");
            if let (Some(left), Some(right)) = (bundle.shard(), other.shard()) {
                message += &values_of(mismatch, left, right);
            }
            return Err(Failure::check(message));
        }
    }
    let Some(origin) = bundle.shard() else { return Ok(()) };
    let mut all = origin.clone();
    all.parts.extend(inputs.iter().filter_map(Bundle::shard).flat_map(|shard| &shard.parts));
    match all.missing() {
        Some((count, first)) if !arguments.partial => {
            let of = all.of;
            let parts = match count {
                1 => format!("part {first} of {of} is missing"),
                _ => format!("{count} of {of} parts are missing, such as part {first}"),
            };
            Err(Failure::check(format!(
                "{parts}\nhelp: make it with `gen --shard {first}/{of}`, or add `--partial`"
            )))
        }
        _ => Ok(()),
    }
}

/// The values that differ between two shards, where they say something to a reader.
fn values_of(mismatch: ShardMismatch, left: &ShardOrigin, right: &ShardOrigin) -> String {
    let pair = match mismatch {
        ShardMismatch::Count => (left.of.to_string(), right.of.to_string()),
        ShardMismatch::Tool => (left.tool.clone(), right.tool.clone()),
        ShardMismatch::Settings => (left.settings.clone(), right.settings.clone()),
        ShardMismatch::Sources | ShardMismatch::Whole => return String::new(),
    };
    format!("\n  {}\n  {}", pair.0, pair.1)
}

/// Every permutation of the manifest is in every entry point of its program, in one of the
/// bundles.
fn check_complete(arguments: &Arguments, inputs: &[Bundle]) -> Result<(), Failure> {
    let Some(path) = &arguments.manifest else { return Ok(()) };
    let mut sources = SourceSet::default();
    let manifest = project::read_manifest(path, &mut sources)
        .map_err(|diagnostics| Failure::Input(sources, diagnostics))?;
    for program in &manifest.programs {
        let found = keys_of_entries(inputs, &program.name)
            .map_err(|error| Failure::check(format!("program `{}`: {error}", program.name)))?;
        if found.is_empty() {
            return Err(Failure::check(format!("no bundle has program `{}`", program.name)));
        }
        let all = program.space.enumerate();
        for ((_, entry), found) in found {
            let mut keys = all.iter().map(|point| program.space.key(point));
            if let Some(key) = keys.find(|key| !found.contains(key.as_str())) {
                return Err(Failure::check(format!(
                    "`{entry}` of program `{}` has no permutation `{key}`: a shard is missing",
                    program.name
                )));
            }
        }
    }
    Ok(())
}

/// The keys of each entry point of a program, by language and name, over all bundles.
fn keys_of_entries(
    inputs: &[Bundle],
    program: &str,
) -> Result<BTreeMap<(Language, String), BTreeSet<String>>, Error> {
    let mut all: BTreeMap<_, BTreeSet<String>> = BTreeMap::new();
    for bundle in inputs.iter().filter(|bundle| bundle.programs().any(|name| name == program)) {
        let found = bundle.program(program)?;
        for (language, entry) in found.entries() {
            let keys = found.entry(language, entry)?.keys()?;
            all.entry((language, entry.to_owned())).or_default().extend(keys);
        }
    }
    Ok(all)
}
