//! `lamplight compile FILE --target T`: one shader in the languages asked for.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;

use super::failure::{DiagnosticForm, Failure, warn};
use super::input::{Input, Ready};
use super::overwrite::Overwrite;
use super::terminal::{data, is_terminal, stdout};
use crate::bundle::Target;
use crate::compose::Composed;
use crate::diagnostic::{Diagnostic, Diagnostics, codes, nearest};
use crate::emit::{self, Emitted, targets};
use crate::output::{self, Replace};
use crate::validate::{self, validate};

/// Compose, validate and write one shader, a file for each entry point and target.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    input: Input,
    /// Output languages: spirv, glsl450, glsl330, essl300, msl, hlsl, wgsl.
    #[arg(long, value_name = "T,...", value_delimiter = ',', required = true, value_parser = target)]
    target: Vec<Target>,
    /// Folder for the files [default: standard output].
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    overwrite: Overwrite,
}

/// A target by name, as an option's value.
pub fn target(name: &str) -> Result<Target, String> {
    Target::find(name).ok_or_else(|| {
        let names: Vec<&str> = Target::ALL.iter().map(|target| target.name()).collect();
        let hint = nearest(name, names.iter().copied())
            .map_or(String::new(), |near| format!("; did you mean `{near}`?"));
        format!("no such target{hint} (targets: {})", names.join(", "))
    })
}

struct File {
    name: String,
    binary: bool,
    bytes: Vec<u8>,
}

pub fn run(arguments: Arguments, form: DiagnosticForm) -> Result<(), Failure> {
    let Ready { project, composed, context } = arguments.input.compose(form)?;
    let files = validate(&composed).and_then(|validated| {
        warn(&project.sources, &context.own(validate::lint(&composed, &validated)), form);
        emit::check(&composed, &validated)?;
        files(&validated, &composed, &arguments)
    });
    let files = files
        .map_err(|diagnostics| Failure::Input(project.sources, context.explain(diagnostics)))?;
    match &arguments.out {
        Some(folder) => write(&files, folder, arguments.overwrite.replace()),
        None => print(&files),
    }
}

fn files(
    validated: &crate::validate::Validated,
    composed: &Composed,
    arguments: &Arguments,
) -> Result<Vec<File>, Diagnostics> {
    let stem = arguments.input.file.file_name().unwrap_or_default().to_string_lossy();
    let stem = stem.split('.').next().unwrap_or_default();
    let mut files = Vec::new();
    if validated.module.entry_points.is_empty() {
        let message = format!("`{}` has no entry point", arguments.input.file.display());
        return Err(vec![Diagnostic::error(codes::NO_ENTRY_POINT, message)]);
    }
    for point in &validated.module.entry_points {
        let isolated = emit::isolate(validated, &point.name)?;
        for &target in &arguments.target {
            let Emitted { bytes, .. } = emit::emit(&isolated, &point.name, target)
                .map_err(|error| vec![emit::at_entry(error, composed, &point.name)])?;
            let Some(entry) = targets::find(target) else { continue };
            let name = format!(
                "{stem}.{}.{}",
                point.name,
                file_extension(point.stage, target, entry.extension)
            );
            files.push(File { name, binary: entry.binary, bytes });
        }
    }
    Ok(files)
}

/// Files of several targets must not share a name; GLSL files end as glslang expects.
fn file_extension(stage: naga::ShaderStage, target: Target, extension: &str) -> String {
    let stage = match stage {
        naga::ShaderStage::Vertex => "vert",
        naga::ShaderStage::Fragment => "frag",
        _ => "comp",
    };
    match target {
        Target::GLSL450 | Target::GLSL330 | Target::ESSL300 => format!("{target}.{stage}"),
        _ => extension.to_owned(),
    }
}

fn write(files: &[File], folder: &Path, replace: Replace) -> Result<(), Failure> {
    let named = files.iter().map(|file| (file.name.as_str(), &*file.bytes));
    output::write_folder(folder, named, replace)?;
    for file in files {
        writeln!(stdout(), "{}", folder.join(&file.name).display())?;
    }
    Ok(())
}

/// Text goes to standard output, with file names where there are several; one binary alone may too.
fn print(files: &[File]) -> Result<(), Failure> {
    if files.iter().any(|file| file.binary) && (files.len() > 1 || is_terminal()) {
        return Err(Failure::usage("a binary target needs `-o DIR`"));
    }
    for file in files {
        if files.len() > 1 {
            writeln!(stdout(), "// ==== {}", file.name)?;
        }
        data(&file.bytes)?;
    }
    Ok(())
}
