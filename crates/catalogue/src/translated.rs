//! The library in other languages: its modules and programs in GLSL, and its modules in HLSL and MSL,
//! translated from those in WESL.

use std::collections::BTreeMap;

use lamplight_diagnostic::Diagnostics;
use lamplight_diagnostic::source::{Files, SourceSet};
use lamplight_translate::print::{Dialect, LIBRARY_STYLE, Style};
use lamplight_translate::{SourceModule, translate_wesl};

/// The files in GLSL, by path below the library. `made` has texts of modules that replace those of
/// the library.
pub fn translated_files(
    files: &dyn Files,
    made: &BTreeMap<String, String>,
    sources: &mut SourceSet,
) -> Result<BTreeMap<String, String>, Diagnostics> {
    let mut texts = BTreeMap::new();
    for path in files.list(&["wesl"]) {
        let text = files.read(&path).ok().flatten().unwrap_or_default();
        texts.insert(path, text);
    }
    let replaced = made.iter().filter(|(path, _)| path.ends_with(".wesl"));
    texts.extend(replaced.map(|(path, text)| (path.clone(), text.clone())));
    translated_texts(files, &texts, &LIBRARY_STYLE, sources)
}

/// The library's modules in a language, by path: all that is no program. They include each other.
pub fn module_files(
    files: &dyn Files,
    dialect: Dialect,
    sources: &mut SourceSet,
) -> Result<BTreeMap<String, String>, Diagnostics> {
    let mut texts = BTreeMap::new();
    for path in files.list(&["wesl"]).into_iter().filter(|path| !path.starts_with("programs/")) {
        let text = files.read(&path).ok().flatten().unwrap_or_default();
        texts.insert(path, text);
    }
    let style = Style { dialect, command: None, guard: "LAMPLIGHT", sampling: None, prefix: None };
    translated_texts(files, &texts, &style, sources)
}

fn translated_texts(
    files: &dyn Files,
    texts: &BTreeMap<String, String>,
    style: &Style<'_>,
    sources: &mut SourceSet,
) -> Result<BTreeMap<String, String>, Diagnostics> {
    let modules: Vec<SourceModule<'_>> = texts
        .iter()
        .map(|(path, text)| SourceModule {
            path: path.trim_end_matches(".wesl").split('/').map(str::to_owned).collect(),
            source: sources.add(files.display(path), text.as_str()),
            text,
        })
        .collect();
    let translated = translate_wesl(&modules, &[], style)?;
    Ok(translated.into_iter().map(|file| (file.path, file.text)).collect())
}
