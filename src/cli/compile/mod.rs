//! `lamplight compile FILE --target T`: shaders in the languages asked for.

mod conventions;
mod depfile;
mod files;
mod target;

pub use conventions::{ConventionArguments, parse_convention};
pub use files::file_ending;
pub use target::{TargetChoice, parse_target, wanted_one, wanted_targets};

use std::path::PathBuf;

use clap::Args;

use super::failure::{DiagnosticForm, Failure, print_warnings};
use super::input::{ComposedInput, ErrorContext, InputArguments};
use super::overwrite::Overwrite;
use crate::bundle::Target;
use crate::diagnostic::{Diagnostic, Diagnostics, codes};
use crate::generate::{CompiledShader, Root, entry_points};
use crate::source::SourceSet;
use files::OutputFile;

/// Compile shaders, and write a file for each entry point and target.
#[derive(Args)]
pub struct Arguments {
    /// Paths to root modules; `-` is standard input.
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    #[command(flatten)]
    input: InputArguments,
    #[arg(help = target::wanted_help())]
    #[arg(long, value_name = "T,...|all", value_delimiter = ',', value_parser = wanted_one)]
    #[arg(required_unless_present = "reflection")]
    target: Vec<TargetChoice>,
    #[command(flatten)]
    conventions: ConventionArguments,
    /// Compile only this entry point; may be given several times.
    #[arg(long, value_name = "NAME")]
    entry: Vec<String>,
    /// Also write the reflection of each entry point, as JSON.
    #[arg(long)]
    reflection: bool,
    /// The folder for the files [default: standard output].
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Also write which files the outputs depend on, as a rule for make or ninja.
    #[arg(long, value_name = "FILE", requires = "out")]
    depfile: Option<PathBuf>,
    #[command(flatten)]
    overwrite: Overwrite,
}

pub fn run_compile(arguments: Arguments, form: DiagnosticForm) -> Result<(), Failure> {
    let targets = wanted_targets(&arguments.target);
    let mut made: Vec<OutputFile> = Vec::new();
    let mut failed: Option<Failure> = None;
    let mut sources = SourceSet::default();
    for file in &arguments.files {
        let compiled = arguments
            .input
            .compose(file, sources, form)
            .and_then(|ready| compile_file(&arguments, file, ready, &targets, form));
        sources = match compiled {
            Ok((sources, files)) => {
                made.extend(files);
                sources
            }
            // Errors in one file do not hide those in the next.
            Err(Failure::Input(sources, errors)) => {
                print_warnings(&sources, &errors, form);
                failed = Some(Failure::Input(sources.clone(), Vec::new()));
                sources
            }
            Err(failure) => return Err(failure),
        };
    }
    if let Some(failed) = failed {
        return Err(failed);
    }
    files::refuse_same_names(&made)?;
    let Some(folder) = &arguments.out else { return files::print_files(&made) };
    files::write_files(&made, folder, arguments.overwrite.replace())?;
    match &arguments.depfile {
        Some(path) => {
            let outputs = made.iter().map(|file| folder.join(&file.name));
            depfile::write_depfile(path, outputs, &sources, arguments.overwrite.replace())
        }
        None => Ok(()),
    }
}

/// The files of one root module.
fn compile_file(
    arguments: &Arguments,
    file: &std::path::Path,
    ready: ComposedInput,
    targets: &[Target],
    form: DiagnosticForm,
) -> Result<(SourceSet, Vec<OutputFile>), Failure> {
    let ComposedInput { sources, composed, context } = ready;
    let ErrorContext { graph, settings, options, .. } = &context;
    let conventions = arguments.conventions.chosen().or(context.conventions);
    let root = Root { graph, settings, options, conventions };
    let shaders = entry_points(&composed).and_then(|entries| {
        let entries = chosen_entries(arguments, file, entries)?;
        root.compile(&entries, targets)
    });
    match shaders {
        Ok(shaders) => {
            print_warnings(&sources, &shared_warnings(&context, &shaders), form);
            let stem = files::module_stem(file);
            let of = |shader: &CompiledShader| {
                files::files_of(&stem, shader, targets, arguments.reflection)
            };
            Ok((sources, shaders.iter().flat_map(of).collect()))
        }
        Err(errors) => Err(Failure::Input(sources, context.explain(errors))),
    }
}

/// A warning about something that two entry points share is printed once.
fn shared_warnings(context: &ErrorContext, shaders: &[CompiledShader]) -> Diagnostics {
    let mut found = Diagnostics::new();
    for warning in shaders.iter().flat_map(|shader| &shader.made.warnings) {
        if !found.contains(warning) {
            found.push(warning.clone());
        }
    }
    context.own(found)
}

type EntryStages = Vec<(String, naga::ShaderStage)>;

/// The entry points that `--entry` names, or all.
fn chosen_entries(
    arguments: &Arguments,
    file: &std::path::Path,
    entries: EntryStages,
) -> Result<EntryStages, Diagnostics> {
    if entries.is_empty() {
        let message = format!("`{}` has no entry point", file.display());
        let error = Diagnostic::error(codes::NO_ENTRY_POINT, message);
        return Err(vec![error.note(
            "help: `@vertex`, `@fragment` or `@compute` makes a function one; \
             `lamplight lint` looks at modules without any",
        )]);
    }
    if arguments.entry.is_empty() {
        return Ok(entries);
    }
    let known = || entries.iter().map(|(name, _)| name.as_str());
    let errors: Diagnostics = arguments
        .entry
        .iter()
        .filter(|name| !known().any(|known| known == **name))
        .map(|name| {
            let message = format!("`{}` has no entry point `{name}`", file.display());
            Diagnostic::error(codes::UNKNOWN_ENTRY_POINT, message)
                .suggest(name, known())
                .note(format!("entry points: {}", known().collect::<Vec<_>>().join(", ")))
        })
        .collect();
    if !errors.is_empty() {
        return Err(errors);
    }
    Ok(entries.into_iter().filter(|(name, _)| arguments.entry.contains(name)).collect())
}
