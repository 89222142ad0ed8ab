//! Constructs of WESL: what becomes of each file of `constructs/` is a snapshot.

use std::path::PathBuf;

use lamplight_diagnostic::render::{Form, render};
use lamplight_diagnostic::source::SourceSet;
use lamplight_testing::snapshot;
use lamplight_translate::glsl::Style;
use lamplight_translate::{SourceModule, wesl_to_glsl};
use libtest_mimic::{Failed, Trial};

const STYLE: Style<'static> =
    Style { command: None, guard: "TEST", sampling: Some("sampling"), prefix: None };

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
    snapshot::check("translate", name, &translated(name))
}

/// What becomes of a file: the texts, or the errors.
fn translated(name: &str) -> String {
    let mut names = vec![name.to_owned()];
    // One of the files imports another one.
    names.extend((name == "conditions").then(|| "pointers".to_owned()));
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
    match wesl_to_glsl(&modules, &[], &STYLE) {
        Ok(files) => {
            let own = files.iter().filter(|file| file.path.starts_with(name));
            own.map(|file| format!("--- {}\n{}", file.path, file.text)).collect()
        }
        Err(problems) => render(&sources, &problems, Form::Human),
    }
}
