//! Reads `wesl.toml`. In the community's specification "wesl.toml file format" its keys are in the
//! table `package`. Older tools read them at the top level, so both are accepted.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use toml::de::DeTable;
use toml::{Table, Value};

use lamplight_diagnostic::source::{
    self, Disk, Files, LIMITS, Package, ReadError, SourceId, SourceSet, Span, is_inside,
};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_files::input;

/// File name of the file that declares a package.
pub const NAME: &str = "wesl.toml";
/// The most packages that one `wesl.toml` may list.
pub(super) const DEPENDENCIES: usize = lamplight_files::limits::PACKAGES;
const DEFAULT_ROOT: &str = "shaders";
/// The value that means all packages that the package manager installed.
pub(super) const AUTO: &str = "auto";

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
    name_in(&*table_of(&home(root)?)?).map(str::to_owned)
}

/// The name that a `wesl.toml` gives its package.
pub(super) fn name_in(table: &Table) -> Option<&str> {
    table.get("package")?.get("name")?.as_str()
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
pub(super) fn refuse_broken(root: &Path, sources: &mut SourceSet) -> Result<(), Diagnostics> {
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
pub(super) fn parse_tables(
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
        Err(wrong_value(what, expected, id, start..(start + key.len()).min(text.len())))
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
    for key in [INCLUDE, EXCLUDE] {
        if !has_patterns(table, key) {
            return wrong(&format!("`{key}`"), "a list of patterns of paths", key);
        }
    }
    check_dependencies(table, id, text)
}

fn wrong_value(
    what: &str,
    expected: &str,
    id: SourceId,
    range: std::ops::Range<usize>,
) -> Diagnostic {
    let message = format!("{what} of `wesl.toml` is not {expected}");
    Diagnostic::error(codes::WESL_TOML, message)
        .at(Span::new(id, range), format!("expected {expected}"))
}

/// Checks that dependencies are tables with strings.
fn check_dependencies(table: &Table, id: SourceId, text: &str) -> Result<(), Diagnostic> {
    let wrong_at = |what: &str, expected: &str, range| Err(wrong_value(what, expected, id, range));
    let wrong = |expected: &str| {
        let start = text.find("dependencies").unwrap_or(0);
        wrong_at("`dependencies`", expected, start..(start + 12).min(text.len()))
    };
    let Some(dependencies) = table.get("dependencies") else { return Ok(()) };
    if dependencies.as_str() == Some(AUTO) {
        return Ok(());
    }
    let Some(dependencies) = dependencies.as_table() else {
        return wrong("a table or `\"auto\"`");
    };
    if dependencies.len() > DEPENDENCIES {
        return wrong(&format!("a table of at most {DEPENDENCIES} packages"));
    }
    for (name, entry) in dependencies {
        if !entry.is_table() {
            return wrong_at(&format!("dependency `{name}`"), "a table", key_range(text, name));
        }
        let is_odd = |key: &&&str| entry.get(**key).is_some_and(|value| !value.is_str());
        if let Some(key) = ["path", "package"].iter().find(is_odd) {
            let what = format!("`{key}` of dependency `{name}`");
            return wrong_at(&what, "a string", key_range(text, name));
        }
    }
    Ok(())
}

/// Whether a key has a list of patterns, or is not there.
fn has_patterns(table: &Table, key: &str) -> bool {
    let is_pattern =
        |entry: &Value| entry.as_str().is_some_and(|text| glob::Pattern::new(text).is_ok());
    let list = value_of(table, key).map(Value::as_array);
    list.is_none_or(|list| list.is_some_and(|list| list.iter().all(is_pattern)))
}

/// What the file says about who installs packages.
pub(super) fn manager_of(table: &Table) -> Option<&str> {
    value_of(table, "package-manager").and_then(Value::as_str)
}

/// A key of the table `package`, or else of the top level.
fn value_of<'t>(table: &'t Table, key: &str) -> Option<&'t Value> {
    let packaged = table.get("package").and_then(|package| package.get(key));
    packaged.or_else(|| table.get(key))
}

const INCLUDE: &str = "include";
const EXCLUDE: &str = "exclude";

/// Which files a `wesl.toml` counts to its package.
#[derive(Debug, Default)]
pub(super) struct FilePatterns {
    /// `None` where all files below the root are included.
    pub include: Option<Vec<String>>,
    pub exclude: Vec<String>,
    /// The root, from the file's folder, with a `/` at the end; empty where it is that folder.
    pub root: String,
}

/// The patterns of the `wesl.toml` that declares the root. A file that cannot be read has none: its
/// error is reported where it is read for its dependencies.
pub(super) fn patterns(root: &Path) -> FilePatterns {
    let Some(table) = home(root).and_then(|home| table_of(&home)) else {
        return FilePatterns::default();
    };
    let list = |key| {
        let entries = value_of(&table, key)?.as_array()?.iter();
        Some(entries.filter_map(|entry| Some(entry.as_str()?.to_owned())).collect())
    };
    let parts = declared_in(&table).split('/').filter(|part| !matches!(*part, "" | "."));
    let root = parts.map(|part| format!("{part}/")).collect();
    FilePatterns { include: list(INCLUDE), exclude: list(EXCLUDE).unwrap_or_default(), root }
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

/// Where the key of a dependency stands in the text of a `wesl.toml`; if there is no such key,
/// where `dependencies` stands.
pub(super) fn key_range(text: &str, name: &str) -> std::ops::Range<usize> {
    let Ok(table) = DeTable::parse(text) else { return 0..0 };
    let listed = table.get_ref().get_key_value("dependencies");
    let Some((section, listed)) = listed else { return 0..0 };
    let keys = listed.get_ref().as_table().into_iter().flatten();
    let mut keys = keys.map(|(key, _)| key).filter(|key| key.get_ref().as_ref() == name);
    keys.next().map_or_else(|| section.span(), |key| key.span())
}
