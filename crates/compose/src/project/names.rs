//! Which names a dependency may have.

use std::collections::BTreeMap;

use crate::resolve::Scope;
use lamplight_diagnostic::source::Span;
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_syntax::wesl::is_path_name;
use lamplight_syntax::words::{continues_word, is_word};

/// What is wrong with the name of a dependency, if something is: an error if no import and no
/// `#include` can name it, a warning if only an `#include` can. `path` is the dependency's folder.
pub fn problem(name: &str, path: Option<&str>) -> Option<Diagnostic> {
    let error = |message: String| Some(Diagnostic::error(codes::WESL_TOML, message));
    if name.is_empty() {
        return error("a dependency has an empty name".to_owned());
    }
    let is_part = |letter: char| continues_word(letter) || matches!(letter, '-' | '.');
    if !name.chars().all(is_part) || name.chars().all(|letter| letter == '.') {
        let message = format!("`{}` is not the name of a package", name.escape_debug());
        return error(message).map(|error| error.note(format!("help: {}", spelled(name, path))));
    }
    if is_word(name) && !is_path_name(name) {
        let message = format!("`{name}` has another meaning in shaders, so it names no package");
        return error(message).map(|error| error.note(format!("help: {}", spelled("other", path))));
    }
    if !is_word(name) {
        let message = format!("no import can name the dependency `{name}`");
        return Some(
            Diagnostic::warning(codes::WESL_TOML, message)
                .note(format!("help: {}", spelled(name, path))),
        );
    }
    None
}

/// How a dependency can be written so that imports can name it.
fn spelled(name: &str, path: Option<&str>) -> String {
    let fitting = |letter: char| if letter.is_ascii_alphanumeric() { letter } else { '_' };
    let mut word: String = name.chars().map(fitting).collect();
    word = word.trim_matches('_').to_owned();
    if !is_word(&word) || !is_path_name(&word) {
        word = "other".to_owned();
    }
    match path {
        Some(path) => format!("`{word} = {{ path = {path:?} }}`"),
        None => format!("`{word} = {{ package = {name:?} }}`"),
    }
}

/// Warns of names that a reader, or a file system that does not distinguish upper and lower case,
/// takes for each other.
pub fn warn_of_pairs(scope: &Scope, place: &dyn Fn(&str) -> Span) -> Vec<Diagnostic> {
    let mut known: BTreeMap<String, &str> = BTreeMap::new();
    let mut found = Vec::new();
    for name in scope.names.keys() {
        if let Some(other) = known.insert(name.to_lowercase(), name) {
            let message = format!("`{other}` and `{name}` differ only in upper and lower case");
            found.push(
                Diagnostic::warning(codes::WESL_TOML, message)
                    .at(place(name), "this dependency")
                    .at(place(other), "and this one"),
            );
        }
        if !name.is_ascii() {
            let message = format!("the dependency `{name}` has letters beyond ASCII");
            found.push(
                Diagnostic::warning(codes::WESL_TOML, message)
                    .at(place(name), "declared here")
                    .note("such a letter may have several forms that look the same, and an import finds only one"),
            );
        }
    }
    found
}
