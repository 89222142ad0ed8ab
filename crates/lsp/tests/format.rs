//! Formatting as an editor asks for it.

use libtest_mimic::{Failed, Trial};
use serde_json::{Value, json};

use crate::editor::{Editor, expect};

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("lsp::format_whole", whole),
        Trial::test("lsp::format_parts", parts),
        Trial::test("lsp::format_options", options),
    ]
}

const TEXT: &str = "fn  a( ){\r\n  b( ) ;\r\n c( ) ;\r\n}\r\nfn  e( ){ é( ) ; }\r\n";

/// The text of an open document after the edits that the server answers with.
fn edited(editor: &mut Editor, path: &str, request: &str, more: &Value) -> Result<String, Failed> {
    let mut parameters = json!({
        "textDocument": { "uri": editor.uri(path)? },
        "options": { "tabSize": 2, "insertSpaces": true },
    });
    for (key, value) in more.as_object().into_iter().flatten() {
        parameters[key] = value.clone();
    }
    let edits = editor.ask(&format!("textDocument/{request}"), parameters)?;
    let mut text = TEXT.to_owned();
    for edit in edits.as_array().ok_or("no edits")?.iter().rev() {
        let byte = |end: &str| -> Option<usize> {
            let place = &edit["range"][end];
            let line = usize::try_from(place["line"].as_u64()?).ok()?;
            let start: usize = TEXT.split_inclusive('\n').take(line).map(str::len).sum();
            let units = usize::try_from(place["character"].as_u64()?).ok()?;
            let letters = TEXT[start..].char_indices().map(|(at, _)| at);
            letters.chain([TEXT.len() - start]).nth(units).map(|at| start + at)
        };
        let range = byte("start").ok_or("no start")?..byte("end").ok_or("no end")?;
        text.replace_range(range, edit["newText"].as_str().ok_or("no text")?);
    }
    Ok(text)
}

fn whole() -> Result<(), Failed> {
    let mut editor = Editor::new(&[("a.wesl", TEXT)])?;
    editor.open("a.wesl")?;
    let text = edited(&mut editor, "a.wesl", "formatting", &json!({}))?;
    expect(text == "fn a() {\r\n  b();\r\n  c();\r\n}\r\nfn e() { é(); }\r\n", &text)
}

fn parts() -> Result<(), Failed> {
    let mut editor = Editor::new(&[("a.wesl", TEXT)])?;
    editor.open("a.wesl")?;
    let place = |line: u32, character: u32| json!({ "line": line, "character": character });
    let range = json!({ "range": { "start": place(2, 1), "end": place(2, 2) } });
    let text = edited(&mut editor, "a.wesl", "rangeFormatting", &range)?;
    let expected = "fn  a( ){\r\n  b( ) ;\r\n  c();\r\n}\r\nfn  e( ){ é( ) ; }\r\n";
    expect(text == expected, &text)?;
    let typed = json!({ "position": place(3, 1), "ch": "}" });
    let text = edited(&mut editor, "a.wesl", "onTypeFormatting", &typed)?;
    let expected = "fn a() {\r\n  b();\r\n  c();\r\n}\r\nfn  e( ){ é( ) ; }\r\n";
    expect(text == expected, &text)
}

/// The manifest's options count, and those of the editor for what it leaves open.
fn options() -> Result<(), Failed> {
    let manifest = "[format]\nbraces = \"next_line\"\nline_ends = \"unix\"\n";
    let mut editor = Editor::new(&[("lamplight.toml", manifest), ("below/a.wesl", TEXT)])?;
    editor.open("below/a.wesl")?;
    let text = edited(&mut editor, "below/a.wesl", "formatting", &json!({}))?;
    let expected = "fn a()\n{\n  b();\n  c();\n}\nfn e()\n{\n  é();\n}\n";
    expect(text == expected, &text)
}
