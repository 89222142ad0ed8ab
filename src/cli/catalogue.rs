//! `lamplight catalogue`: the library's documentation as Markdown with plots.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;

use super::cost;
use super::failure::Failure;
use super::overwrite::Overwrite;
use super::terminal::stdout;
use crate::LIBRARY_FILES;
use crate::catalogue::cost::is_record;
use crate::catalogue::{self as library, figure};
use crate::check::catalogue::{self, CatalogueFiles};
use crate::diagnostic::Diagnostics;
use crate::picture::figure::{Pictures, draw_figures, stale_figures};
use crate::source::{Embedded, SourceSet};
use crate::{input, output};

/// The most bytes of a picture that is kept.
const MOST_BYTES: u64 = 1 << 20;

/// Write the library's catalogue: a page for each module, with plots and pictures.
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
    /// Write the pages and plots only, and draw no pictures of functions.
    #[arg(long, conflicts_with_all = ["modules", "costs"])]
    without_pictures: bool,
    /// Write nothing; fail if a file would change.
    #[arg(long)]
    check: bool,
    #[command(flatten)]
    overwrite: Overwrite,
}

pub fn run_catalogue(arguments: Arguments, gpus: cost::OpenedGpus) -> Result<(), Failure> {
    if let Some(path) = &arguments.costs {
        let text = cost::record_costs(gpus)?.text("cargo xtask docs --costs");
        let replace = arguments.overwrite.replace();
        return Ok(output::write_file(path, text.as_bytes(), is_record, replace)?);
    }
    let (folder, files) = match &arguments.modules {
        Some(folder) => (folder, catalogue::made_modules(LIBRARY_FILES)),
        None => (&arguments.output, catalogue::catalogue_files(LIBRARY_FILES)),
    };
    let files = files.map_err(|(sources, problems)| Failure::Input(sources, problems))?;
    let changed = changed_files(folder, &files);
    let is_drawn = arguments.modules.is_none() && !arguments.without_pictures;
    if arguments.check {
        let mut outdated: Vec<PathBuf> = changed.into_iter().map(|(path, _)| path).collect();
        if is_drawn {
            outdated.extend(
                with_figures(folder, stale_figures)?
                    .iter()
                    .map(|path| folder.join(figure::picture_path(path))),
            );
        }
        return match outdated.is_empty() {
            true => Ok(()),
            false => Err(Failure::check(outdated_message(&outdated))),
        };
    }
    // A picture in the folder that still shows its figure is kept.
    let pictures = if is_drawn { with_figures(folder, draw_figures)? } else { Pictures::new() };
    let texts = files.iter().map(|(path, text)| (path.as_str(), text.as_bytes()));
    let drawn = pictures.iter().map(|(path, png)| (path.as_str(), png.as_slice()));
    output::write_folder(folder, texts.chain(drawn), arguments.overwrite.replace())?;
    Ok(writeln!(
        stdout(),
        "{}: {} files, {} changed; {} pictures",
        folder.display(),
        files.len(),
        changed.len(),
        pictures.len()
    )?)
}

/// A function over figures. Its arguments are the library, the kinds of figures, all figures, and a function
/// that reads a figure's picture from the folder.
type FigureWork<T> = fn(
    Embedded,
    &figure::Kinds,
    &figure::Figures,
    &(dyn Fn(&str) -> Option<Vec<u8>> + Sync),
) -> Result<T, Diagnostics>;

/// Calls `work` with the library's figures and their pictures in the folder.
fn with_figures<T>(folder: &Path, work: FigureWork<T>) -> Result<T, Failure> {
    let mut sources = SourceSet::default();
    let read = |sources: &mut SourceSet| {
        let kinds = figure::library_kinds(LIBRARY_FILES, sources)?;
        let figures = figure::library_figures(
            LIBRARY_FILES,
            sources,
            &library::library_modules(LIBRARY_FILES),
            &kinds,
        )?;
        work(LIBRARY_FILES, &kinds, &figures, &|path| {
            let file = folder.join(figure::picture_path(path));
            input::read_file(&file, MOST_BYTES).ok()
        })
    };
    read(&mut sources).map_err(|problems| Failure::Input(sources, problems))
}

fn changed_files(folder: &Path, files: &CatalogueFiles) -> Vec<(PathBuf, String)> {
    let differs = |(path, text): &(PathBuf, String)| {
        input::read_file(path, text.len() as u64).ok().as_deref() != Some(text.as_bytes())
    };
    files.iter().map(|(path, text)| (folder.join(path), text.clone())).filter(differs).collect()
}

fn outdated_message(outdated: &[PathBuf]) -> String {
    let names: Vec<String> = outdated.iter().map(|path| path.display().to_string()).collect();
    format!("not up to date: {}\nrun: cargo xtask docs", names.join(", "))
}
