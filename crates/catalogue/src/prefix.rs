//! `prefix.glsl`: the names of all GLSL modules, each with a prefix, for hosts that have functions
//! of the same names.
//!
//! GLSL has no modules, and its preprocessor cannot be relied on to join two words. So the prefix
//! is written out, one line for each name. A module includes the file before its declarations and
//! after them. The first time defines the names, the second time takes them back. So the names of
//! the host's own text are left alone.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::{CatalogueItemKind, outline};

/// Path below the library.
pub const PATH: &str = "prefix.glsl";

/// What each name begins with.
pub const PREFIX: &str = "lamplight_";

const HEAD: &str = "\
//! Gives each name of the library's GLSL modules the prefix `lamplight_`.
//!
//! Define `LAMPLIGHT_PREFIX` before the first include of a module. Modules include this file twice:
//! before their declarations, where it defines macros, and after them, where it undefines those.
//!
//! Made from the modules by `cargo xtask docs`: edit those, not this file.
";

/// The file, from the texts of a library's GLSL modules by their paths.
pub fn prefix_file(modules: &BTreeMap<String, String>) -> String {
    let names = prefixed_names(modules);
    let mut text = format!("{HEAD}\n#ifndef LAMPLIGHT_PREFIXED\n#define LAMPLIGHT_PREFIXED\n\n");
    for PrefixName { name, parameters } in &names {
        let _ = writeln!(text, "#define {name}{parameters} {PREFIX}{name}{parameters}");
    }
    text.push_str("\n#else\n#undef LAMPLIGHT_PREFIXED\n\n");
    for PrefixName { name, .. } in &names {
        let _ = writeln!(text, "#undef {name}");
    }
    text.push_str("\n#endif\n");
    text
}

/// A name that a module declares.
struct PrefixName {
    name: String,
    /// Of a function: `(a, b)`. A macro with parameters leaves fields of the same name alone.
    parameters: String,
}

/// All names, sorted.
fn prefixed_names(modules: &BTreeMap<String, String>) -> Vec<PrefixName> {
    let texts = modules.iter().filter(|(path, _)| !path.starts_with(super::PROGRAMS));
    let mut names: Vec<PrefixName> =
        texts.flat_map(|(_, text)| outline::glsl_declarations(text)).map(name_of).collect();
    names.sort_by(|a, b| a.name.cmp(&b.name));
    names
}

fn name_of(found: outline::CatalogueDeclaration) -> PrefixName {
    let parameters = match found.kind {
        CatalogueItemKind::Function => {
            let names: Vec<String> = (0..count_parameters(&found.declaration))
                .map(|index| format!("p{index}"))
                .collect();
            format!("({})", names.join(", "))
        }
        CatalogueItemKind::Struct | CatalogueItemKind::Constant => String::new(),
    };
    PrefixName { name: found.name, parameters }
}

/// How many arguments the preprocessor sees: a comma within a macro's own brackets separates none.
fn count_parameters(declaration: &str) -> usize {
    let list = declaration.split_once('(').map_or("", |(_, list)| list).trim_end();
    let list = list.strip_suffix(')').unwrap_or(list).trim();
    let mut depth = 0i32;
    let is_separator = |letter: &char| {
        depth += i32::from(*letter == '(') - i32::from(*letter == ')');
        *letter == ',' && depth == 0
    };
    if list.is_empty() { 0 } else { 1 + list.chars().filter(is_separator).count() }
}
