//! Names that several packages of a workspace use: each edit reaches all places, or none.

use std::collections::BTreeMap;
use std::fs;

use libtest_mimic::{Failed, Trial};
use serde_json::{Value, json};

use crate::editor::{Editor, expect};

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("lsp::references_across_packages", references_across_packages),
        Trial::test("lsp::rename_across_packages", rename_across_packages),
        Trial::test("lsp::rename_that_would_break", rename_that_would_break),
        Trial::test("lsp::rename_of_glsl_across_packages", rename_of_glsl),
        Trial::test("lsp::rename_under_conditions", rename_under_conditions),
    ]
}

/// A name that is an import under one condition, and a local under another: to rename either one
/// would change what the other means, so both are refused. Other names of the file are renamed.
fn rename_under_conditions() -> Result<(), Failed> {
    let main = "import package::k::{a, b};\nfn f() -> f32 {\n    @if(c) let a = 7.0;\n    \
                let sum = a + b;\n    return sum;\n}\n";
    let files = [
        ("wesl.toml", "[package]\nname = \"one\"\nroot = \".\"\n"),
        ("main.wesl", main),
        ("k.wesl", "const a = 1.0;\nconst b = 2.0;\n"),
    ];
    for words in ["a = 7.0", "a + b", "a, b}"] {
        let refused = rename(&mut Editor::new(&files)?, "main.wesl", words, "q")?;
        let reason = refused.as_ref().err().map(String::as_str).unwrap_or_default();
        expect(reason.contains("under other conditions"), &(words, &refused))?;
    }
    let renamed = rename(&mut Editor::new(&files)?, "main.wesl", "b;", "q")?;
    expect(renamed.is_ok(), &renamed)
}

const LIB: &str = "[package]\nname = \"lib\"\nedition = \"2026_pre\"\nroot = \"src\"\n";
const APP: &str = "[package]\nname = \"app\"\nedition = \"2026_pre\"\nroot = \"src\"\n\
                   [dependencies]\nlib = { path = \"../lib\" }\n";
const FAR: &str = "[package]\nname = \"far\"\nedition = \"2026_pre\"\nroot = \"src\"\n\
                   [dependencies]\nmath = { path = \"../lib\" }\n";

/// Three packages, two of which use a function of the first; the last one by another name.
const FILES: &[(&str, &str)] = &[
    ("lib/wesl.toml", LIB),
    (
        "lib/src/m.wesl",
        "fn twice(x: f32) -> f32 { return x * 2.0; }\nfn once(x: f32) -> f32 { return x; }\n",
    ),
    ("lib/src/n.wesl", "import package::m::twice;\nfn n(x: f32) -> f32 { return twice(x); }\n"),
    ("app/wesl.toml", APP),
    (
        "app/src/main.wesl",
        "import lib::m::twice;\nfn four(x: f32) -> f32 { return twice(twice(x)); }\n",
    ),
    ("app/src/inline.wesl", "fn g(x: f32) -> f32 { return lib::m::twice(x); }\n"),
    ("far/wesl.toml", FAR),
    (
        "far/src/main.wesl",
        "import math::m::twice as double;\nfn f(x: f32) -> f32 { return double(x); }\n",
    ),
    // This one depends on none of them.
    ("other/wesl.toml", "[package]\nname = \"other\"\nedition = \"2026_pre\"\nroot = \"src\"\n"),
    (
        "other/src/main.wesl",
        "fn twice(x: f32) -> f32 { return x; }\nfn h() -> f32 { return twice(1.0); }\n",
    ),
];

/// How many places of each file an answer has.
fn places_of(found: &Value) -> BTreeMap<String, usize> {
    let mut counts = BTreeMap::new();
    let short = |uri: &str| uri.rsplitn(4, '/').take(3).collect::<Vec<_>>().join("<");
    for place in found.as_array().into_iter().flatten() {
        *counts.entry(short(place["uri"].as_str().unwrap_or_default())).or_default() += 1;
    }
    for (uri, edits) in found["changes"].as_object().into_iter().flatten() {
        counts.insert(short(uri), edits.as_array().map_or(0, Vec::len));
    }
    counts
}

fn expected() -> BTreeMap<String, usize> {
    [
        ("m.wesl<src<lib", 1),
        ("n.wesl<src<lib", 2),
        ("main.wesl<src<app", 3),
        ("inline.wesl<src<app", 1),
        ("main.wesl<src<far", 1),
    ]
    .map(|(file, count)| (file.to_owned(), count))
    .into()
}

/// A file, and words in it at which the function is named.
const ASKED: &[(&str, &str)] = &[
    ("lib/src/m.wesl", "twice(x: f32)"),
    ("lib/src/n.wesl", "twice(x);"),
    ("app/src/main.wesl", "twice(x))"),
];

fn references_across_packages() -> Result<(), Failed> {
    for (file, words) in ASKED {
        let mut editor = Editor::new(FILES)?;
        let text = editor.open(file)?;
        let parameters = editor.place(file, &text, words)?;
        let found = places_of(&editor.ask("textDocument/references", parameters)?);
        // The alias names it too.
        let mut all = expected();
        all.insert("main.wesl<src<far".to_owned(), 3);
        expect(found == all, &(file, found))?;
    }
    Ok(())
}

fn rename(
    editor: &mut Editor,
    file: &str,
    words: &str,
    new: &str,
) -> Result<Result<Value, String>, Failed> {
    let text = editor.open(file)?;
    let mut parameters = editor.place(file, &text, words)?;
    let prepared = editor.answer("textDocument/prepareRename", parameters.clone())?;
    parameters["newName"] = json!(new);
    let renamed = editor.answer("textDocument/rename", parameters)?;
    // What cannot be renamed to anything is refused before a name is asked for.
    expect(prepared.is_ok() || renamed.is_err(), &(prepared, &renamed))?;
    Ok(renamed)
}

/// Every package compiles after the edits of a rename, whichever package it was asked in.
fn rename_across_packages() -> Result<(), Failed> {
    for (file, words) in ASKED {
        let mut editor = Editor::new(FILES)?;
        let renamed = rename(&mut editor, file, words, "doubled")?.map_err(Failed::from)?;
        expect(places_of(&renamed) == expected(), &(file, &renamed))?;
        apply(&editor, &renamed)?;
        for (path, _) in FILES.iter().filter(|(path, _)| path.ends_with(".wesl")) {
            editor.open(path)?;
        }
        let shown = editor.shown()?;
        expect(shown.iter().all(|(_, found)| found.is_empty()), &shown)?;
    }
    Ok(())
}

/// Writes the edits of an answer into the files.
fn apply(editor: &Editor, renamed: &Value) -> Result<(), Failed> {
    for (uri, edits) in renamed["changes"].as_object().into_iter().flatten() {
        let path = uri.trim_start_matches("file://");
        let mut lines: Vec<String> = fs::read_to_string(path)?.lines().map(str::to_owned).collect();
        let number = |found: &Value| found.as_u64().unwrap_or(0) as usize;
        let mut edits: Vec<&Value> = edits.as_array().into_iter().flatten().collect();
        edits.sort_by_key(|edit| std::cmp::Reverse(number(&edit["range"]["start"]["character"])));
        for edit in edits {
            let (start, end) = (&edit["range"]["start"], &edit["range"]["end"]);
            let range = number(&start["character"])..number(&end["character"]);
            let new = edit["newText"].as_str().unwrap_or_default();
            lines[number(&start["line"])].replace_range(range, new);
        }
        fs::write(path, lines.join("\n") + "\n")?;
    }
    expect(editor.folder.path().is_dir(), renamed)
}

/// A change of the workspace, the new name, and what the refusal names.
type Refusal = (&'static [(&'static str, &'static str)], &'static str, &'static str);

const REFUSED: &[Refusal] = &[
    // A use may be missed.
    (
        &[("app/src/main.wesl", "import lib::m::twice;\nfn f() -> f32 { return twice(1.0;\n}\n")],
        "doubled",
        "app/src/main.wesl",
    ),
    (&[("app/wesl.toml", "[package\n")], "doubled", "app/wesl.toml"),
    // The name is taken where it is used.
    (
        &[(
            "app/src/inline.wesl",
            "fn doubled() {}\nfn g() -> f32 { return lib::m::twice(1.0); }\n",
        )],
        "doubled",
        "inline",
    ),
    (&[], "four", "main"),
    (&[], "once", "m"),
    // The name has a meaning.
    (&[], "max", "max"),
    (&[], "vec3f", "vec3f"),
    (&[], "async", "async"),
    (&[], "__x", "__x"),
];

fn rename_that_would_break() -> Result<(), Failed> {
    for (changed, new, named) in REFUSED {
        let mut editor = Editor::new(FILES)?;
        for (path, text) in *changed {
            fs::write(editor.folder.path().join(path), text)?;
        }
        let renamed = rename(&mut editor, "lib/src/m.wesl", "twice(x: f32)", new)?;
        expect(
            renamed.as_ref().is_err_and(|words| words.contains(named)),
            &(changed, new, renamed),
        )?;
    }
    // What is broken elsewhere and does not have the name does not matter.
    let mut editor = Editor::new(FILES)?;
    fs::write(editor.folder.path().join("other/wesl.toml"), "[package\n")?;
    fs::write(editor.folder.path().join("other/src/main.wesl"), "fn f(")?;
    let renamed = rename(&mut editor, "lib/src/m.wesl", "twice(x: f32)", "doubled")?;
    expect(renamed.is_ok(), &renamed)
}

const GLSL: &[(&str, &str)] = &[
    ("lib/wesl.toml", LIB),
    (
        "lib/src/m.glsl",
        "float twice(float x) { return x * 2.0; }\nfloat once(float x) { return x; }\n",
    ),
    ("app/wesl.toml", APP),
    (
        "app/src/main.frag",
        "#version 450\n#include <lib/m.glsl>\nlayout(location = 0) out vec4 c;\n\
         void main() { c = vec4(twice(twice(1.0))); }\n",
    ),
];

/// In GLSL the rename is refused, and names the file; references are found.
fn rename_of_glsl() -> Result<(), Failed> {
    let mut editor = Editor::new(GLSL)?;
    let renamed = rename(&mut editor, "lib/src/m.glsl", "twice(float", "doubled")?;
    expect(renamed.as_ref().is_err_and(|words| words.contains("app/src/main.frag")), &renamed)?;
    let text = editor.open("lib/src/m.glsl")?;
    let parameters = editor.place("lib/src/m.glsl", &text, "twice(float")?;
    let found = places_of(&editor.ask("textDocument/references", parameters)?);
    let expected = [("m.glsl<src<lib", 1), ("main.frag<src<app", 2)];
    expect(found == expected.map(|(file, count)| (file.to_owned(), count)).into(), &found)?;
    let renamed = rename(&mut editor, "lib/src/m.glsl", "once(float", "single")?;
    expect(renamed.is_ok(), &renamed)
}
