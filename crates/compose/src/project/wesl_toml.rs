//! Reads `wesl.toml`. In the community's specification "wesl.toml file format" its keys are in the
//! table `package`. Older tools read them at the top level, so both are accepted.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use toml::{Table, Value};

use crate::project::managers::Manager;
use lamplight_diagnostic::source::{
    self, Disk, Files, LIMITS, Package, ReadError, SourceId, SourceSet, Span, is_inside,
};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_files::input;
use lamplight_permute::manifest::{self, Features};

const NAME: &str = "wesl.toml";
/// The most packages that one `wesl.toml` may list.
const DEPENDENCIES: usize = lamplight_files::limits::PACKAGES;
const DEFAULT_ROOT: &str = "shaders";
/// The value that means all packages that the package manager installed.
const AUTO: &str = "auto";

/// The root that the `wesl.toml` of `folder` declares, if it has one.
pub fn declared_root(folder: &Path) -> Option<PathBuf> {
    let table = table_of(folder)?;
    is_inside(declared_in(&table)).then(|| root_in(folder, &table))
}

thread_local! {
    /// The texts that were read last, with their tables. To find a package, one file is read up to
    /// eight times, and an editor finds it with each keystroke.
    static LAST: RefCell<VecDeque<(String, Rc<Table>)>> = const { RefCell::new(VecDeque::new()) };
}

/// Texts that are kept.
const KEPT: usize = 8;

fn read_table(text: &str) -> Result<Rc<Table>, toml::de::Error> {
    LAST.with_borrow_mut(|last| {
        if let Some((_, table)) = last.iter().find(|(known, _)| known == text) {
            return Ok(Rc::clone(table));
        }
        let table: Rc<Table> = Rc::new(text.parse()?);
        last.push_front((text.to_owned(), Rc::clone(&table)));
        last.truncate(KEPT);
        Ok(table)
    })
}

/// The tables of a folder's file, if it is one that can be read.
fn table_of(folder: &Path) -> Option<Rc<Table>> {
    let text = input::read_file(&folder.join(NAME), LIMITS.file_bytes as u64).ok()?;
    read_table(std::str::from_utf8(&text).ok()?).ok()
}

/// The name that the root's `wesl.toml` gives its package.
pub fn declared_name(root: &Path) -> Option<String> {
    Some(table_of(&home(root)?)?.get("package")?.get("name")?.as_str()?.to_owned())
}

/// The packages that the root's `wesl.toml` lists, those they list in turn included.
pub fn dependencies(root: &Path, sources: &mut SourceSet) -> Result<Vec<Package>, Diagnostics> {
    find_tables(root, sources).map(|found| found.packages)
}

/// The features that the root's `wesl.toml` declares, and those of its dependencies.
pub fn features(root: &Path, sources: &mut SourceSet) -> Result<Features, Diagnostics> {
    let mut apart = SourceSet::default();
    let Ok(found) = find_tables(root, &mut apart) else { return Ok(Features::default()) };
    let mut features = Features::default();
    for folder in found.folders {
        let Ok((table, id)) = parse_tables(&folder, &folder, sources) else { continue };
        if table.contains_key("features") {
            features.extend(manifest::read_features(sources, id)?);
        }
    }
    Ok(features)
}

fn find_tables(root: &Path, sources: &mut SourceSet) -> Result<FoundPackages, Diagnostics> {
    refuse_broken(root, sources)?;
    let Some(folder) = home(root) else { return Ok(FoundPackages::default()) };
    let shown = shown_home(root, &folder);
    let mut found = FoundPackages { visited: vec![folder], ..FoundPackages::default() };
    found.collect(&shown, sources);
    if found.diagnostics.is_empty() { Ok(found) } else { Err(found.diagnostics) }
}

/// The folder of the `wesl.toml` that declares `root`.
pub fn home(root: &Path) -> Option<PathBuf> {
    let root = if root.as_os_str().is_empty() { Path::new(".") } else { root };
    let real = root.canonicalize().ok()?;
    real.ancestors().find_map(|folder| {
        let declared = declared_root(folder)?.canonicalize().ok()?;
        (declared == real || folder == real).then(|| folder.to_owned())
    })
}

/// The same folder as the author would name it.
pub fn shown_home(root: &Path, home: &Path) -> PathBuf {
    let root = if root.as_os_str().is_empty() { Path::new(".") } else { root };
    let below = root
        .canonicalize()
        .ok()
        .and_then(|real| Some(real.strip_prefix(home).ok()?.components().count()));
    (0..below.unwrap_or(0)).fold(root.to_owned(), |path, _| path.join(".."))
}

/// Refuses a `wesl.toml` of the root, or above it, that cannot be read. To ignore it would make its
/// imports look wrong.
fn refuse_broken(root: &Path, sources: &mut SourceSet) -> Result<(), Diagnostics> {
    let Ok(real) = root.canonicalize() else { return Ok(()) };
    for folder in [Some(real.as_path()), real.parent()]
        .into_iter()
        .flatten()
        .filter(|folder| folder.join(NAME).is_file())
    {
        let shown = if folder == real { root.to_owned() } else { root.join("..") };
        parse_tables(folder, &shown, sources).map_err(|error| vec![error])?;
    }
    Ok(())
}

/// The tables of a folder's `wesl.toml`, which is there; `shown` is the folder's name in
/// diagnostics.
fn parse_tables(
    folder: &Path,
    shown: &Path,
    sources: &mut SourceSet,
) -> Result<(Rc<Table>, SourceId), Diagnostic> {
    let disk = Disk::new(folder).map_err(|error| {
        Diagnostic::error(codes::UNREADABLE, format!("cannot read `{}`: {error}", shown.display()))
    })?;
    let package = Package {
        name: String::new(),
        files: Box::new(NamedFolder { disk, folder: shown.to_owned() }),
    };
    let missing = || {
        Diagnostic::error(
            codes::UNREADABLE,
            format!("cannot read `{}`", shown.join(NAME).display()),
        )
    };
    let id = source::read(sources, &package, NAME)?.ok_or_else(missing)?;
    let text = sources.get(id).text.clone();
    let table = read_table(&text).map_err(|error| {
        let range = error.span().unwrap_or(0..0);
        let span = Span::new(id, range.start.min(text.len())..range.end.min(text.len()));
        Diagnostic::error(codes::WESL_TOML, "`wesl.toml` is not valid TOML")
            .at(span, error.message().replace('\n', "; "))
    })?;
    check_values(&table, id, &text)?;
    Ok((table, id))
}

/// Checks that the values that are read have the expected types.
fn check_values(table: &Table, id: SourceId, text: &str) -> Result<(), Diagnostic> {
    let wrong = |what: &str, expected: &str, key: &str| {
        let start = text.find(key).unwrap_or(0);
        let message = format!("{what} of `wesl.toml` is not {expected}");
        Err(Diagnostic::error(codes::WESL_TOML, message).at(
            Span::new(id, start..(start + key.len()).min(text.len())),
            format!("expected {expected}"),
        ))
    };
    let package = table.get("package");
    if package.is_some_and(|package| !package.is_table()) {
        return wrong("`package`", "a table", "package");
    }
    if package.and_then(|package| package.get("root")).is_some_and(|root| !root.is_str()) {
        return wrong("`package.root`", "a string", "root");
    }
    if table.get("root").is_some_and(|root| !root.is_str()) {
        return wrong("`root`", "a string", "root");
    }
    if !is_inside(declared_in(table)) {
        return wrong("`root`", "a path below the file's folder", "root");
    }
    let Some(dependencies) = table.get("dependencies") else { return Ok(()) };
    if dependencies.as_str() == Some(AUTO) {
        return Ok(());
    }
    let Some(dependencies) = dependencies.as_table() else {
        return wrong("`dependencies`", "a table or `\"auto\"`", "dependencies");
    };
    if dependencies.len() > DEPENDENCIES {
        return wrong(
            "`dependencies`",
            &format!("a table of at most {DEPENDENCIES} packages"),
            "dependencies",
        );
    }
    for (name, entry) in dependencies {
        if !entry.is_table() {
            return wrong(&format!("dependency `{name}`"), "a table", name);
        }
        let is_odd = |key: &&&str| entry.get(**key).is_some_and(|value| !value.is_str());
        if let Some(key) = ["path", "package"].iter().find(is_odd) {
            return wrong(&format!("`{key}` of dependency `{name}`"), "a string", name);
        }
    }
    Ok(())
}

/// What the file says about who installs packages.
fn manager_of(table: &Table) -> Option<&str> {
    const KEY: &str = "package-manager";
    let packaged = table.get("package").and_then(|package| package.get(KEY));
    packaged.or_else(|| table.get(KEY)).and_then(Value::as_str)
}

/// A folder under the name that the user gave it.
struct NamedFolder {
    disk: Disk,
    folder: PathBuf,
}

impl Files for NamedFolder {
    fn read(&self, path: &str) -> Result<Option<String>, ReadError> {
        self.disk.read(path)
    }

    fn list(&self, extensions: &[&str]) -> Vec<String> {
        self.disk.list(extensions)
    }

    fn display(&self, path: &str) -> String {
        source::shown_path(&self.folder.join(path))
    }

    fn on_disk(&self, path: &str) -> bool {
        self.disk.on_disk(path)
    }
}

fn root_in(folder: &Path, table: &Table) -> PathBuf {
    folder.join(declared_in(table))
}

fn declared_in(table: &Table) -> &str {
    let packaged = table.get("package").and_then(|package| package.get("root"));
    let declared = packaged.or_else(|| table.get("root")).and_then(|root| root.as_str());
    declared.unwrap_or(DEFAULT_ROOT)
}

#[derive(Default)]
struct FoundPackages {
    packages: Vec<Package>,
    /// Those with a `wesl.toml`, as they are shown; the root's first.
    folders: Vec<PathBuf>,
    visited: Vec<PathBuf>,
    diagnostics: Diagnostics,
}

impl FoundPackages {
    /// Adds what the `wesl.toml` of a folder lists.
    fn collect(&mut self, folder: &Path, sources: &mut SourceSet) {
        if !folder.join(NAME).is_file() {
            return;
        }
        let (table, id) = match parse_tables(folder, folder, sources) {
            Ok(found) => found,
            Err(error) => return self.diagnostics.push(error),
        };
        self.folders.push(folder.to_owned());
        let text = sources.get(id).text.clone();
        let section = Span::new(id, key_range(&text, ""));
        let listed = match table.get("dependencies") {
            Some(Value::Table(listed)) => listed,
            Some(Value::String(auto)) if auto == AUTO => {
                return self.installed(folder, &table, section, sources);
            }
            _ => return,
        };
        for (name, entry) in listed {
            let span = Span::new(id, key_range(&text, name));
            if let Some(path) = entry.get("path").and_then(Value::as_str) {
                self.add(name, &folder.join(path), span, sources);
                continue;
            }
            let package = entry.get("package").and_then(Value::as_str).unwrap_or(name);
            let place = Manager::of(folder, manager_of(&table))
                .and_then(|manager| manager.find(folder, package));
            match place {
                Ok(place) => self.add(name, &place, span, sources),
                Err(reason) => self.diagnostics.push(
                    Diagnostic::error(
                        codes::WESL_TOML,
                        format!("cannot find dependency `{name}`: {reason}"),
                    )
                    .at(span, "declared here"),
                ),
            }
        }
    }

    /// `dependencies = "auto"`: what the package manager's file lists and has a `wesl.toml`.
    fn installed(&mut self, folder: &Path, table: &Table, span: Span, sources: &mut SourceSet) {
        let manager = match Manager::of(folder, manager_of(table)) {
            Ok(manager) => manager,
            Err(reason) => {
                let error = Diagnostic::error(codes::WESL_TOML, reason);
                return self.diagnostics.push(error.at(span, "asked for here"));
            }
        };
        for (name, package) in manager.listed(folder).into_iter().take(DEPENDENCIES) {
            let place = manager.find(folder, &package);
            if let Some(place) = place.ok().filter(|place| place.join(NAME).is_file()) {
                self.add(&name, &place, span, sources);
            }
        }
    }

    /// Adds the dependency in `folder`.
    fn add(&mut self, name: &str, folder: &Path, span: Span, sources: &mut SourceSet) {
        if folder.join(NAME).is_file()
            && let Err(error) = parse_tables(folder, folder, sources)
        {
            return self.diagnostics.push(error.at(span, "of this dependency"));
        }
        let Some(root) = declared_root(folder) else {
            self.diagnostics.push(
                Diagnostic::error(
                    codes::WESL_TOML,
                    format!("dependency `{name}` has no `wesl.toml`"),
                )
                .at(span, "declared here"),
            );
            return;
        };
        let disk = match (folder.canonicalize(), Disk::new(root)) {
            (Ok(real), Ok(disk)) if !disk.is_below(&real) => {
                let message = format!("the root of dependency `{name}` leads out of its folder");
                let error = Diagnostic::error(codes::OUTSIDE_ROOT, message);
                self.diagnostics.push(error.at(span, "declared here"));
                return;
            }
            (Ok(real), Ok(disk)) => {
                if self.visited.contains(&real) {
                    return;
                }
                self.visited.push(real);
                disk
            }
            (_, Err(error)) | (Err(error), _) => {
                self.diagnostics.push(
                    Diagnostic::error(
                        codes::UNREADABLE,
                        format!("cannot read dependency `{name}`: {error}"),
                    )
                    .at(span, "declared here"),
                );
                return;
            }
        };
        self.packages.push(Package { name: name.to_owned(), files: Box::new(disk) });
        self.collect(folder, sources);
    }
}

/// Where a dependency's key stands in the text.
fn key_range(text: &str, name: &str) -> std::ops::Range<usize> {
    const SECTION: &str = "[dependencies]";
    let section = text.find(SECTION).map_or(0, |start| start + SECTION.len());
    text[section..]
        .find(name)
        .map_or(section..section, |start| section + start..section + start + name.len())
}
