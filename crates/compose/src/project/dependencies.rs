//! Finds the packages that a package depends on, directly or through others, and what a name means
//! in each of them: what its own `wesl.toml` says, and nothing else.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use toml::{Table, Value};

use super::managers::Manager;
use super::wesl_toml::{self, AUTO, DEPENDENCIES, NAME, key_range, parse_tables};
use super::{LIBRARY, library_package, names};
use crate::resolve::{Packages, ROOT, Scope};
use lamplight_diagnostic::source::{self, Disk, Embedded, Package, SourceId, SourceSet, Span};
use lamplight_diagnostic::{Diagnostic, Diagnostics, Severity, codes};
use lamplight_permute::manifest::{self, Features};

/// The package of a root folder, with all that it depends on and the library.
pub fn packages(
    folder: &Path,
    root: Package,
    sources: &mut SourceSet,
    built_in: Embedded,
) -> Result<Packages, Diagnostics> {
    let mut found = find(folder, sources)?;
    let mut dependencies: Vec<Package> = Vec::new();
    for package in found.packages.iter_mut().skip(1) {
        let Some(disk) = package.disk.take() else { continue };
        dependencies.push(Package { name: package.label.clone(), files: Box::new(disk) });
    }
    let mut scopes: Vec<Scope> = found.packages.into_iter().map(|package| package.scope).collect();
    if scopes.is_empty() {
        scopes.push(Scope::default());
    }
    let own = wesl_toml::declared_name(folder);
    let library = match scopes[ROOT].names.get(LIBRARY) {
        Some(replacement) => *replacement,
        None if own.as_deref() == Some(LIBRARY) => ROOT,
        None => {
            dependencies.push(library_package(built_in));
            scopes.push(Scope::default());
            dependencies.len()
        }
    };
    for scope in &mut scopes {
        scope.names.entry(LIBRARY.to_owned()).or_insert(library);
    }
    let mut packages = Packages::scoped(root, dependencies, scopes);
    packages.warnings = found.warnings;
    Ok(packages)
}

/// The features that the root's `wesl.toml` declares, and those of its dependencies.
pub fn features(root: &Path, sources: &mut SourceSet) -> Result<Features, Diagnostics> {
    let mut apart = SourceSet::default();
    let Ok(found) = find(root, &mut apart) else { return Ok(Features::default()) };
    let mut features = Features::default();
    for package in found.packages {
        let folder = &package.folder;
        let Ok((table, id)) = parse_tables(folder, folder, sources) else { continue };
        if table.contains_key("features") {
            features.extend(manifest::read_features(sources, id)?);
        }
    }
    Ok(features)
}

/// The packages by their numbers. There are none where no `wesl.toml` declares the root.
fn find(root: &Path, sources: &mut SourceSet) -> Result<FoundPackages, Diagnostics> {
    wesl_toml::refuse_broken(root, sources)?;
    let mut found = FoundPackages::default();
    let Some(home) = wesl_toml::home(root) else { return Ok(found) };
    let folder = wesl_toml::shown_home(root, &home);
    found.numbers.insert(home, ROOT);
    found.packages.push(FoundPackage {
        label: "package".to_owned(),
        folder,
        disk: None,
        scope: Scope::default(),
    });
    // Breadth first, so that the packages that the root lists keep their names in outputs.
    let mut next = 0;
    while next < found.packages.len() {
        found.collect(next, sources);
        next += 1;
    }
    if found.diagnostics.is_empty() { Ok(found) } else { Err(found.diagnostics) }
}

/// A package that was found.
struct FoundPackage {
    /// Its name in outputs and messages, which no other package has.
    label: String,
    /// The folder of its `wesl.toml`, as it is shown.
    folder: PathBuf,
    /// Its files; `None` for the root.
    disk: Option<Disk>,
    scope: Scope,
}

#[derive(Default)]
struct FoundPackages {
    /// By number, the root's first.
    packages: Vec<FoundPackage>,
    /// By the real folder of the `wesl.toml`: a folder is one package, whatever it is called.
    numbers: BTreeMap<PathBuf, usize>,
    labels: BTreeSet<String>,
    diagnostics: Diagnostics,
    warnings: Diagnostics,
}

/// The `wesl.toml` of the package whose dependencies are added.
#[derive(Clone, Copy)]
struct Importer<'t> {
    number: usize,
    folder: &'t Path,
    id: SourceId,
    text: &'t str,
}

impl Importer<'_> {
    /// Where a dependency is declared.
    fn place(&self, name: &str) -> Span {
        Span::new(self.id, key_range(self.text, name))
    }

    fn error(&self, name: &str, message: String) -> Diagnostic {
        Diagnostic::error(codes::WESL_TOML, message).at(self.place(name), "declared here")
    }
}

impl FoundPackages {
    /// Adds what the `wesl.toml` of a package lists.
    fn collect(&mut self, number: usize, sources: &mut SourceSet) {
        let folder = self.packages[number].folder.clone();
        let (table, id) = match parse_tables(&folder, &folder, sources) {
            Ok(found) => found,
            Err(error) => return self.diagnostics.push(error),
        };
        let text = sources.get(id).text.clone();
        let importer = Importer { number, folder: &folder, id, text: &text };
        self.packages[number].scope.manifest = Some(source::shown_path(&folder.join(NAME)));
        match table.get("dependencies") {
            Some(Value::Table(listed)) => self.declared(importer, &table, listed, sources),
            Some(Value::String(auto)) if auto == AUTO => self.installed(importer, &table, sources),
            _ => {}
        }
        let package = &mut self.packages[number];
        if number == ROOT {
            self.warnings
                .extend(names::warn_of_pairs(&package.scope, &|name| importer.place(name)));
            if let Some(own) = own_name(importer, &table) {
                package.scope.names.entry(own).or_insert(number);
            }
            return;
        }
        // A package may also name itself. Where it does not say how, it is by the name that others
        // have for it.
        let own = wesl_toml::name_in(&table).unwrap_or(&package.label);
        package.scope.names.entry(own.to_owned()).or_insert(number);
    }

    /// Adds what a table of dependencies lists.
    fn declared(
        &mut self,
        importer: Importer<'_>,
        table: &Table,
        listed: &Table,
        sources: &mut SourceSet,
    ) {
        for (name, entry) in listed {
            let path = entry.get("path").and_then(Value::as_str);
            match names::problem(name, path) {
                Some(problem) if problem.severity == Severity::Error => {
                    self.diagnostics.push(problem.at(importer.place(name), "declared here"));
                    continue;
                }
                Some(problem) if importer.number == ROOT => {
                    self.warnings.push(problem.at(importer.place(name), "declared here"));
                }
                _ => {}
            }
            if name == LIBRARY && importer.number != ROOT {
                self.diagnostics.push(replaced_elsewhere(importer));
                continue;
            }
            let place = match path {
                Some(path) => Ok(importer.folder.join(path)),
                None => {
                    let package = entry.get("package").and_then(Value::as_str).unwrap_or(name);
                    Manager::of(importer.folder, wesl_toml::manager_of(table))
                        .and_then(|manager| manager.find(importer.folder, package))
                }
            };
            match place {
                Ok(place) => self.add(importer, name, &place, sources),
                Err(reason) => {
                    let message = format!("cannot find dependency `{name}`: {reason}");
                    self.diagnostics.push(importer.error(name, message));
                }
            }
        }
    }

    /// `dependencies = "auto"`: what the package manager's file lists and has a `wesl.toml`.
    fn installed(&mut self, importer: Importer<'_>, table: &Table, sources: &mut SourceSet) {
        let manager = match Manager::of(importer.folder, wesl_toml::manager_of(table)) {
            Ok(manager) => manager,
            Err(reason) => {
                let error = Diagnostic::error(codes::WESL_TOML, reason);
                return self.diagnostics.push(error.at(importer.place(""), "asked for here"));
            }
        };
        let is_root = importer.number == ROOT;
        for (name, package) in manager.listed(importer.folder).into_iter().take(DEPENDENCIES) {
            let place = manager.find(importer.folder, &package);
            let Some(place) = place.ok().filter(|place| place.join(NAME).is_file()) else {
                continue;
            };
            if let Some(Diagnostic { message, notes, .. }) = names::problem(&name, None) {
                // The package manager allows the name, so this is no mistake of the author.
                let warning = Diagnostic::warning(codes::WESL_TOML, message);
                let warning = notes.into_iter().fold(warning, Diagnostic::note);
                self.warnings.extend(is_root.then(|| warning.at(importer.place(""), "found so")));
                continue;
            }
            if name == LIBRARY {
                if !is_root {
                    continue;
                }
                self.warnings.push(replaced_by_installed(importer, &place));
            }
            self.add(importer, &name, &place, sources);
        }
    }

    /// Adds the dependency in `folder`, and gives the importer its name.
    fn add(&mut self, importer: Importer<'_>, name: &str, folder: &Path, sources: &mut SourceSet) {
        match self.number(importer, name, folder, sources) {
            Ok(number) => {
                let scope = &mut self.packages[importer.number].scope;
                scope.names.insert(name.to_owned(), number);
            }
            Err(error) => self.diagnostics.push(error),
        }
    }

    /// The number of the package in a folder.
    fn number(
        &mut self,
        importer: Importer<'_>,
        name: &str,
        folder: &Path,
        sources: &mut SourceSet,
    ) -> Result<usize, Diagnostic> {
        if folder.join(NAME).is_file() {
            parse_tables(folder, folder, sources)
                .map_err(|error| error.at(importer.place(name), "of this dependency"))?;
        }
        let missing = || importer.error(name, format!("dependency `{name}` has no `wesl.toml`"));
        let root = wesl_toml::declared_root(folder).ok_or_else(missing)?;
        let unreadable = |error: std::io::Error| {
            let message = format!("cannot read dependency `{name}`: {error}");
            Diagnostic::error(codes::UNREADABLE, message).at(importer.place(name), "declared here")
        };
        let real = folder.canonicalize().map_err(unreadable)?;
        if let Some(number) = self.numbers.get(&real) {
            return Ok(*number);
        }
        let disk = Disk::new(root).map_err(unreadable)?;
        if !disk.is_below(&real) {
            let message = format!("the root of dependency `{name}` leads out of its folder");
            return Err(Diagnostic::error(codes::OUTSIDE_ROOT, message)
                .at(importer.place(name), "declared here"));
        }
        let number = self.packages.len();
        self.numbers.insert(real, number);
        let label = self.label(importer.number, name);
        let (folder, scope) = (folder.to_owned(), Scope::default());
        self.packages.push(FoundPackage { label, folder, disk: Some(disk), scope });
        Ok(number)
    }

    /// The name of a package in outputs: the first that it was found by. Where another package has
    /// this name, that of the package that lists it comes before, as in `lamps/noise`.
    fn label(&mut self, importer: usize, name: &str) -> String {
        let label = match self.labels.contains(name) {
            false => name.to_owned(),
            true => format!("{}/{name}", self.packages[importer].label),
        };
        self.labels.insert(label.clone());
        label
    }
}

/// The name by which the root package can import itself: what its `wesl.toml` says, or else its
/// package manager's file. Only the former may be the name of the library.
fn own_name(importer: Importer<'_>, table: &Table) -> Option<String> {
    let declared = wesl_toml::name_in(table).map(str::to_owned);
    declared.or_else(|| {
        let manager = Manager::of(importer.folder, wesl_toml::manager_of(table)).ok()?;
        let name = manager.own_name(importer.folder)?;
        (name != LIBRARY && names::problem(&name, None).is_none()).then_some(name)
    })
}

/// The error for a package other than the root that wants to replace the library.
fn replaced_elsewhere(importer: Importer<'_>) -> Diagnostic {
    let message = format!("only the package that is compiled may replace `{LIBRARY}`");
    importer
        .error(LIBRARY, message)
        .note(format!("every package can import `{LIBRARY}` without declaring it"))
        .note("help: give this dependency another name")
}

/// The warning that an installed package has the place of the library.
fn replaced_by_installed(importer: Importer<'_>, place: &Path) -> Diagnostic {
    let place = source::shown_path(place);
    let message = format!("the installed package `{place}` replaces the built-in `{LIBRARY}`");
    Diagnostic::warning(codes::WESL_TOML, message)
        .at(importer.place(""), "listed by the package manager's file")
        .note(format!(
            "help: list the dependencies by name, with `{LIBRARY}` if this is what you want"
        ))
}
