//! `lamplight fmt`: lays out shaders anew. Only blanks change.

use std::io::Write;
use std::path::{Component, Path, PathBuf};

use clap::Args;
use similar::TextDiff;

use super::failure::{DiagnosticForm, Failure, print_warnings};
use super::input::LanguageName;
use super::stream::{STANDARD_INPUT, read_stream};
use crate::bundle::Language;
use crate::cli::terminal::stdout;
use crate::compose::glsl::named_stage;
use crate::diagnostic::{Diagnostic, Diagnostics, codes};
use crate::format::{self, Options};
use crate::generate::summary::counted_words;
use crate::limits::FILE_BYTES;
use crate::source::{Disk, Files, SourceSet};
use crate::{input, output};

/// Format shaders: only blanks and line breaks change. `[format]` in `lamplight.toml` or
/// `wesl.toml` has the options.
#[derive(Args)]
pub struct Arguments {
    /// Shaders, or folders whose shaders are all formatted.
    #[arg(required = true)]
    path: Vec<PathBuf>,
    /// Change nothing: print the differences, and fail if there are some.
    #[arg(long)]
    check: bool,
    /// Format standard input to standard output, as if it were the file PATH, which need not exist.
    #[arg(long, conflicts_with = "check")]
    stdin: bool,
    /// The language of files whose names do not tell it.
    #[arg(long, value_enum)]
    lang: Option<LanguageName>,
}

/// Extensions of the files that are formatted in folders.
const EXTENSIONS: &[&str] = &[
    "wesl", "wgsl", "glsl", "vert", "frag", "comp", "geom", "tesc", "tese", "mesh", "task", "rgen",
    "rmiss", "rchit", "rahit", "rint", "rcall",
];

/// What became of the files.
#[derive(Default)]
struct Outcome {
    files: usize,
    changed: usize,
    sources: SourceSet,
    errors: Diagnostics,
}

pub fn run_fmt(arguments: Arguments, form: DiagnosticForm) -> Result<(), Failure> {
    if arguments.stdin {
        return format_stdin(&arguments, form);
    }
    let mut outcome = Outcome::default();
    for file in files_of(&arguments.path)? {
        format_file(&file, &arguments, &mut outcome)?;
    }
    print_warnings(&outcome.sources, &outcome.errors, form);
    let Outcome { files, changed, sources, errors } = outcome;
    let counted = [(files, "file"), (errors.len(), "error")];
    let counted = counted.map(|(count, what)| counted_words(count, what)).join(", ");
    let verb = if arguments.check { "to format" } else { "changed" };
    writeln!(stdout(), "{counted}, {changed} {verb}")?;
    match (errors.is_empty(), arguments.check && changed > 0) {
        // The errors have been printed already.
        (false, _) => Err(Failure::Input(sources, Vec::new())),
        (true, true) => Err(Failure::check(
            "these files are not formatted: run the command without `--check`".to_owned(),
        )),
        (true, false) => Ok(()),
    }
}

/// The files that were asked for, in the order of the arguments.
fn files_of(requested: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    let mut files = Vec::new();
    for path in requested {
        if !path.exists() {
            let message = format!("there is no file or folder `{}`", path.display());
            return Err(Failure::input(message));
        }
        if path.is_dir() {
            files.extend(Disk::new(path)?.list(EXTENSIONS).iter().map(|file| path.join(file)));
        } else {
            files.push(path.clone());
        }
    }
    Ok(files)
}

fn format_file(file: &Path, arguments: &Arguments, outcome: &mut Outcome) -> Result<(), Failure> {
    let language = language_of(file, arguments)?;
    let options = options_of(file, &mut outcome.sources)?;
    outcome.files += 1;
    let text = match read_text(file) {
        Ok(text) => text,
        Err(error) => {
            outcome.errors.push(error);
            return Ok(());
        }
    };
    let id = outcome.sources.add(file.display().to_string(), text.clone());
    let formatted = format::format_text(&text, id, language, &options);
    outcome.errors.extend(formatted.diagnostics);
    if formatted.text == text {
        return Ok(());
    }
    outcome.changed += 1;
    if arguments.check {
        print_difference(file, &text, &formatted.text)?;
    } else {
        output::write(file, formatted.text.as_bytes())?;
    }
    Ok(())
}

fn format_stdin(arguments: &Arguments, form: DiagnosticForm) -> Result<(), Failure> {
    let [file] = arguments.path.as_slice() else {
        return Err(Failure::usage("with `--stdin`, name one file"));
    };
    let mut sources = SourceSet::default();
    let language = language_of(file, arguments)?;
    let options = options_of(file, &mut sources)?;
    let text = read_stream(Path::new(STANDARD_INPUT))?;
    let id = sources.add(file.display().to_string(), text.clone());
    let formatted = format::format_text(&text, id, language, &options);
    stdout().write_all(formatted.text.as_bytes())?;
    print_warnings(&sources, &formatted.diagnostics, form);
    match formatted.diagnostics.is_empty() {
        true => Ok(()),
        // The errors have been printed already.
        false => Err(Failure::Input(sources, Vec::new())),
    }
}

fn language_of(file: &Path, arguments: &Arguments) -> Result<Language, Failure> {
    let extension = file.extension().unwrap_or_default().to_string_lossy();
    match (arguments.lang, &*extension) {
        (Some(name), _) => Ok(name.into()),
        (None, "wesl" | "wgsl") => Ok(Language::Wesl),
        (None, known) if EXTENSIONS.contains(&known) => Ok(Language::Glsl),
        (None, _) if named_stage(&file.to_string_lossy()).is_some() => Ok(Language::Glsl),
        (None, _) => Err(Failure::usage(format!(
            "cannot tell the language of `{}` from its name: add `--lang`",
            file.display()
        ))),
    }
}

/// The options for a file: those of the nearest manifest.
fn options_of(file: &Path, sources: &mut SourceSet) -> Result<Options, Failure> {
    let mut file = std::path::absolute(file)?;
    // Not all folders in a path with `..` are above the file.
    if file.components().any(|part| part == Component::ParentDir) {
        let folder = file.parent().and_then(|folder| folder.canonicalize().ok());
        if let Some((folder, name)) = folder.zip(file.file_name()) {
            file = folder.join(name);
        }
    }
    let read =
        |path: &Path| String::from_utf8(input::read_file(path, FILE_BYTES as u64).ok()?).ok();
    format::options_for(&file, Options::default(), sources, read)
        .map_err(|errors| Failure::Input(std::mem::take(sources), errors))
}

fn read_text(file: &Path) -> Result<String, Diagnostic> {
    let shown = file.display();
    let bytes = input::read_file(file, FILE_BYTES as u64).map_err(|error| {
        Diagnostic::error(codes::UNREADABLE, format!("cannot read `{shown}`: {error}"))
    })?;
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        Diagnostic::error(codes::NOT_UTF8, format!("`{shown}` is not UTF-8: byte {at} is wrong"))
    })
}

fn print_difference(file: &Path, old: &str, new: &str) -> Result<(), Failure> {
    let name = file.display().to_string();
    let difference = TextDiff::from_lines(old, new);
    let mut difference = difference.unified_diff();
    Ok(write!(stdout(), "{}", difference.context_radius(2).header(&name, &name))?)
}
