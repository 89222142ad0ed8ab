//! Texts before and after: `cases/NAME.in.EXT` and `cases/NAME.EXT`. With
//! `LAMPLIGHT_FORMAT_RECORD`, the latter are written.

use std::fs;
use std::path::Path;

use lamplight_diagnostic::source::SourceSet;
use lamplight_format::{
    Language, Options, apply_edits, format_edits, format_range, format_text, format_typed,
};
use libtest_mimic::{Failed, Trial};

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/cases");

/// A test for each text.
pub fn case_trials() -> Vec<Trial> {
    let mut names: Vec<String> = fs::read_dir(FOLDER)
        .into_iter()
        .flatten()
        .flatten()
        .filter_map(|entry| entry.file_name().into_string().ok())
        .filter(|name| name.contains(".in."))
        .collect();
    names.sort();
    let trial = |name: String| Trial::test(format!("cases/{name}"), move || check_case(&name));
    names.into_iter().map(trial).collect()
}

fn formatted(text: &str, language: Language) -> String {
    let mut sources = SourceSet::default();
    let id = sources.add("text", text.to_owned());
    format_text(text, id, language, &Options::default()).text
}

fn check_case(name: &str) -> Result<(), Failed> {
    let language = if name.ends_with(".glsl") { Language::Glsl } else { Language::Wesl };
    let text = fs::read_to_string(Path::new(FOLDER).join(name))?;
    let made = formatted(&text, language);
    let file = Path::new(FOLDER).join(name.replace(".in.", "."));
    if std::env::var_os("LAMPLIGHT_FORMAT_RECORD").is_some() {
        fs::write(&file, &made)?;
    }
    same_text(&fs::read_to_string(file)?, &made)?;
    same_text(&made, &formatted(&made, language))?;
    // The ends of lines stay.
    let windows = formatted(&text.replace('\n', "\r\n"), language);
    same_text(&made.replace('\n', "\r\n"), &windows)?;
    same_text(&made, &apply_edits(&text, &format_edits(&text, language, &Options::default())))
}

fn same_text(expected: &str, found: &str) -> Result<(), Failed> {
    if expected == found {
        return Ok(());
    }
    let difference = similar::TextDiff::from_lines(expected, found);
    Err(difference.unified_diff().to_string().into())
}

const PIECES: &str = "fn  a( ){\n  b( ) ;\n c( ) ; d( );\n}\nfn  e( ){ f( ) ; }\n";

fn in_range(from: &str, to: &str) -> String {
    let start = PIECES.find(from).unwrap_or_default();
    let end = PIECES.find(to).unwrap_or_default();
    let options = Options::default();
    apply_edits(PIECES, &format_range(PIECES, start..end, Language::Wesl, &options))
}

/// Only the statements that a range touches are formatted.
pub fn ranges() -> Result<(), Failed> {
    same_text(
        "fn  a( ){\n  b( ) ;\n    c();\n    d();\n}\nfn  e( ){ f( ) ; }\n",
        &in_range("c(", "d("),
    )?;
    same_text(
        "fn a() {\n    b();\n    c();\n    d();\n}\nfn  e( ){ f( ) ; }\n",
        &in_range("a(", "b("),
    )?;
    same_text("fn  a( ){\n  b( ) ;\n c( ) ; d( );\n}\nfn e() { f(); }\n", &in_range("e(", "f("))
}

/// What is typed formats the statement that it ends, and nothing behind it.
pub fn typed() -> Result<(), Failed> {
    let after = |piece: &str| {
        let byte = PIECES.find(piece).unwrap_or_default() + piece.len();
        apply_edits(PIECES, &format_typed(PIECES, byte, Language::Wesl, &Options::default()))
    };
    same_text("fn  a( ){\n    b();\n c( ) ; d( );\n}\nfn  e( ){ f( ) ; }\n", &after("b( ) ;"))?;
    same_text("fn a() {\n    b();\n    c();\n    d();\n}\nfn  e( ){ f( ) ; }\n", &after("d( );\n}"))
}
