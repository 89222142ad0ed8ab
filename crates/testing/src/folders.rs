//! Packages whose files are in a folder of a test: those of the root package, and in `deps/` those
//! of the packages that it depends on.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use lamplight_compose::resolve::Packages;
use lamplight_diagnostic::source::{Files, Memory, Package, ReadError};

/// The packages of a folder. `is_source` says by the path of a file whether it belongs to one.
pub fn packages_in(folder: &Path, root: &str, is_source: fn(&str) -> bool) -> Packages {
    let mut files = BTreeMap::new();
    read_files(folder, "", is_source, &mut files);
    let mut own = Memory::default();
    let mut dependencies: BTreeMap<String, Memory> = BTreeMap::new();
    for (path, text) in files {
        match path.strip_prefix("deps/").and_then(|rest| rest.split_once('/')) {
            Some((name, rest)) => {
                drop(dependencies.entry(name.into()).or_default().0.insert(rest.into(), text))
            }
            None => drop(own.0.insert(path, text)),
        }
    }
    let dependency = |(name, files): (String, Memory)| Package {
        name: name.clone(),
        files: Box::new(Named(name, files)),
    };
    let root = Package { name: root.to_owned(), files: Box::new(own) };
    Packages::new(root, dependencies.into_iter().map(dependency).collect())
}

fn read_files(
    folder: &Path,
    prefix: &str,
    is_source: fn(&str) -> bool,
    files: &mut BTreeMap<String, String>,
) {
    for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
        let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
        if entry.path().is_dir() {
            read_files(&entry.path(), &format!("{name}/"), is_source, files);
        } else if is_source(&name) {
            files.insert(name, fs::read_to_string(entry.path()).unwrap());
        }
    }
}

/// A package whose files are shown with the package's name in front.
struct Named(String, Memory);

impl Files for Named {
    fn read(&self, path: &str) -> Result<Option<String>, ReadError> {
        self.1.read(path)
    }

    fn list(&self, extensions: &[&str]) -> Vec<String> {
        self.1.list(extensions)
    }

    fn display(&self, path: &str) -> String {
        format!("{}/{path}", self.0)
    }
}
