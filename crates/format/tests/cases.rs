//! Texts before and after: `cases/NAME.in.EXT` and `cases/NAME.EXT`. With
//! `LAMPLIGHT_FORMAT_RECORD`, the latter are written.

use std::fs;
use std::path::Path;

use lamplight_diagnostic::source::SourceSet;
use lamplight_format::{
    Indent, Language, Options, apply_edits, format_edits, format_range, format_text, format_typed,
    options_for, read_options,
};
use libtest_mimic::{Failed, Trial};

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/cases");

/// A test for each text, and those of parts of a text.
pub fn tests() -> Vec<Trial> {
    let mut names: Vec<String> = fs::read_dir(FOLDER)
        .into_iter()
        .flatten()
        .flatten()
        .filter_map(|entry| entry.file_name().into_string().ok())
        .filter(|name| name.contains(".in."))
        .collect();
    names.sort();
    let trial = |name: String| Trial::test(format!("cases/{name}"), move || check_case(&name));
    let parts = [
        Trial::test("ranges", ranges),
        Trial::test("typed", typed),
        Trial::test("options", options),
        Trial::test("nearest_options", nearest_options),
    ];
    names.into_iter().map(trial).chain(parts).collect()
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
fn ranges() -> Result<(), Failed> {
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
fn typed() -> Result<(), Failed> {
    let after = |piece: &str| {
        let byte = PIECES.find(piece).unwrap_or_default() + piece.len();
        apply_edits(PIECES, &format_typed(PIECES, byte, Language::Wesl, &Options::default()))
    };
    same_text("fn  a( ){\n    b();\n c( ) ; d( );\n}\nfn  e( ){ f( ) ; }\n", &after("b( ) ;"))?;
    same_text("fn a() {\n    b();\n    c();\n    d();\n}\nfn  e( ){ f( ) ; }\n", &after("d( );\n}"))
}

/// Manifests with a mistake, and a part of what is said about it.
const WRONG: [(&str, &str); 8] = [
    ("[format", "unclosed table"),
    ("format = 2", "`format` must be a table"),
    ("[format]\nwide = 90", "`[format]` has no key `wide`"),
    ("[format]\nwidth = 19", "`width` must be an integer from 20 to 1000"),
    ("[format]\nwidth = \"90\"", "`width` must be an integer from 20 to 1000"),
    ("[format]\nindent = 17", "`indent` must be `\"tab\"`, or 0 to 16 spaces"),
    ("[format]\nbraces = \"above\"", "`\"keep\"`, `\"same_line\"`, `\"next_line\"`"),
    ("[format]\nfinal_newline = 1", "`final_newline` must be `true` or `false`"),
];

/// What is wrong in a manifest is said, and what it leaves open stays.
fn options() -> Result<(), Failed> {
    let read = |text: &str| {
        let mut sources = SourceSet::default();
        let id = sources.add("lamplight.toml", text.to_owned());
        read_options(text, id, Options { width: 70, ..Options::default() })
    };
    for (text, expected) in WRONG {
        let found = read(text).err().unwrap_or_default();
        let message = found.first().map_or("", |first| &first.message);
        if !message.contains(expected) {
            return Err(format!("{text}: {message}").into());
        }
    }
    let found = read("[format]\nindent = \"tab\"").map_err(|found| format!("{found:?}"))?;
    let expected = Options { width: 70, indent: Indent::Tab, ..Options::default() };
    let has_none = read("[program.a]").is_ok_and(|found| found.is_none());
    if found != Some(expected) || !has_none {
        return Err(format!("{found:?}").into());
    }
    Ok(())
}

/// The nearest manifest that has the table counts.
fn nearest_options() -> Result<(), Failed> {
    let manifests = [
        ("/a/wesl.toml", "[format]\nwidth = 50"),
        ("/a/b/lamplight.toml", "[format]\nwidth = 60"),
        ("/a/b/wesl.toml", "[format]\nwidth = 70"),
        ("/a/b/c/lamplight.toml", "[program.x]"),
    ];
    let read = |path: &Path| {
        let found = manifests.iter().find(|(name, _)| Path::new(name) == path);
        found.map(|(_, text)| (*text).to_owned())
    };
    let files = [("/x.wesl", 100), ("/a/x.wesl", 50), ("/a/b/x.wesl", 60), ("/a/b/c/x.wesl", 60)];
    for (file, width) in files {
        let mut sources = SourceSet::default();
        let found = options_for(Path::new(file), Options::default(), &mut sources, read)
            .map_err(|found| format!("{found:?}"))?;
        if found.width != width {
            return Err(format!("{file}: {}", found.width).into());
        }
    }
    Ok(())
}
