//! `lamplight lint`: checks a whole package, whether or not anything reaches a module.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;

use super::failure::{DiagnosticForm, Failure, print_warnings};
use super::input::{self, parse_feature};
use super::{features, includes};
use crate::cli::terminal::stdout;
use crate::diagnostic::{Diagnostics, Severity};
use crate::generate::summary::counted_words;
use crate::lint::{self, EXTENSIONS, Request};
use crate::permute::{Setting, Settings};
use crate::project;
use crate::source::SourceSet;

/// Check every module of a package, also those that no shader uses.
#[derive(Args)]
pub struct Arguments {
    /// Modules, or folders whose modules are all checked [default: the package here].
    path: Vec<PathBuf>,
    /// Choose the value of a setting that no manifest declares.
    #[arg(long, value_name = "AXIS=VALUE", value_delimiter = ',', value_parser = input::axis_value)]
    set: Vec<(String, Setting)>,
    /// Turn a feature on, or turn it off with `=false`.
    #[arg(long, value_name = "NAME[=BOOL]", value_delimiter = ',', value_parser = parse_feature)]
    feature: Vec<(String, Setting)>,
    #[command(flatten)]
    features: features::Arguments,
    #[command(flatten)]
    includes: includes::Arguments,
}

pub fn run_lint(arguments: Arguments, form: DiagnosticForm) -> Result<(), Failure> {
    let (mut modules, mut errors, mut warnings) = (0, 0, 0);
    let settings = Settings {
        values: arguments.set.iter().chain(&arguments.feature).cloned().collect(),
        integers: input::numbered(&arguments.set),
        undeclared: arguments.features.undeclared(None),
        constants: arguments.features.constants(),
        ..Settings::default()
    };
    let mut last = SourceSet::default();
    for (root, paths) in packages_of(&arguments.path)? {
        let mut sources = SourceSet::default();
        let found = match lint_package(&root, &paths, &settings, &arguments.includes, &mut sources)
        {
            Ok(found) => found,
            Err(diagnostics) => lint::Linted { diagnostics, modules: 0 },
        };
        print_warnings(&sources, &found.diagnostics, form);
        let is_error = |severity| severity == Severity::Error;
        let count = found.diagnostics.iter().filter(|found| is_error(found.severity)).count();
        errors += count;
        warnings += found.diagnostics.len() - count;
        modules += found.modules;
        last = sources;
    }
    let counted = [(modules, "module"), (errors, "error"), (warnings, "warning")];
    writeln!(stdout(), "{}", counted.map(|(count, what)| counted_words(count, what)).join(", "))?;
    // The errors have been printed already.
    if errors == 0 { Ok(()) } else { Err(Failure::Input(last, Vec::new())) }
}

/// Roots of packages, each with what was asked for below it.
fn packages_of(requested: &[PathBuf]) -> Result<Vec<(PathBuf, Vec<PathBuf>)>, Failure> {
    let mut found: Vec<(PathBuf, Vec<PathBuf>)> = Vec::new();
    if requested.is_empty() {
        let here = project::package_above(Path::new(""));
        let none = "there is no package here: name its folder, or modules";
        let root = here.ok_or_else(|| Failure::usage(none))?;
        return Ok(vec![(root.clone(), vec![root])]);
    }
    for path in requested {
        if !path.exists() {
            let message = format!("there is no file or folder `{}`", path.display());
            return Err(Failure::input(message));
        }
        let root = if path.is_dir() {
            project::package_at(path).unwrap_or_else(|| path.clone())
        } else {
            project::root_of(path)
        };
        // The root of a package may be below the folder that was named.
        let path =
            if path.is_dir() && root.starts_with(path) { root.clone() } else { path.clone() };
        match found.iter_mut().find(|(known, _)| *known == root) {
            Some((_, paths)) => paths.push(path),
            None => found.push((root, vec![path])),
        }
    }
    Ok(found)
}

fn lint_package(
    root: &Path,
    requested: &[PathBuf],
    settings: &Settings,
    includes: &includes::Arguments,
    sources: &mut SourceSet,
) -> Result<lint::Linted, Diagnostics> {
    let mut packages = project::packages(root, sources)?;
    includes.apply(&mut packages)?;
    let manifest = project::manifest(root, sources)?;
    let mut settings = settings.clone();
    if manifest.is_none() {
        project::features(root, sources)?.complete(&mut settings);
    }
    let all = packages.root.files.list(EXTENSIONS);
    let mut paths: Vec<String> = Vec::new();
    for path in requested {
        if path.is_dir() {
            let below = project::relative_folder(path, root).map_err(|error| vec![error])?;
            paths.extend(all.iter().filter(|file| file.starts_with(&below)).cloned());
        } else {
            paths.push(project::relative(path, root).map_err(|error| vec![error])?);
        }
    }
    paths.sort();
    paths.dedup();
    let declared = manifest.iter().flat_map(|manifest| &manifest.warnings);
    let warnings: Diagnostics = packages.warnings.iter().chain(declared).cloned().collect();
    let request = Request {
        packages: &packages,
        manifest: manifest.as_ref(),
        settings: &settings,
        paths: &paths,
    };
    let mut found = lint::lint(sources, &request);
    found.diagnostics.splice(0..0, warnings);
    Ok(found)
}
