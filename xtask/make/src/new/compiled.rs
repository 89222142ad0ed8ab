//! Whether a new function compiles in its module.

use std::collections::BTreeMap;
use std::path::Path;

use lamplight::bundle::Language;
use lamplight::compose::{self, Keep, Options};
use lamplight::permute::Settings;
use lamplight::resolve::{self, Packages};
use lamplight::source::{Disk, Files, Memory, Package, ReadError, SourceSet};
use lamplight::validate::validate;

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

/// The first error of compiling a call of a function of the library, if the file of the repository
/// had this text; `None` if it compiles.
pub fn first_problem(
    root: &Path,
    (file, text): (&str, &str),
    [folder, module, name]: [&str; 3],
    arguments: &str,
    language: Language,
) -> Option<String> {
    let (main, caller) = match language {
        Language::Wesl => (
            "main.wesl",
            format!(
                "import lamplight::{folder}::{module}::{name};\n@fragment fn main() {{\n    \
                 let kept = {name}({arguments});\n}}\n"
            ),
        ),
        Language::Glsl => (
            "main.frag.glsl",
            format!(
                "#version 450\n#include <lamplight/{folder}/{module}.glsl>\nvoid main() {{\n    \
                 {name}({arguments});\n}}\n"
            ),
        ),
    };
    let file = file.trim_start_matches("shaderlib/").to_owned();
    let library = ChangedFiles {
        changed: Memory(BTreeMap::from([(file, text.to_owned())])),
        disk: Disk::new(root.join("shaderlib")).ok(),
    };
    let own = Memory(BTreeMap::from([(main.to_owned(), caller)]));
    let packages = Packages::new(
        Package { name: "caller".into(), files: Box::new(own) },
        vec![Package { name: "lamplight".into(), files: Box::new(library) }],
    );
    let options = Options { keep: Keep::EntryPoints, ..Options::default() };
    let mut sources = SourceSet::default();
    let problems = resolve::load(&mut sources, &packages, main, language)
        .and_then(|graph| compose::compose(&graph, &Settings::default(), &options))
        .and_then(|composed| validate(&composed))
        .err()?;
    problems.first().map(|problem| problem.message.clone())
}
