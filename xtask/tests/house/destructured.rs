//! Structures of naga's module are taken apart in full where they are read or rebuilt for output, so
//! that a field which a new version has, or which was forgotten, does not compile.

use std::path::Path;

use libtest_mimic::Failed;

use crate::{ROOT, rust_files};

/// The packages that read modules for output.
const PACKAGES: [&str; 3] = ["emit", "link", "validate"];

/// Files that only put errors into words.
const WORDS: [&str; 2] = ["words", "report.rs"];

/// How patterns of such structures begin, before their fields.
const STRUCTURES: [&str; 11] = [
    "AddressSpace::",
    "Binding::",
    "Constant {",
    "EntryPoint {",
    "Function {",
    "FunctionArgument {",
    "GlobalVariable {",
    "ImageClass::",
    "Override {",
    "StructMember {",
    "TypeInner::",
];

pub fn in_full() -> Result<(), Failed> {
    let mut found = Vec::new();
    for package in PACKAGES {
        let mut files = Vec::new();
        rust_files(&Path::new(ROOT).join("crates").join(package).join("src"), &mut files)?;
        if files.is_empty() {
            return Err(format!("crates/{package} has no sources").into());
        }
        for file in files {
            let is_words = |part: &str| WORDS.contains(&part);
            if file.iter().filter_map(|part| part.to_str()).any(is_words) {
                continue;
            }
            let text = std::fs::read_to_string(&file)?;
            let lines = partial_patterns(&text).into_iter();
            found.extend(lines.map(|line| format!("{}:{line}", file.display())));
        }
    }
    match found.is_empty() {
        true => Ok(()),
        false => Err(format!("name each field, or `field: _`:\n{}", found.join("\n")).into()),
    }
}

/// The lines of patterns that leave fields out, in code before the tests of a file.
fn partial_patterns(text: &str) -> Vec<usize> {
    let code = text.split("#[cfg(test)]").next().unwrap_or_default();
    let mut lines = Vec::new();
    for start in STRUCTURES {
        for (at, _) in code.match_indices(start) {
            if code[..at].ends_with(|before: char| before == '_' || before.is_alphanumeric()) {
                continue;
            }
            let rest = &code[at..];
            let open = rest.find(|letter: char| !is_of_path(letter)).unwrap_or(rest.len());
            let fields = rest[open..].strip_prefix(" {").or_else(|| rest[open..].strip_prefix('{'));
            let fields = fields.and_then(|fields| fields.split_once('}'));
            if fields.is_some_and(|(fields, _)| fields.trim_end().ends_with("..")) {
                lines.push(code[..at].lines().count());
            }
        }
    }
    lines.sort_unstable();
    lines
}

fn is_of_path(letter: char) -> bool {
    matches!(letter, ':' | '_') || letter.is_alphanumeric()
}

/// The rule sees what it is about.
pub fn is_seen() -> Result<(), Failed> {
    let text = "match inner {\n    TypeInner::Array { base, .. } => 1,\n\
        naga::Binding::Location {\n    location,\n    .. } => 2,\n\
        TypeInner::Struct { members, span: _ } => 3,\n\
        OverrideChoice { name, .. } => 4,\n    Override { name, id: _, ty: _, init: _ } => 5,\n}\n\
        #[cfg(test)]\nfn f() { let TypeInner::Array { .. } = x; }";
    match partial_patterns(text)[..] {
        [2, 3] => Ok(()),
        ref found => Err(format!("{found:?}").into()),
    }
}
