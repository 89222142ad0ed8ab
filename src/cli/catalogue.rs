//! `lamplight catalogue`: the library's documentation as Markdown with plots.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;

use super::cost;
use super::failure::Failure;
use super::overwrite::Overwrite;
use super::terminal::stdout;
use crate::catalogue::cost::is_record;
use crate::proof::catalogue::{self, Files};
use crate::{input, output};

/// Write the library's catalogue: a page for each module, with plots.
#[derive(Args)]
pub struct Arguments {
    /// The folder to write to.
    #[arg(
        short,
        long = "out",
        alias = "output",
        value_name = "DIR",
        default_value = "docs/catalogue"
    )]
    output: PathBuf,
    /// Instead, write the modules that are generated from data into this folder of the library's
    /// sources.
    #[arg(long, value_name = "DIR", conflicts_with = "output")]
    modules: Option<PathBuf>,
    /// Measure the cost of functions and axes on GPUs, and write it to this file, which the pages
    /// read.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["output", "modules", "check"])]
    pub costs: Option<PathBuf>,
    /// Write nothing; fail if a file would change.
    #[arg(long)]
    check: bool,
    #[command(flatten)]
    overwrite: Overwrite,
}

pub fn run_catalogue(arguments: Arguments, gpus: cost::Opened) -> Result<(), Failure> {
    if let Some(path) = &arguments.costs {
        let text = cost::record_costs(gpus)?.text("cargo xtask docs --costs");
        let replace = arguments.overwrite.replace();
        return Ok(output::write_file(path, text.as_bytes(), is_record, replace)?);
    }
    let (folder, files) = match &arguments.modules {
        Some(folder) => (folder, catalogue::made_modules()),
        None => (&arguments.output, catalogue::catalogue_files()),
    };
    let files = files.map_err(|(sources, problems)| Failure::Input(sources, problems))?;
    let changed = changed_files(folder, &files);
    if arguments.check {
        return if changed.is_empty() {
            Ok(())
        } else {
            Err(Failure::check(outdated_message(&changed)))
        };
    }
    let files_as_bytes = files.iter().map(|(path, text)| (path.as_str(), text.as_bytes()));
    output::write_folder(folder, files_as_bytes, arguments.overwrite.replace())?;
    Ok(writeln!(
        stdout(),
        "{}: {} files, {} changed",
        folder.display(),
        files.len(),
        changed.len()
    )?)
}

fn changed_files(folder: &Path, files: &Files) -> Vec<(PathBuf, String)> {
    let differs = |(path, text): &(PathBuf, String)| {
        input::read_file(path, text.len() as u64).ok().as_deref() != Some(text.as_bytes())
    };
    files.iter().map(|(path, text)| (folder.join(path), text.clone())).filter(differs).collect()
}

fn outdated_message(changed: &[(PathBuf, String)]) -> String {
    let names: Vec<String> = changed.iter().map(|(path, _)| path.display().to_string()).collect();
    format!("not up to date: {}\nrun: cargo xtask docs", names.join(", "))
}
