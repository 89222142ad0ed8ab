//! The library's GLSL is what its WESL is translated to.

use std::path::{Path, PathBuf};

use lamplight_diagnostic::render::{Form, render};
use lamplight_diagnostic::source::SourceSet;
use lamplight_translate::glsl::LIBRARY_STYLE;
use lamplight_translate::{SourceModule, wesl_to_glsl};
use libtest_mimic::{Failed, Trial};

pub fn tests() -> Vec<Trial> {
    vec![Trial::test("translate::library_is_up_to_date", is_up_to_date)]
}

fn is_up_to_date() -> Result<(), Failed> {
    let root = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shaderlib"));
    let mut texts = Vec::new();
    collect_modules(&root, &root, &mut texts);
    let mut sources = SourceSet::default();
    let modules: Vec<SourceModule<'_>> = texts
        .iter()
        .map(|(path, text)| SourceModule {
            path: path.split('/').map(str::to_owned).collect(),
            source: sources.add(format!("shaderlib/{path}.wesl"), text.as_str()),
            text,
        })
        .collect();
    let files = wesl_to_glsl(&modules, &[], &LIBRARY_STYLE)
        .map_err(|problems| render(&sources, &problems, Form::Human))?;
    if files.len() < 70 {
        return Err(format!("only {} files were made", files.len()).into());
    }
    let differs = |path: &str, text: &str| {
        std::fs::read_to_string(root.join(path)).ok().as_deref() != Some(text)
    };
    let stale: Vec<&str> = files
        .iter()
        .filter(|file| differs(&file.path, &file.text))
        .map(|file| file.path.as_str())
        .collect();
    match stale.is_empty() {
        true => Ok(()),
        false => Err(format!("not up to date: {stale:?}\nrun: cargo xtask docs").into()),
    }
}

fn collect_modules(root: &Path, folder: &Path, found: &mut Vec<(String, String)>) {
    let mut paths: Vec<PathBuf> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    for path in paths {
        if path.is_dir() {
            collect_modules(root, &path, found);
        } else if path.extension().is_some_and(|ending| ending == "wesl") {
            let name = path.strip_prefix(root).unwrap().with_extension("");
            let name = name.to_string_lossy().replace('\\', "/");
            found.push((name, std::fs::read_to_string(&path).unwrap()));
        }
    }
}
