//! `wesl.toml`, as the community's specification "wesl.toml file format" has it.

use std::path::{Path, PathBuf};

use toml::Table;

use crate::diagnostic::{Diagnostic, Diagnostics, codes};
use crate::source::{Disk, Package, SourceSet, Span};

const NAME: &str = "wesl.toml";
const DEFAULT_ROOT: &str = "shaders";

/// The root that the `wesl.toml` of `folder` declares, if it has one.
pub fn declared_root(folder: &Path) -> Option<PathBuf> {
    let text = std::fs::read_to_string(folder.join(NAME)).ok()?;
    Some(root_in(folder, &text.parse().ok()?))
}

/// The name that the root's `wesl.toml` gives its package.
pub fn declared_name(root: &Path) -> Option<String> {
    let table: Table = std::fs::read_to_string(home(root)?.join(NAME)).ok()?.parse().ok()?;
    Some(table.get("package")?.get("name")?.as_str()?.to_owned())
}

/// The packages that the root's `wesl.toml` lists by path, those they list in turn included.
pub fn dependencies(root: &Path, sources: &mut SourceSet) -> Result<Vec<Package>, Diagnostics> {
    let Some(folder) = home(root) else { return Ok(Vec::new()) };
    let mut found = Found { packages: Vec::new(), visited: vec![folder.clone()], diagnostics: Vec::new() };
    found.collect(&folder, sources);
    if found.diagnostics.is_empty() { Ok(found.packages) } else { Err(found.diagnostics) }
}

/// The folder of the `wesl.toml` that declares `root`.
fn home(root: &Path) -> Option<PathBuf> {
    let real = root.canonicalize().ok()?;
    [Some(real.as_path()), real.parent()].into_iter().flatten().find_map(|folder| {
        let declared = declared_root(folder)?.canonicalize().ok()?;
        (declared == real || folder == real).then(|| folder.to_owned())
    })
}

fn root_in(folder: &Path, table: &Table) -> PathBuf {
    let declared = table.get("package").and_then(|package| package.get("root")).and_then(|root| root.as_str());
    folder.join(declared.unwrap_or(DEFAULT_ROOT))
}

struct Found {
    packages: Vec<Package>,
    visited: Vec<PathBuf>,
    diagnostics: Diagnostics,
}

impl Found {
    fn collect(&mut self, folder: &Path, sources: &mut SourceSet) {
        let path = folder.join(NAME);
        let Ok(text) = std::fs::read_to_string(&path) else { return };
        let id = sources.add(NAME, text.as_str());
        let table: Table = match toml::from_str(&text) {
            Ok(table) => table,
            Err(error) => {
                let span = Span::new(id, error.span().unwrap_or(0..0));
                self.diagnostics.push(Diagnostic::error(codes::WESL_TOML, "`wesl.toml` is not valid TOML").at(span, error.message()));
                return;
            }
        };
        let Some(dependencies) = table.get("dependencies").and_then(|entry| entry.as_table()) else { return };
        for (name, entry) in dependencies {
            let Some(path) = entry.get("path").and_then(|path| path.as_str()) else { continue };
            self.add(name, &folder.join(path), Span::new(id, key_range(&text, name)), sources);
        }
    }

    fn add(&mut self, name: &str, folder: &Path, span: Span, sources: &mut SourceSet) {
        let Some(root) = declared_root(folder) else {
            self.diagnostics
                .push(Diagnostic::error(codes::WESL_TOML, format!("dependency `{name}` has no `wesl.toml`")).at(span, "declared here"));
            return;
        };
        let disk = match (folder.canonicalize(), Disk::new(root)) {
            (Ok(real), Ok(disk)) => {
                if self.visited.contains(&real) {
                    return;
                }
                self.visited.push(real);
                disk
            }
            (_, Err(error)) | (Err(error), _) => {
                self.diagnostics.push(
                    Diagnostic::error(codes::UNREADABLE, format!("cannot read dependency `{name}`: {error}")).at(span, "declared here"),
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
    let section = text.find("[dependencies]").unwrap_or(0);
    text[section..].find(name).map_or(section..section, |start| section + start..section + start + name.len())
}
