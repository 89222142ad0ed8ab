//! Files that declare a package: the editor may have them open, and is asked to tell of changes.

use std::fs;

use libtest_mimic::{Failed, Trial};
use serde_json::json;

use crate::editor::{Editor, expect};

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("lsp::open_manifest", open_manifest),
        Trial::test("lsp::watched_files", watched_files),
    ]
}

const MANIFEST: &str = "[package]\nname = \"app\"\nedition = \"2026_pre\"\nroot = \"src\"\n";

/// An open manifest shows its errors, and has no other answers: it is no shader.
fn open_manifest() -> Result<(), Failed> {
    let broken = format!("{MANIFEST}[dependencies]\n  far = {{ path = \"far\" }}\n");
    let files = [("wesl.toml", &*broken), ("src/main.wesl", "fn f() {}\n")];
    let mut editor = Editor::new(&files)?;
    let text = editor.open("wesl.toml")?;
    editor.open("src/main.wesl")?;
    let shown = editor.shown()?;
    let at = |path: &str| shown.iter().find(|(known, _)| known == path).map(|(_, found)| found);
    let own = at("wesl.toml").ok_or("nothing is shown at the manifest")?;
    expect(own.len() == 1 && own[0]["range"]["start"]["line"] == 5, own)?;
    let user = at("src/main.wesl").ok_or("nothing is shown at the module")?;
    let related = &user[0]["relatedInformation"][0]["location"]["uri"];
    expect(*related == json!(editor.uri("wesl.toml")?), user)?;
    let place = editor.place("wesl.toml", &text, "far")?;
    for method in ["formatting", "hover", "completion", "documentSymbol", "codeLens"] {
        let answer = editor.ask(&format!("textDocument/{method}"), place.clone())?;
        expect(answer.is_null(), &(method, answer))?;
    }
    fs::write(editor.folder.path().join("wesl.toml"), MANIFEST)?;
    editor.notify("workspace/didChangeWatchedFiles", json!({ "changes": [] }));
    let mended = editor.shown()?;
    expect(mended.iter().all(|(_, found)| found.is_empty()), &mended)
}

/// The server asks to be told of changed modules and manifests.
fn watched_files() -> Result<(), Failed> {
    let mut editor = Editor::new(&[])?;
    let sent = editor.notify("initialized", json!({}));
    let request = sent.first().ok_or("nothing was sent")?;
    expect(request["method"] == "client/registerCapability", request)?;
    let options = &request["params"]["registrations"][0]["registerOptions"]["watchers"];
    let patterns: Vec<&str> = options
        .as_array()
        .into_iter()
        .flatten()
        .filter_map(|one| one["globPattern"].as_str())
        .collect();
    expect(
        patterns.iter().any(|pattern| pattern.contains("wesl.toml") || pattern.contains("{wesl,")),
        &patterns,
    )?;
    expect(patterns.iter().any(|pattern| pattern.contains("frag")), &patterns)
}
