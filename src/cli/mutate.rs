//! `lamplight mutate`: mutation testing. Mistakes are put into a package's functions, to see how
//! many of them its numeric cases notice.

use std::io::Write;
use std::path::PathBuf;
use std::sync::{Arc, Mutex};

use clap::Args;

use super::failure::Failure;
use super::terminal::stdout;
use crate::LIBRARY_FILES;
use crate::check::library::Library;
use crate::mutate::{SHARED_HEAD, measure_coverage, run_mutants, run_shared_mutants};
use crate::source::{Disk, SourceSet};

/// Put mistakes into functions, one at a time, and see whether the numeric cases notice.
#[derive(Args)]
pub struct Arguments {
    /// Modules (`lighting::spot`, `lighting`) [default: all].
    module: Vec<String>,
    /// Root directory of the package [default: the library of this program].
    #[arg(long, value_name = "DIR")]
    root: Option<PathBuf>,
    /// Instead, report the statements and branches that no case reaches.
    #[arg(long)]
    coverage: bool,
    /// Put mistakes into a function and its reference alike: only numbers that cases state, and laws, can notice them.
    #[arg(long, conflicts_with = "coverage")]
    shared: bool,
}

pub fn run_mutate(arguments: Arguments) -> Result<(), Failure> {
    let library = open_library(&arguments)?;
    let modules = requested_modules(&library, &arguments.module)?;
    match arguments {
        Arguments { coverage: true, .. } => print_coverage(&library, &modules),
        Arguments { shared: true, .. } => print_shared(&library, &modules),
        _ => print_survivors(&library, &modules),
    }
}

fn open_library(arguments: &Arguments) -> Result<Library, Failure> {
    let Some(root) = &arguments.root else { return Ok(Library::shipped(LIBRARY_FILES)) };
    let disk = Disk::new(root)
        .map_err(|error| Failure::input(format!("cannot read `{}`: {error}", root.display())))?;
    Ok(Library::new("lamplight", Arc::new(disk), Vec::new()))
}

/// The modules of those paths, or below them.
fn requested_modules(library: &Library, requested: &[String]) -> Result<Vec<String>, Failure> {
    let all = library.modules();
    let below = |module: &str, path: &str| {
        module.strip_prefix(path).is_some_and(|rest| rest.is_empty() || rest.starts_with("::"))
    };
    if let Some(unknown) =
        requested.iter().find(|path| !all.iter().any(|module| below(module, path)))
    {
        return Err(Failure::input(format!("there is no module `{unknown}`")));
    }
    Ok(all
        .into_iter()
        .filter(|module| requested.is_empty() || requested.iter().any(|path| below(module, path)))
        .collect())
}

fn print_survivors(library: &Library, modules: &[String]) -> Result<(), Failure> {
    let sources = Mutex::new(SourceSet::default());
    let report = run_mutants(library, &sources, modules);
    let report = report.map_err(|diagnostics| {
        Failure::Input(sources.into_inner().unwrap_or_default(), diagnostics)
    })?;
    write!(stdout(), "{}", report.survivors())?;
    if modules.len() == library.modules().len() {
        report.stale.iter().try_for_each(|entry| {
            writeln!(stdout(), "listed as equivalent, but is none that survived: {entry}")
        })?;
    }
    writeln!(stdout(), "{} more are listed as equal to the code as written", report.equivalent())?;
    writeln!(stdout(), "{}", report.summary())?;
    if report.passed() { Ok(()) } else { Err(Failure::check("the cases notice too few mistakes")) }
}

fn print_shared(library: &Library, modules: &[String]) -> Result<(), Failure> {
    let sources = Mutex::new(SourceSet::default());
    let report = run_shared_mutants(library, &sources, modules);
    let report = report.map_err(|diagnostics| {
        Failure::Input(sources.into_inner().unwrap_or_default(), diagnostics)
    })?;
    writeln!(stdout(), "{SHARED_HEAD}")?;
    report.functions().iter().try_for_each(|(_, row)| writeln!(stdout(), "{row}"))?;
    write!(stdout(), "\n{}", report.missed())?;
    writeln!(stdout(), "{}", report.summary())?;
    match report.passed() {
        true => Ok(()),
        false => Err(Failure::check("the cases notice too few mistakes that the references share")),
    }
}

fn print_coverage(library: &Library, modules: &[String]) -> Result<(), Failure> {
    let sources = Mutex::new(SourceSet::default());
    let found = measure_coverage(library, &sources, modules);
    let found = found.map_err(|diagnostics| {
        Failure::Input(sources.into_inner().unwrap_or_default(), diagnostics)
    })?;
    found.iter().try_for_each(|module| write!(stdout(), "{module}"))?;
    let (all, missed) = found
        .iter()
        .fold((0, 0), |sum, module| (sum.0 + module.blocks, sum.1 + module.uncovered.len()));
    writeln!(stdout(), "reached {} of {all} blocks", all - missed)?;
    if missed == 0 { Ok(()) } else { Err(Failure::check("some statements are reached by no case")) }
}
