//! The community's suite for composers of WESL.

use std::collections::BTreeMap;
use std::path::Path;

use lamplight::compose::{self, Keep, Mangle, Options};
use lamplight::diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight::parse::wesl::{Names, split_module};
use lamplight::permute::Settings;
use lamplight::resolve::{Packages, wesl};
use lamplight::source::{Memory, Package, SourceSet};
use serde::Deserialize;

use super::Program;
use super::table::Table;
use xtask::CommandFailure;

/// The folder of the suite's cases.
pub const CASES: &str = "src/test-cases-json";

/// Modules, and what they are composed to.
#[derive(Deserialize)]
struct Composition {
    name: String,
    #[serde(rename = "weslSrc")]
    sources: BTreeMap<String, String>,
    #[serde(rename = "expectedWgsl")]
    expected: String,
    /// The same with the names that this form of mangling makes.
    #[serde(rename = "underscoreWgsl")]
    underscore: Option<String>,
}

/// A text that parses, or does not.
#[derive(Deserialize)]
struct Syntax {
    src: String,
    #[serde(default)]
    fails: bool,
}

/// Runs every case of a checkout.
pub fn tabulate(checkout: &Path) -> Result<Table, CommandFailure> {
    let mut table = Table::default();
    for file in ["importCases.json", "conditionalTranslationCases.json"] {
        for case in read::<Composition>(checkout, file)? {
            let outcome = composed(&case);
            let program = Program { name: case.name, text: String::new(), expected: true };
            table.add(&program, outcome.err().as_ref());
        }
    }
    for case in read::<Syntax>(checkout, "importSyntaxCases.json")? {
        let outcome = declarations(&case.src);
        let expected = !case.fails;
        let program = Program { name: case.src, text: String::new(), expected };
        table.add(&program, outcome.err().as_ref());
    }
    Ok(table)
}

fn read<C: for<'d> Deserialize<'d>>(checkout: &Path, file: &str) -> Result<Vec<C>, CommandFailure> {
    let path = checkout.join(CASES).join(file);
    let failed = |error: &dyn std::fmt::Display| {
        CommandFailure::input(format!("`{}`: {error}", path.display()))
    };
    let text = std::fs::read_to_string(&path).map_err(|error| failed(&error))?;
    serde_json::from_str(&text).map_err(|error| failed(&error))
}

/// Whether a case is composed to what it expects: the same declarations and directives, in any order,
/// with the names of one of the two forms of mangling. (Overrides always keep theirs.)
fn composed(case: &Composition) -> Result<(), Diagnostic> {
    let mangled = case.underscore.as_ref().map(|text| (Mangle::Underscore, text));
    match mangled.map(|(mangle, expected)| composed_to(case, mangle, expected)) {
        Some(Ok(())) => Ok(()),
        Some(Err(_)) | None => composed_to(case, Mangle::default(), &case.expected),
    }
}

fn composed_to(case: &Composition, mangle: Mangle, expected: &str) -> Result<(), Diagnostic> {
    let files = case.sources.iter();
    let files = files.map(|(path, text)| (path.trim_start_matches("./").to_owned(), text.clone()));
    let files = Box::new(Memory(files.collect()));
    let packages = Packages::new(Package { name: "package".to_owned(), files }, Vec::new());
    let options = Options { keep: Keep::Root, mangle, ..Options::default() };
    let text = wesl::load(&mut SourceSet::default(), &packages, "main.wgsl")
        .and_then(|graph| compose::wesl::compose(&graph, &Settings::default(), &options))
        .map_err(first)?
        .text;
    let (found, expected) = (declarations(&text)?, declarations(expected)?);
    match found == expected {
        true => Ok(()),
        false => {
            let message = format!("composed to {found:?}, expected {expected:?}");
            Err(Diagnostic::error(codes::CHECK_FAILED, message))
        }
    }
}

fn first(errors: Diagnostics) -> Diagnostic {
    let none = || Diagnostic::error(codes::SYNTAX_ERROR, "refused without an error");
    errors.into_iter().next().unwrap_or_else(none)
}

/// The declarations and directives of a text as words, sorted, without commas at the ends of lists.
fn declarations(text: &str) -> Result<Vec<String>, Diagnostic> {
    let mut sources = SourceSet::default();
    let source = sources.add("case.wesl".to_owned(), text.to_owned());
    let split = split_module(source, text.into(), &mut Names::default()).map_err(first)?;
    let words = |start: u32, end: u32| {
        let tokens = split.tokens.iter();
        let inside = tokens.filter(|token| (start..end).contains(&token.start));
        let words: Vec<&str> =
            inside.map(|token| &text[token.start as usize..token.end as usize]).collect();
        let is_last = |at: usize| matches!(words.get(at + 1), Some(&(")" | "}")));
        let kept = words.iter().enumerate().filter(|(at, word)| **word != "," || !is_last(*at));
        kept.map(|(_, word)| *word).collect::<Vec<_>>().join(" ")
    };
    let items = split.module.items.iter().map(|item| words(item.range.start, item.range.end));
    let directives = split.module.directives.iter();
    let directives = directives.map(|found| words(found.range.start, found.range.end));
    let mut found: Vec<String> = items.chain(directives).collect();
    found.sort();
    Ok(found)
}
