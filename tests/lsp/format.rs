//! Formatting of documents.

use lamplight::LIBRARY_FILES;
use lamplight::source::Files as _;
use libtest_mimic::Failed;
use serde_json::json;

use super::session::{MAIN, Session};
use super::{Outcome, expect};

/// Formatting changes only blanks, and changes nothing the second time. This holds for a text with
/// odd blanks and for every module of the library.
pub fn formatting() -> Outcome {
    let mut session = Session::new(MAIN)?;
    let mut format = |text: &str| -> Result<String, Failed> {
        session.change(text)?;
        let document = json!({
            "textDocument": { "uri": session.uri("main.wesl")? },
            "options": { "tabSize": 4, "insertSpaces": true },
        });
        let edits = session.ask("textDocument/formatting", document)?;
        let edits = edits.as_array().ok_or("no edits")?;
        edits.iter().rev().try_fold(text.to_owned(), |mut text, edit| {
            let range =
                byte_of(&text, &edit["range"]["start"])?..byte_of(&text, &edit["range"]["end"])?;
            text.replace_range(range, edit["newText"].as_str().ok_or("no text")?);
            Ok(text)
        })
    };
    let words = |text: &str| text.split_whitespace().collect::<String>();
    let odd = MAIN.replace("    ", "\t ");
    let odd = odd.replace("return vec4f(sum);", "return   vec4f(\n\nsum\n);\n\n\n");
    let once = format(&odd)?;
    expect(words(&once) == words(&odd), &once)?;
    expect(once.contains("    return vec4f(\n        sum\n    );\n}\n"), &once)?;
    expect(format(&once)? == once, &once)?;
    for file in LIBRARY_FILES.list(&["wesl"]) {
        let text = LIBRARY_FILES.read(&file).ok().flatten().ok_or("unreadable")?;
        let once = format(&text)?;
        expect(words(&once) == words(&text) && format(&once)? == once, &file)?;
    }
    Ok(())
}

/// The byte of a place in a text; an edit that is applied later stands before it.
fn byte_of(text: &str, place: &serde_json::Value) -> Result<usize, Failed> {
    let line = place["line"].as_u64().ok_or("no line")? as usize;
    let units = place["character"].as_u64().ok_or("no character")? as usize;
    let start: usize = text.split_inclusive('\n').take(line).map(str::len).sum();
    let letters = text[start..].char_indices().map(|(at, _)| at).chain([text.len() - start]);
    let mut letters = letters.scan(0, |seen, at| {
        let before = *seen;
        *seen += text[start + at..].chars().next().map_or(0, char::len_utf16);
        Some((before, start + at))
    });
    let found = letters.find(|(before, _)| *before >= units);
    Ok(found.ok_or("beyond the text")?.1)
}
