//! What an edit has looked at again.

use std::fs;

use libtest_mimic::{Failed, Trial};
use serde_json::{Value, json};

use crate::editor::{Editor, expect, position};

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("lsp::edits_reach_importers_alone", importers_alone),
        Trial::test("lsp::new_files_are_listed", new_files),
    ]
}

const FILES: &[(&str, &str)] = &[
    ("util.wesl", "fn half(x: f32) -> f32 { return x * 0.5; }\n"),
    ("deep.wesl", "import package::user::user;\nfn deep() -> f32 { return user(); }\n"),
    ("user.wesl", "import package::util::half;\nfn user() -> f32 { return half(1.0); }\n"),
    ("alone.wesl", "fn alone() -> f32 { return 1.0; }\n"),
];

fn change(editor: &mut Editor, path: &str, text: &str) -> Result<(), Failed> {
    let uri = editor.uri(path)?;
    let parameters = json!({
        "textDocument": { "uri": uri, "version": 2 },
        "contentChanges": [{ "text": text }],
    });
    editor.notify("textDocument/didChange", parameters);
    Ok(())
}

fn names(shown: &[(String, Vec<Value>)]) -> Vec<&str> {
    shown.iter().map(|(path, _)| path.as_str()).collect()
}

/// An edit has the modules looked at that import the edited one, also through others, and no more.
fn importers_alone() -> Result<(), Failed> {
    let mut editor = Editor::new(FILES)?;
    for (path, _) in FILES {
        editor.open(path)?;
    }
    editor.shown()?;
    change(&mut editor, "util.wesl", "fn half(x: f32) -> f32 { return x * 0.25; }\n")?;
    let shown = editor.shown()?;
    expect(names(&shown) == ["deep.wesl", "user.wesl", "util.wesl"], &names(&shown))?;
    change(&mut editor, "util.wesl", "fn whole(x: f32) -> f32 { return x; }\n")?;
    let shown = editor.shown()?;
    let user = shown.iter().find(|(path, _)| path == "user.wesl").ok_or("no user")?;
    expect(user.1[0]["code"] == "missing-item", &user.1)?;
    // What was missing is found again.
    change(&mut editor, "util.wesl", FILES[0].1)?;
    let shown = editor.shown()?;
    expect(shown.iter().all(|(_, found)| found.is_empty()) && shown.len() == 3, &shown)?;
    change(&mut editor, "alone.wesl", "fn alone() -> f32 { return 2.0; }\n")?;
    let shown = editor.shown()?;
    expect(names(&shown) == ["alone.wesl"], &names(&shown))
}

/// A file that another program makes is known once the editor tells of it.
fn new_files() -> Result<(), Failed> {
    let mut editor = Editor::new(FILES)?;
    let text = "import package::";
    let offered = |editor: &mut Editor| -> Result<Vec<String>, Failed> {
        let place = json!({
            "textDocument": { "uri": editor.uri("user.wesl")? },
            "position": position(text, text.len()),
        });
        let found = editor.ask("textDocument/completion", place)?;
        let items = if found.is_array() { &found } else { &found["items"] };
        let label = |item: &Value| item["label"].as_str().map(str::to_owned);
        Ok(items.as_array().into_iter().flatten().filter_map(label).collect())
    };
    editor.open_text("user.wesl", text)?;
    let before = offered(&mut editor)?;
    expect(before.contains(&"util".to_owned()), &before)?;
    fs::write(editor.folder.path().join("later.wesl"), "fn later() {}\n")?;
    editor.notify("workspace/didChangeWatchedFiles", json!({ "changes": [] }));
    let after = offered(&mut editor)?;
    expect(after.contains(&"later".to_owned()), &after)
}
