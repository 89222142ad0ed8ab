//! `lamplight migrate --from naga_oil DIR`: sources of another preprocessor as WESL.

use std::collections::BTreeSet;
use std::io::Write;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::failure::{DiagnosticForm, Failure, print_warnings};
use super::overwrite::Overwrite;
use crate::cli::terminal::stdout;
use crate::diagnostic::{Diagnostic, Severity, codes};
use crate::generate::summary::counted_words;
use crate::limits::FILE_BYTES;
use crate::migrate::{self, Migrated};
use crate::output;
use crate::project;
use crate::source::{self, Disk, Files, Package, SourceSet};

/// Rewrite shaders of another preprocessor as WESL; the original files stay unchanged.
#[derive(Args)]
pub struct Arguments {
    /// The preprocessor that the shaders are written for.
    #[arg(long, value_enum)]
    from: From,
    /// The folder of the shaders: all `.wgsl` files below it belong together.
    folder: PathBuf,
    /// The folder to write to [default: `NAME.wesl` beside each `NAME.wgsl`].
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    overwrite: Overwrite,
}

#[derive(Clone, Copy, ValueEnum)]
enum From {
    /// Bevy's until 2026: `#import`, `#define_import_path`, `#ifdef`, `#if`, `#{NAME}`.
    #[value(name = "naga_oil")]
    NagaOil,
}

const WESL_TOML: &str = "wesl.toml";

pub fn run_migrate(arguments: Arguments, form: DiagnosticForm) -> Result<(), Failure> {
    let From::NagaOil = arguments.from;
    let mut sources = SourceSet::default();
    let (files, unread) = read_shaders(&arguments.folder, &mut sources)?;
    let count = files.len();
    let mut migrated = migrate::naga_oil(&sources, &files);
    migrated.diagnostics.splice(0..0, unread);
    let out = arguments.out.as_ref().unwrap_or(&arguments.folder);
    let (texts, declares) = written_texts(&migrated, out);
    let texts = texts.iter().map(|(path, text)| (path.as_str(), text.as_bytes()));
    output::write_folder(out, texts, arguments.overwrite.replace())?;
    print_warnings(&sources, &migrated.diagnostics, form);
    print_summary(&migrated, count, declares)?;
    let is_error = |one: &Diagnostic| one.severity == Severity::Error;
    // The diagnostics have been printed already.
    match migrated.diagnostics.iter().any(is_error) {
        true => Err(Failure::Input(sources, Vec::new())),
        false => Ok(()),
    }
}

/// Paths and texts of shaders.
type ReadShaders = Vec<(String, source::SourceId)>;

/// All shaders below a folder, and what could not be read.
fn read_shaders(
    folder: &Path,
    sources: &mut SourceSet,
) -> Result<(ReadShaders, Vec<Diagnostic>), Failure> {
    let none = || Failure::input(format!("there is no folder `{}`", folder.display()));
    if !folder.is_dir() {
        return Err(none());
    }
    let disk = Disk::new(folder).map_err(|_| none())?;
    let paths = disk.list(&["wgsl"]);
    if paths.is_empty() {
        return Err(Failure::input(format!(
            "there is no `.wgsl` file below `{}`",
            folder.display()
        )));
    }
    let package = Package { name: "package".to_owned(), files: Box::new(disk) };
    let (mut files, mut unread) = (Vec::new(), Vec::new());
    for path in paths {
        match source::read(sources, &package, &path) {
            Ok(Some(id)) => files.push((path, id)),
            Ok(None) => {
                let message = format!("cannot read `{path}`");
                unread.push(Diagnostic::error(codes::UNREADABLE, message));
            }
            Err(error) => unread.push(error.into()),
        }
    }
    Ok((files, unread))
}

/// The texts to write, by path, and whether `wesl.toml` is one of them. A `wesl.toml` that
/// `migrate` did not write is kept.
fn written_texts(migrated: &Migrated, out: &Path) -> (Vec<(String, String)>, bool) {
    let wesl = |path: &String| format!("{}.wesl", path.strip_suffix(".wgsl").unwrap_or(path));
    let mut texts: Vec<(String, String)> =
        migrated.files.iter().map(|(path, text)| (wesl(path), text.clone())).collect();
    let own = wesl_toml(&BTreeSet::new());
    let is_ours = crate::input::read_file(&out.join(WESL_TOML), FILE_BYTES as u64)
        .is_ok_and(|text| text.starts_with(own.as_bytes()));
    let declares = is_ours || project::wesl_home(out).is_none();
    if declares {
        texts.push((WESL_TOML.to_owned(), wesl_toml(&migrated.features)));
    }
    (texts, declares)
}

fn wesl_toml(features: &BTreeSet<String>) -> String {
    let head = "# Written by `lamplight migrate`.\n[package]\nname = \"shaders\"\n\
        edition = \"2026_pre\"\nroot = \".\"\n\n[features]\n";
    features.iter().fold(head.to_owned(), |text, name| text + &format!("{name} = false\n"))
}

fn print_summary(migrated: &Migrated, count: usize, declares: bool) -> Result<(), Failure> {
    let mut out = stdout();
    writeln!(out, "{} of {} migrated", migrated.files.len(), counted_words(count, "file"))?;
    let listed =
        |names: &BTreeSet<String>| names.iter().map(String::as_str).collect::<Vec<_>>().join(", ");
    if !declares && !migrated.features.is_empty() {
        writeln!(out, "features to declare in `wesl.toml`: {}", listed(&migrated.features))?;
    }
    if !migrated.numbers.is_empty() {
        let names = listed(&migrated.numbers);
        writeln!(out, "numbers that conditions compare, with `--set NAME=VALUE`: {names}")?;
    }
    if !migrated.constants.is_empty() {
        let names = listed(&migrated.constants);
        writeln!(out, "values that the text has, with `--constant NAME=VALUE`: {names}")?;
    }
    Ok(())
}
