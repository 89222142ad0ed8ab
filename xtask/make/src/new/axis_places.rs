//! Where the programs of the library test an axis.

use lamplight::bundle::Language;
use lamplight::permute::Manifest;
use lamplight::resolve::{self, Packages};
use lamplight::source::{Disk, Package, SourceSet};

use super::Repository;

const LIBRARY: &str = "shaderlib";
const PROGRAMS: &str = "shaderlib/programs/";

/// The files of a program below `shaderlib/programs/`, with their texts, by path.
pub fn program_files(
    repository: &Repository<'_>,
    manifest: &Manifest,
    program: &str,
) -> Result<Vec<(String, String)>, String> {
    let program = manifest.program(program).ok_or_else(|| format!("no program `{program}`"))?;
    let folder = repository.root.join(LIBRARY);
    let mut paths = Vec::new();
    for file in program.files().filter(|file| !file.path.ends_with(".glsl")) {
        let disk = Disk::new(&folder).map_err(|error| format!("`{LIBRARY}`: {error}"))?;
        let root = Package { name: "lamplight".into(), files: Box::new(disk) };
        let packages = Packages::new(root, Vec::new());
        let mut sources = SourceSet::default();
        resolve::load(&mut sources, &packages, &file.path, Language::Wesl).map_err(|problems| {
            let first = problems.first().map_or("", |problem| &problem.message);
            format!("`{LIBRARY}/{}`: {first}", file.path)
        })?;
        let shown = |path: &str| path.find(PROGRAMS).map(|at| path[at..].to_owned());
        paths.extend(sources.iter().filter_map(|(_, source)| shown(&source.path)));
    }
    paths.sort();
    paths.dedup();
    paths.into_iter().map(|path| repository.read(&path).map(|text| (path, text))).collect()
}

/// The lines whose conditions test an axis, each with its place.
pub fn testing_lines(path: &str, text: &str, axis: &str) -> Vec<String> {
    let tests = |line: &str| {
        ["@if", "@elif"].iter().any(|word| line.contains(word)) && has_word(line, axis)
    };
    let lines = text.lines().enumerate().map(|(index, line)| (index + 1, line.trim()));
    let found = lines.filter(|(_, line)| tests(line));
    found.map(|(number, line)| format!("{path}:{number}: {line}")).collect()
}

fn has_word(line: &str, word: &str) -> bool {
    line.split(|one: char| !(one.is_alphanumeric() || one == '_')).any(|found| found == word)
}
