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
    for file in program.files() {
        let disk = Disk::new(&folder).map_err(|error| format!("`{LIBRARY}`: {error}"))?;
        let root = Package { name: "lamplight".into(), files: Box::new(disk) };
        let packages = Packages::new(root, Vec::new());
        let is_glsl = file.path.ends_with(".glsl");
        let language = if is_glsl { Language::Glsl } else { Language::Wesl };
        let mut sources = SourceSet::default();
        resolve::load(&mut sources, &packages, &file.path, language).map_err(|problems| {
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

/// The lines that test an axis: conditions of WESL, and directives of GLSL, which write it in
/// capitals. Each line comes with its place.
pub fn testing_lines(path: &str, text: &str, axis: &str) -> Vec<String> {
    let tests = |line: &str| match path.ends_with(".glsl") {
        true => line.starts_with('#') && has_word(line, &axis.to_uppercase()),
        false => ["@if", "@elif"].iter().any(|word| line.contains(word)) && has_word(line, axis),
    };
    let lines = text.lines().enumerate().map(|(index, line)| (index + 1, line.trim()));
    let found = lines.filter(|(_, line)| tests(line));
    found.map(|(number, line)| format!("{path}:{number}: {line}")).collect()
}

fn has_word(line: &str, word: &str) -> bool {
    line.split(|one: char| !(one.is_alphanumeric() || one == '_')).any(|found| found == word)
}

/// A text of GLSL in which a new value of an axis is an error in each chain of conditions that ends
/// in `#else` and asks for values of the axis. Without this, the new value would silently take the
/// `#else` branch.
pub fn with_errors(text: &str, axis: &str, value: &str) -> String {
    let name = axis.to_uppercase();
    let constant = format!("{axis}_{value}").to_uppercase();
    let mut chains: Vec<Vec<&str>> = Vec::new();
    let mut made = String::with_capacity(text.len());
    for line in text.split_inclusive('\n') {
        let directive = line.trim();
        let words = directive.split_once(' ').map_or(directive, |(word, _)| word);
        match words {
            "#if" | "#ifdef" | "#ifndef" => chains.push(vec![directive]),
            "#elif" => chains.iter_mut().last().into_iter().for_each(|open| open.push(directive)),
            "#else" if chains.last().is_some_and(|open| asks_for_values(open, &name)) => {
                made += &format!(
                    "#elif {name} == {constant}\n#error write what {axis}={value} does here, or delete both lines where `#else` is right\n"
                );
            }
            "#endif" => drop(chains.pop()),
            _ => {}
        }
        made += line;
    }
    made
}

/// Whether some branch tests only that the axis equals certain values (`==`, joined by `||`), and
/// no branch tests that it differs from a value (`!=`).
fn asks_for_values(chain: &[&str], name: &str) -> bool {
    let is_test = |part: &str, sign: &str| {
        part.split_once(sign).is_some_and(|(left, _)| {
            left.split_whitespace().next_back().is_some_and(|word| word.trim_matches('(') == name)
        })
    };
    let condition =
        |line: &&str| line.split_once(' ').map_or(String::new(), |(_, rest)| rest.into());
    let conditions: Vec<String> = chain.iter().map(condition).collect();
    let all_equal =
        |text: &String| text.split("||").all(|part| is_test(part, "==") && !part.contains("&&"));
    let excludes = |text: &String| text.split(['|', '&']).any(|part| is_test(part, "!="));
    conditions.iter().any(all_equal) && !conditions.iter().any(excludes)
}
