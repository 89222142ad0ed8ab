//! The library's modules and programs in GLSL: translated from those in WESL.

use std::collections::BTreeMap;

use lamplight_diagnostic::Diagnostics;
use lamplight_diagnostic::source::{Files, SourceSet};
use lamplight_translate::glsl::LIBRARY_STYLE;
use lamplight_translate::{SourceModule, wesl_to_glsl};

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
    let modules: Vec<SourceModule<'_>> = texts
        .iter()
        .map(|(path, text)| SourceModule {
            path: path.trim_end_matches(".wesl").split('/').map(str::to_owned).collect(),
            source: sources.add(files.display(path), text.as_str()),
            text,
        })
        .collect();
    let translated = wesl_to_glsl(&modules, &[], &LIBRARY_STYLE)?;
    Ok(translated.into_iter().map(|file| (file.path, file.text)).collect())
}
