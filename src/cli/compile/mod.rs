//! `lamplight compile FILE --target T`: shaders in the languages asked for.

mod conventions;
mod depfile;
mod files;
mod target;

pub use conventions::{ConventionArguments, SpirvArguments, parse_convention};
pub use depfile::write_depfile;
pub use files::file_ending;
pub use target::{TargetChoice, parse_target, wanted_one, wanted_targets};

use std::path::PathBuf;

use clap::Args;

use super::failure::{DiagnosticForm, Failure, print_warnings};
use super::input::{ComposedInput, ErrorContext, InputArguments};
use super::overwrite::Overwrite;
use crate::bundle::Target;
use crate::diagnostic::{Diagnostic, Diagnostics, Severity, codes};
use crate::generate::{CompiledShader, Optimiser, Root, entry_points};
use crate::source::SourceSet;
use crate::spirv_opt::SpirvOpt;
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
    target: Vec<TargetChoice>,
    #[command(flatten)]
    conventions: ConventionArguments,
    #[command(flatten)]
    spirv: SpirvArguments,
    /// Fail if one of `all` targets lacks what a shader needs, instead of leaving it out.
    #[arg(long)]
    strict: bool,
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
    let targets = arguments.targets();
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
            // Errors in one file do not hide those in the next. A program that is missing is missing
            // for all.
            Err(Failure::Input(sources, errors))
                if errors.iter().all(|error| error.code != codes::OPTIMISER_FAILED) =>
            {
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
            write_depfile(path, outputs, &sources, arguments.overwrite.replace())
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
    let conventions = arguments.spirv.with(arguments.conventions).or(context.conventions);
    let numbers = context.numbers.as_str();
    let optimiser: Option<&dyn Optimiser> = Some(&SpirvOpt);
    let root = Root { graph, settings, options, conventions, optimiser, numbers };
    let shaders = entry_points(&composed).and_then(|entries| {
        let entries = chosen_entries(arguments, file, entries)?;
        compile_able(&root, &entries, targets, &arguments.optional())
    });
    match shaders {
        Ok((shaders, left_out)) => {
            let mut warnings = context.own(left_out);
            // What keeps a target out is a warning for the others too.
            let is_told = |one: &Diagnostic| {
                warnings.iter().any(|known| known.code == one.code && known.labels == one.labels)
            };
            let shared = shared_warnings(&context, &shaders);
            let shared: Diagnostics = shared.into_iter().filter(|one| !is_told(one)).collect();
            warnings.extend(shared);
            print_warnings(&sources, &warnings, form);
            let stem = files::module_stem(file);
            let of = |shader: &CompiledShader| {
                files::files_of(&stem, shader, targets, arguments.reflection)
            };
            Ok((sources, shaders.iter().flat_map(of).collect()))
        }
        Err(errors) => Err(Failure::Input(sources, context.explain(errors))),
    }
}

impl Arguments {
    /// The targets that are asked for; WGSL, where nothing else is, so that a file can be checked
    /// without a choice.
    fn targets(&self) -> Vec<Target> {
        match self.target.is_empty() && !self.reflection {
            true => vec![Target::WGSL],
            false => wanted_targets(&self.target),
        }
    }

    /// The targets that are left out if they lack what a shader needs.
    fn optional(&self) -> Vec<Target> {
        let is_all = self.target.iter().any(|choice| matches!(choice, TargetChoice::All));
        let is_named = |target: &Target| {
            let is_it =
                |choice: &TargetChoice| matches!(choice, TargetChoice::One(one) if one == target);
            self.target.iter().any(is_it)
        };
        let all = Target::ALL.iter().filter(|target| !is_named(target)).copied();
        if is_all && !self.strict { all.collect() } else { Vec::new() }
    }
}

/// Compiles for the targets that have what the entry points need. An optional target that lacks it
/// is a warning; if all do, the errors are those of the first.
fn compile_able(
    root: &Root<'_>,
    entries: &[(String, naga::ShaderStage)],
    targets: &[Target],
    optional: &[Target],
) -> Result<(Vec<CompiledShader>, Diagnostics), Diagnostics> {
    let errors = match root.compile(entries, targets) {
        Ok(shaders) => return Ok((shaders, Vec::new())),
        Err(errors) if optional.is_empty() || !errors.iter().all(is_of_target) => {
            return Err(errors);
        }
        Err(errors) => errors,
    };
    let (mut able, mut left_out) = (Vec::new(), Diagnostics::new());
    for target in targets {
        match root.compile(entries, &[*target]) {
            Ok(_) => able.push(*target),
            Err(errors) if optional.contains(target) && errors.iter().all(is_of_target) => {
                left_out.extend(errors.into_iter().map(|error| without_target(*target, error)));
            }
            Err(errors) => return Err(errors),
        }
    }
    if able.is_empty() {
        return Err(errors);
    }
    Ok((root.compile(entries, &able)?, left_out))
}

/// Whether another target might not have an error.
fn is_of_target(error: &Diagnostic) -> bool {
    [
        codes::EMIT_FAILED,
        codes::NOT_PORTABLE,
        codes::BROWSERS_REFUSE,
        codes::NON_UNIFORM_BARRIER,
        codes::NON_UNIFORM_DERIVATIVE,
        codes::OVERRIDE_WITHOUT_VALUE,
    ]
    .contains(&error.code)
}

/// The warning that a target is left out.
fn without_target(target: Target, error: Diagnostic) -> Diagnostic {
    Diagnostic { severity: Severity::Warning, ..error }
        .note(format!("no output for target `{target}` is written; `--strict` makes this an error"))
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
