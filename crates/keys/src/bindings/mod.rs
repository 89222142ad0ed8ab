//! Bindings of a bundle's programs as source of an engine's language: structures of uniform blocks
//! with all padding, numbers of bindings, and locations of vertex inputs.
//!
//! The compiler of the engine checks the offset and the size of everything against those that the
//! bundle has, so a structure that it would lay out otherwise does not compile.

mod c;
mod embed;
mod model;
mod rust;
mod typescript;

use lamplight_bundle::{Bundle, Error, Language};

use model::ProgramModel;

/// A language that bindings are written for.
#[derive(Debug, Clone, Copy)]
pub struct BindingLanguage {
    /// Lower-case, as on the command line.
    pub name: &'static str,
    write: fn(&Request<'_>, &[ProgramModel]) -> String,
}

/// Every language, by name.
pub const LANGUAGES: &[BindingLanguage] = &[c::C, c::CPP, rust::LANGUAGE, typescript::LANGUAGE];

/// What is written.
#[derive(Debug, Clone, Copy, Default)]
pub struct Request<'a> {
    /// The names of the programs; all of the bundle where there are none.
    pub programs: &'a [String],
    /// The source language whose bindings are written. `None` for WESL where a program has it.
    pub source: Option<Language>,
    /// The bytes of the bundle as one file, to be embedded, and the name that they get.
    pub embedded: Option<(&'a str, &'a [u8])>,
}

/// The language of that name.
pub fn find(name: &str) -> Option<&'static BindingLanguage> {
    LANGUAGES.iter().find(|language| language.name == name)
}

/// Whether a text begins as one that [`write()`] wrote, in any language.
pub fn is_written(head: &[u8]) -> bool {
    const MARK: &[u8] = b"Written by `lamplight bindings";
    head.windows(MARK.len()).take(16).any(|window| window == MARK)
}

/// One source file. The same bundle gives the same bytes.
///
/// # Errors
/// [`Error::NotFound`] for a program that the bundle does not have, and for a source language that a
/// program does not have; others where the bundle is damaged.
pub fn write(
    bundle: &Bundle,
    request: &Request<'_>,
    language: &BindingLanguage,
) -> Result<String, Error> {
    let mut names: Vec<&str> = request.programs.iter().map(String::as_str).collect();
    if names.is_empty() {
        names = bundle.programs().collect();
    }
    let programs = names.into_iter().map(|name| ProgramModel::of(bundle, name, request.source));
    Ok((language.write)(request, &programs.collect::<Result<Vec<_>, _>>()?))
}
