//! Constructs of WESL: what becomes of each file of `constructs/` is a snapshot.

use std::path::PathBuf;

use lamplight_diagnostic::render::{Form, render};
use lamplight_diagnostic::source::SourceSet;
use lamplight_testing::snapshot;
use lamplight_translate::print::{Dialect, MadeFile, Style};
use lamplight_translate::{SourceModule, translate_wesl};
use libtest_mimic::{Failed, Trial};

use crate::compiler;

const STYLE: Style<'static> = Style {
    dialect: Dialect::Glsl,
    command: None,
    guard: "TEST",
    sampling: Some("sampling"),
    prefix: None,
};

pub fn tests() -> Vec<Trial> {
    let mut names: Vec<String> = std::fs::read_dir(folder())
        .unwrap()
        .filter_map(|entry| {
            let name = entry.unwrap().file_name().into_string().unwrap();
            name.strip_suffix(".wesl").map(str::to_owned)
        })
        .collect();
    names.sort();
    let test =
        |name: String| Trial::test(format!("translate::constructs::{name}"), move || check(&name));
    names.into_iter().map(test).collect()
}

fn folder() -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/constructs"))
}

fn check(name: &str) -> Result<(), Failed> {
    let (text, files) = translated(name);
    snapshot::check("translate", name, &text)?;
    for file in &files {
        compiler::compiles(file, &files)?;
    }
    Ok(())
}

/// What becomes of a file: the texts, or the errors; and the files.
fn translated(name: &str) -> (String, Vec<MadeFile>) {
    let mut names = vec![name.to_owned()];
    // Some of the files import another one.
    names.extend(IMPORTING.contains(&name).then(|| "pointers".to_owned()));
    let mut sources = SourceSet::default();
    let texts: Vec<(String, String)> = names
        .into_iter()
        .map(|name| {
            let text = std::fs::read_to_string(folder().join(format!("{name}.wesl"))).unwrap();
            (name, text)
        })
        .collect();
    let modules: Vec<SourceModule<'_>> = texts
        .iter()
        .map(|(name, text)| SourceModule {
            path: vec![name.clone()],
            source: sources.add(format!("{name}.wesl"), text.as_str()),
            text,
        })
        .collect();
    let enums: Vec<String> = ENUMS.iter().map(|name| (*name).to_owned()).collect();
    match translate_wesl(&modules, &enums, &STYLE) {
        Ok(files) => {
            let own = files.iter().filter(|file| file.path.starts_with(name));
            (own.map(|file| format!("--- {}\n{}", file.path, file.text)).collect(), files)
        }
        Err(problems) => (render(&sources, &problems, Form::Human), Vec::new()),
    }
}

/// The files that import `pointers`.
const IMPORTING: [&str; 2] = ["conditions", "refused_meeting"];

/// The axes of the files that have named values.
const ENUMS: [&str; 1] = ["quality"];
