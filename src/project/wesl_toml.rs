//! `wesl.toml`, as the community's specification "wesl.toml file format" has it: its keys stand in
//! the table `package`; the tools that came before that read them at the top, so both are read.

use std::path::{Path, PathBuf};

use toml::Table;

use crate::diagnostic::{Diagnostic, Diagnostics, codes};
use crate::input;
use crate::source::{
    self, Disk, Files, LIMITS, Package, ReadError, SourceId, SourceSet, Span, is_inside,
};

const NAME: &str = "wesl.toml";
/// Packages that one `wesl.toml` may list.
const DEPENDENCIES: usize = crate::limits::PACKAGES;
const DEFAULT_ROOT: &str = "shaders";

/// The root that the `wesl.toml` of `folder` declares, if it has one.
pub fn declared_root(folder: &Path) -> Option<PathBuf> {
    let table = table_of(folder)?;
    is_inside(declared_in(&table)).then(|| root_in(folder, &table))
}

/// The tables of a folder's file, if it is one that can be read.
fn table_of(folder: &Path) -> Option<Table> {
    let text = input::read(&folder.join(NAME), LIMITS.file_bytes as u64).ok()?;
    String::from_utf8(text).ok()?.parse().ok()
}

/// The name that the root's `wesl.toml` gives its package.
pub fn declared_name(root: &Path) -> Option<String> {
    Some(table_of(&home(root)?)?.get("package")?.get("name")?.as_str()?.to_owned())
}

/// The packages that the root's `wesl.toml` lists by path, those they list in turn included.
pub fn dependencies(root: &Path, sources: &mut SourceSet) -> Result<Vec<Package>, Diagnostics> {
    broken(root, sources)?;
    let Some(folder) = home(root) else { return Ok(Vec::new()) };
    let shown = shown_home(root, &folder);
    let mut found = Found { packages: Vec::new(), visited: vec![folder], diagnostics: Vec::new() };
    found.collect(&shown, sources);
    if found.diagnostics.is_empty() { Ok(found.packages) } else { Err(found.diagnostics) }
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

/// Refuses a `wesl.toml` of the root or above it that cannot be understood: to ignore it would
/// blame the imports.
fn broken(root: &Path, sources: &mut SourceSet) -> Result<(), Diagnostics> {
    let Ok(real) = root.canonicalize() else { return Ok(()) };
    for folder in [Some(real.as_path()), real.parent()]
        .into_iter()
        .flatten()
        .filter(|folder| folder.join(NAME).is_file())
    {
        let shown = if folder == real { root.to_owned() } else { root.join("..") };
        parse(folder, &shown, sources).map_err(|error| vec![error])?;
    }
    Ok(())
}

/// The tables of a folder's `wesl.toml`, which is there; `shown` is the folder's name in diagnostics.
fn parse(
    folder: &Path,
    shown: &Path,
    sources: &mut SourceSet,
) -> Result<(Table, SourceId), Diagnostic> {
    let disk = Disk::new(folder).map_err(|error| {
        Diagnostic::error(codes::UNREADABLE, format!("cannot read `{}`: {error}", shown.display()))
    })?;
    let package =
        Package { name: String::new(), files: Box::new(Shown { disk, folder: shown.to_owned() }) };
    let missing = || {
        Diagnostic::error(
            codes::UNREADABLE,
            format!("cannot read `{}`", shown.join(NAME).display()),
        )
    };
    let id = source::read(sources, &package, NAME)?.ok_or_else(missing)?;
    let text = sources.get(id).text.clone();
    let table: Table = text.parse().map_err(|error: toml::de::Error| {
        let range = error.span().unwrap_or(0..0);
        let span = Span::new(id, range.start.min(text.len())..range.end.min(text.len()));
        Diagnostic::error(codes::WESL_TOML, "`wesl.toml` is not valid TOML")
            .at(span, error.message().replace('\n', "; "))
    })?;
    check(&table, id, &text)?;
    Ok((table, id))
}

/// What is read of the file has the types that are expected.
fn check(table: &Table, id: SourceId, text: &str) -> Result<(), Diagnostic> {
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
    let Some(dependencies) = dependencies.as_table() else {
        return wrong("`dependencies`", "a table", "dependencies");
    };
    if dependencies.len() > DEPENDENCIES {
        return wrong(
            "`dependencies`",
            &format!("a table of at most {DEPENDENCIES} packages"),
            "dependencies",
        );
    }
    match dependencies
        .iter()
        .find(|(_, entry)| entry.get("path").is_some_and(|path| !path.is_str()))
    {
        Some((name, _)) => wrong(&format!("`path` of dependency `{name}`"), "a string", name),
        None => Ok(()),
    }
}

/// A folder under the name that the user gave it.
struct Shown {
    disk: Disk,
    folder: PathBuf,
}

impl Files for Shown {
    fn read(&self, path: &str) -> Result<Option<String>, ReadError> {
        self.disk.read(path)
    }

    fn list(&self, extensions: &[&str]) -> Vec<String> {
        self.disk.list(extensions)
    }

    fn display(&self, path: &str) -> String {
        source::shown(&self.folder.join(path))
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

struct Found {
    packages: Vec<Package>,
    visited: Vec<PathBuf>,
    diagnostics: Diagnostics,
}

impl Found {
    /// Adds what the `wesl.toml` of a folder lists.
    fn collect(&mut self, folder: &Path, sources: &mut SourceSet) {
        if !folder.join(NAME).is_file() {
            return;
        }
        let (table, id) = match parse(folder, folder, sources) {
            Ok(found) => found,
            Err(error) => return self.diagnostics.push(error),
        };
        let text = sources.get(id).text.clone();
        let Some(dependencies) = table.get("dependencies").and_then(|entry| entry.as_table())
        else {
            return;
        };
        for (name, entry) in dependencies {
            let Some(path) = entry.get("path").and_then(|path| path.as_str()) else { continue };
            self.add(name, &folder.join(path), Span::new(id, key_range(&text, name)), sources);
        }
    }

    /// Adds the dependency in `folder`.
    fn add(&mut self, name: &str, folder: &Path, span: Span, sources: &mut SourceSet) {
        if folder.join(NAME).is_file()
            && let Err(error) = parse(folder, folder, sources)
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
