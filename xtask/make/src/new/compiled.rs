//! Whether a new function compiles in its module.

use std::collections::BTreeMap;
use std::path::Path;

use lamplight::bundle::Language;
use lamplight::compose::{self, Keep, Options};
use lamplight::diagnostic::render::{Form, render};
use lamplight::permute::Settings;
use lamplight::resolve::{self, Packages};
use lamplight::source::{Disk, Files, Memory, Package, ReadError, SourceSet};
use lamplight::validate::validate;
use lamplight_catalogue::translated::translated_files;

/// The library on disk, with some files replaced.
struct ChangedFiles {
    changed: Memory,
    disk: Option<Disk>,
}

impl Files for ChangedFiles {
    fn read(&self, path: &str) -> Result<Option<String>, ReadError> {
        match (self.changed.read(path)?, &self.disk) {
            (None, Some(disk)) => disk.read(path),
            (found, _) => Ok(found),
        }
    }

    fn list(&self, extensions: &[&str]) -> Vec<String> {
        let of_disk = self.disk.iter().flat_map(|disk| disk.list(extensions));
        let mut all: Vec<String> =
            self.changed.list(extensions).into_iter().chain(of_disk).collect();
        all.sort();
        all.dedup();
        all
    }
}

/// The library on disk, with another text of a file of the repository.
fn changed_library(root: &Path, (file, text): (&str, &str)) -> ChangedFiles {
    let file = file.trim_start_matches("shaderlib/").to_owned();
    ChangedFiles {
        changed: Memory(BTreeMap::from([(file, text.to_owned())])),
        disk: Disk::new(root.join("shaderlib")).ok(),
    }
}

/// The first error of compiling a call of a function of the library, if the file of the repository
/// had this text; `None` if it compiles.
pub fn first_problem(
    root: &Path,
    changed: (&str, &str),
    [folder, module, name]: [&str; 3],
    arguments: &str,
) -> Option<String> {
    let main = "main.wesl";
    let caller = format!(
        "import lamplight::{folder}::{module}::{name};\n@fragment fn main() {{\n    \
         let kept = {name}({arguments});\n}}\n"
    );
    let library = changed_library(root, changed);
    let own = Memory(BTreeMap::from([(main.to_owned(), caller)]));
    let packages = Packages::new(
        Package { name: "caller".into(), files: Box::new(own) },
        vec![Package { name: "lamplight".into(), files: Box::new(library) }],
    );
    let options = Options { keep: Keep::EntryPoints, ..Options::default() };
    let mut sources = SourceSet::default();
    let problems = resolve::load(&mut sources, &packages, main, Language::Wesl)
        .and_then(|graph| compose::compose(&graph, &Settings::default(), &options))
        .and_then(|composed| validate(&composed))
        .err()?;
    problems.first().map(|problem| problem.message.clone())
}

/// A module in GLSL, if the file of the repository had this text.
pub fn translated_module(
    root: &Path,
    changed: (&str, &str),
    [folder, module]: [&str; 2],
) -> Result<String, String> {
    let library = changed_library(root, changed);
    let mut sources = SourceSet::default();
    let mut made = translated_files(&library, &BTreeMap::new(), &mut sources)
        .map_err(|problems| render(&sources, &problems, Form::Short))?;
    let path = format!("{folder}/{module}.glsl");
    made.remove(&path).ok_or_else(|| format!("`{path}` is not made"))
}
