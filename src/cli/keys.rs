//! `lamplight keys`: a manifest's permutations as types of an engine's language.

use std::path::{Path, PathBuf};

use clap::Args;

use super::failure::{DiagnosticForm, Failure, print_warnings};
use super::overwrite::{Overwrite, compare_file};
use super::terminal::write_data;
use crate::diagnostic::{Diagnostic, Diagnostics, codes};
use crate::keys::{self, KeyLanguage, LANGUAGES};
use crate::output::{self, Replace};
use crate::permute::{Lock, Manifest};
use crate::project;
use crate::source::SourceSet;

/// Write typed keys for Rust, C or TypeScript, or the lock file of integer keys.
#[derive(Args)]
pub struct Arguments {
    /// The manifest [default: `lamplight.toml` here or in the nearest folder above, else that of
    /// the library].
    #[arg(long, value_name = "FILE")]
    manifest: Option<PathBuf>,
    /// The language of the keys.
    #[arg(long, value_name = "c|rust|ts", value_parser = find_language, required_unless_present = "lock")]
    lang: Option<&'static KeyLanguage>,
    /// The file to write [default: standard output].
    #[arg(short, long, value_name = "FILE", requires = "lang")]
    out: Option<PathBuf>,
    /// Write the lock file beside the manifest, or append axes and values that it lacks. With a
    /// lock file, generated code can convert keys to integers and back.
    #[arg(long)]
    lock: bool,
    /// Write nothing; the exit code is 3 if a file is not up to date.
    #[arg(long)]
    check: bool,
    #[command(flatten)]
    overwrite: Overwrite,
}

fn find_language(name: &str) -> Result<&'static KeyLanguage, String> {
    let names: Vec<&str> = LANGUAGES.iter().map(|language| language.name).collect();
    keys::find(name).ok_or_else(|| format!("there are: {}", names.join(", ")))
}

pub fn run_keys(arguments: Arguments, form: DiagnosticForm) -> Result<(), Failure> {
    let named = arguments.manifest.clone().or_else(|| project::manifest_above(Path::new("")));
    if arguments.lock && named.is_none() {
        return Err(Failure::usage("`--lock` needs a manifest: add `--manifest FILE`"));
    }
    let (mut sources, manifest) = open_manifest(named.as_deref())?;
    print_warnings(&sources, &manifest.warnings, form);
    let lock =
        match named.as_deref().map(|path| read_lock(path, &arguments, &mut sources, &manifest)) {
            Some(Err(diagnostics)) => return Err(Failure::Input(sources, diagnostics)),
            found => found.and_then(Result::ok).flatten(),
        };
    if let (Some(path), Some(lock), true) = (&named, &lock, arguments.lock) {
        // The file that is there was read as a lock file, so it may be replaced.
        write_or_check(
            &project::lock_path(path),
            &lock.to_string(),
            arguments.check,
            Replace::Any,
        )?;
    }
    let Some(language) = arguments.lang else { return Ok(()) };
    let text = keys::write(&manifest, lock.as_ref(), language);
    match &arguments.out {
        Some(path) => write_or_check(path, &text, arguments.check, arguments.overwrite.replace()),
        None => Ok(write_data(text.as_bytes())?),
    }
}

fn open_manifest(path: Option<&Path>) -> Result<(SourceSet, Manifest), Failure> {
    let Some(path) = path else {
        return project::library_manifest()
            .map_err(|(sources, diagnostics)| Failure::Input(sources, diagnostics));
    };
    let mut sources = SourceSet::default();
    match project::read_manifest(path, &mut sources) {
        Ok(manifest) => Ok((sources, manifest)),
        Err(diagnostics) => Err(Failure::Input(sources, diagnostics)),
    }
}

/// The lock that integer keys are made from: the file beside the manifest. With `--lock`, the axes
/// and values that it lacks are added.
fn read_lock(
    path: &Path,
    arguments: &Arguments,
    sources: &mut SourceSet,
    manifest: &Manifest,
) -> Result<Option<Lock>, Diagnostics> {
    if let Some(shared) = project::shared_lock(path) {
        refuse_shared(path, &shared, sources, manifest)?;
    }
    if !arguments.lock && !project::lock_path(path).exists() {
        return Ok(None);
    }
    let lock = project::lock(path, sources)?;
    let whole = extended_lock(&lock, manifest);
    if arguments.lock || whole == lock {
        return Ok(Some(whole));
    }
    let message = format!("`{}` lacks axes or values", project::lock_path(path).display());
    Err(vec![
        Diagnostic::error(codes::LOCK_INCOMPLETE, message)
            .note("help: add `--lock`: what is missing is appended"),
    ])
}

/// Refuses to go on without the lock file that the manifest used to have in common with others, if
/// that has a program of the manifest: integer keys that are in use would change without a word.
fn refuse_shared(
    path: &Path,
    shared: &Path,
    sources: &mut SourceSet,
    manifest: &Manifest,
) -> Result<(), Diagnostics> {
    let known = project::lock(&path.with_file_name(project::MANIFEST), sources)?;
    let mut programs = manifest.programs.iter();
    let Some(program) = programs.find(|program| known.has(&program.name)) else { return Ok(()) };
    let (own, shared) = (project::lock_path(path), shared.display());
    let message = format!("`{shared}` has the program `{}` of `{}`", program.name, path.display());
    Err(vec![
        Diagnostic::error(codes::LOCK_INCOMPLETE, message)
            .note(format!("the lock of this manifest is `{}`, which is not there", own.display()))
            .note(format!(
                "help: to keep the integer keys, copy `{shared}` to that name; to begin with new \
                 ones, make it an empty file"
            )),
    ])
}

fn extended_lock(lock: &Lock, manifest: &Manifest) -> Lock {
    manifest
        .programs
        .iter()
        .fold(lock.clone(), |lock, program| lock.extended(&program.name, &program.space))
}

fn write_or_check(path: &Path, text: &str, check: bool, replace: Replace) -> Result<(), Failure> {
    match check {
        true => compare_file(path, text),
        false => Ok(output::write_file(path, text.as_bytes(), keys::is_written, replace)?),
    }
}
